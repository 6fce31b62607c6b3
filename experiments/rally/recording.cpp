#include "experiments/rally/recording.hpp"

#include "core/random.hpp"
#include "core/rotation_between.hpp"
#include "experiments/rally/hand_path.hpp"
#include "simulation/output/csv_row.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kairos::experiments {
namespace {

// The player stands behind the near edge of the table (z = 0.685, its top at y = 0.76) and looks
// along -z at the half that is folded up. All of it our choice.
constexpr double period = 1.5;          // s, of a stroke
constexpr double serve_time = 0.5;      // s, from the closing of the fist to its opening
constexpr double reach = 0.7;           // m, length of a stroke
constexpr double g = 9.8;               // m/s^2
constexpr double most_deviation = 2.5;  // of human error, standard deviations
constexpr double aim_error = 0.012;     // m, standard deviation
constexpr double timing_error = 0.008;  // s, standard deviation
constexpr double wrist = 25.0;          // degrees that the bat turns, to either side of the hit
constexpr double degree = std::numbers::pi / 180.0;
const Vector3 rest_of_hand(-0.45, 1.15, 1.0);

// Streams of random numbers: what one of them takes does not move the others.
enum Stream : std::uint64_t { plan, bat_noise, hand_noise };

double error(Random& random, double deviation) {
  return deviation * std::clamp(random.normal(), -most_deviation, most_deviation);
}

/// A number as the files hold it: a multiple of 1/`parts`.
double rounded(double x, double parts) { return std::round(x * parts) / parts; }

/// One of the bat's two faces looks along `direction`, tipped by `angle` about the bat's width.
Quaternion facing(const Vector3& direction, double angle) {
  const Vector3 width = Vector3::UnitY().cross(direction).normalized();
  const Vector3 face = direction.z() < 0.0 ? Vector3(-Vector3::UnitZ()) : Vector3(Vector3::UnitZ());
  return rotate(angle * width, rotation_between(face, direction)).normalized();
}

struct Paths {
  HandPath bat;
  HandPath hand;
};

/// Where a stroke goes, and when.
struct StrokePlan {
  double begin = 0.0;                   ///< s
  double speed = 0.0;                   ///< m/s
  double drop = 0.0;                    ///< m, from the hand to the bat
  Vector3 place = Vector3::Zero();      ///< where the ball is to be hit
  Vector3 rest = rest_of_hand;          ///< where the hand draws back to
  Vector3 direction = Vector3::Zero();  ///< of the stroke, unit
  Vector3 aim_error = Vector3::Zero();  ///< m
  double timing_error = 0.0;            ///< s
};

/// The hand fetches the ball, lifts it above the place, lets go and draws back; the bat comes when
/// the ball has fallen so far.
Stroke perform(const StrokePlan& plan, Paths& paths) {
  Stroke stroke{.begin = plan.begin,
                .release = plan.begin + serve_time,
                .end = plan.begin + period,
                .speed = plan.speed,
                .place = plan.place};
  stroke.hit = stroke.release + std::sqrt(2.0 * plan.drop / g) + plan.timing_error;
  const Pose serve{plan.place + Vector3(0.0, plan.drop, 0.0), Quaternion::Identity()};
  paths.hand.move(plan.begin + 0.05, plan.begin + 0.4, serve);
  paths.hand.move(stroke.release + 0.02, stroke.release + 0.3, {plan.rest, Quaternion::Identity()});
  const Vector3 aim = plan.place + plan.aim_error;
  const Vector3 half = 0.5 * reach * plan.direction;
  const double time = 15.0 / 8.0 * reach / plan.speed;
  const double swing_begin = stroke.hit - 0.5 * time;
  paths.bat.move(plan.begin - 0.25, plan.begin + 0.3,
                 {aim - half, facing(plan.direction, wrist * degree)});
  paths.bat.move(swing_begin, swing_begin + time,
                 {aim + half, facing(plan.direction, -wrist * degree)});
  return stroke;
}

StrokePlan random_stroke(double begin, const RallyOptions& options, Random& random) {
  StrokePlan plan{.begin = begin};
  plan.speed = random.uniform(options.slowest, options.fastest);
  plan.place = {random.uniform(-0.15, 0.15), random.uniform(0.95, 1.05), random.uniform(0.8, 0.9)};
  plan.drop = random.uniform(0.18, 0.3);
  plan.timing_error = error(random, timing_error);
  plan.direction =
      Vector3{random.uniform(-0.15, 0.15), random.uniform(0.0, 0.3), -1.0}.normalized();
  plan.aim_error = {error(random, aim_error), error(random, aim_error), 0.0};
  return plan;
}

/// Samples of a path as a tracker gives them, one per 1/rate from `first` on.
std::vector<TrackSample> sampled(const HandPath& path, double first, double last, Stream stream,
                                 const RallyOptions& options) {
  Random random(options.seed, stream);
  std::vector<TrackSample> samples;
  for (int k = 0; first + k / options.rate <= last; ++k) {
    const double t = rounded(first + k / options.rate, 1e6);
    Pose pose = path.at(t).pose;
    Vector3 turn;
    for (int i = 0; i < 3; ++i) {
      pose.position[i] = rounded(pose.position[i] + options.noise * random.normal(), 1e5);
      turn[i] = options.angle_noise * degree * random.normal();
    }
    pose.orientation = rotate(turn, pose.orientation).normalized();
    pose.orientation.coeffs() =
        pose.orientation.coeffs().unaryExpr([](double q) { return rounded(q, 1e7); });
    samples.push_back({t, pose});
  }
  return samples;
}

Paths paths_at_rest() {
  return {HandPath({Vector3(0.0, 0.95, 1.2), facing(-Vector3::UnitZ(), wrist * degree)}),
          HandPath({rest_of_hand, Quaternion::Identity()})};
}

/// The recording that the trackers make of the paths.
RallyRecording recorded(std::vector<Stroke> strokes, const Paths& paths, double bat_phase,
                        double hand_phase, const RallyOptions& options) {
  RallyRecording rally;
  rally.strokes = std::move(strokes);
  const double last = rally.duration();
  rally.bat.samples = sampled(paths.bat, bat_phase, last, bat_noise, options);
  for (const TrackSample& sample : rally.bat.samples) {
    rally.bat_velocity.push_back(paths.bat.at(sample.time).velocity);
  }
  rally.hand.samples = sampled(paths.hand, hand_phase, last, hand_noise, options);
  rally.hand.gestures = true;
  for (TrackSample& sample : rally.hand.samples) {
    sample.pose.orientation = Quaternion::Identity();  // the hand's tracker tells places only
    sample.closed = std::any_of(rally.strokes.begin(), rally.strokes.end(), [&](const Stroke& s) {
      return s.begin <= sample.time && sample.time < s.release;
    });
  }
  return rally;
}

void append_pose(CsvRow& row, const TrackSample& sample) {
  row.number(sample.time).vector(sample.pose.position);
}

}  // namespace

RallyRecording make_rally(const RallyOptions& options) {
  Random random(options.seed, plan);
  Paths paths = paths_at_rest();
  // The two trackers and the frames each have a clock of their own.
  const double bat_phase = random.uniform() / options.rate;
  const double hand_phase = random.uniform() / options.rate;
  std::vector<Stroke> strokes;
  for (int k = 0; k < options.strokes; ++k) {
    strokes.push_back(perform(random_stroke(k * period + 0.25, options, random), paths));
  }
  return recorded(std::move(strokes), paths, bat_phase, hand_phase, options);
}

RallyRecording make_session(const RallyOptions& options) {
  Paths paths = paths_at_rest();
  StrokePlan down_right{.begin = 0.25, .speed = 3.0, .drop = 0.2};
  down_right.place = {-0.1, 1.12, 0.55};
  down_right.rest = {-0.65, 1.5, 0.5};  // out of the way of the bat
  down_right.direction = Vector3(0.7, -0.4, -0.7).normalized();
  StrokePlan to_viewer{.begin = 2.25, .speed = 3.0, .drop = 0.2};
  to_viewer.place = {0.0, 1.15, 0.25};
  to_viewer.rest = down_right.rest;
  to_viewer.direction = Vector3(0.12, 0.1, 1.0).normalized();
  std::vector<Stroke> strokes{perform(down_right, paths), perform(to_viewer, paths)};
  return recorded(std::move(strokes), paths, 0.3 / options.rate, 0.7 / options.rate, options);
}

std::string bat_csv(const RallyRecording& rally) {
  std::string csv = "t,x,y,z,qw,qx,qy,qz,true_vx,true_vy,true_vz\n";
  CsvRow row;
  for (std::size_t i = 0; i < rally.bat.samples.size(); ++i) {
    append_pose(row, rally.bat.samples[i]);
    row.quaternion(rally.bat.samples[i].pose.orientation);
    for (const double v : rally.bat_velocity[i]) {
      row.number(rounded(v, 1e5));
    }
    csv += row.finish();
  }
  return csv;
}

std::string hand_csv(const RallyRecording& rally) {
  std::string csv = "t,x,y,z,gesture\n";
  CsvRow row;
  for (const TrackSample& sample : rally.hand.samples) {
    append_pose(row, sample);
    csv += row.count(sample.closed ? 1 : 0).finish();
  }
  return csv;
}

std::string strokes_csv(const RallyRecording& rally) {
  std::string csv = "stroke,begin,release,hit,end,speed,x,y,z\n";
  CsvRow row;
  for (std::size_t k = 0; k < rally.strokes.size(); ++k) {
    const Stroke& s = rally.strokes[k];
    row.count(static_cast<std::int64_t>(k + 1)).number(s.begin).number(s.release).number(s.hit);
    csv += row.number(s.end).number(s.speed).vector(s.place).finish();
  }
  return csv;
}

}  // namespace kairos::experiments
