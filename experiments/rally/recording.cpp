#include "experiments/rally/recording.hpp"

#include "core/random.hpp"
#include "experiments/output/csv_row.hpp"
#include "experiments/rally/hand_path.hpp"

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

/// The bat's face looks along `direction`, tipped by `angle` about the bat's width.
Quaternion facing(const Vector3& direction, double angle) {
  const Vector3 width = Vector3::UnitY().cross(direction).normalized();
  return rotate(angle * width, Quaternion::FromTwoVectors(-Vector3::UnitZ(), direction))
      .normalized();
}

struct Paths {
  HandPath bat;
  HandPath hand;
};

Stroke make_stroke(double begin, const RallyOptions& options, Random& random, Paths& paths) {
  Stroke stroke;
  stroke.begin = begin;
  stroke.release = begin + serve_time;
  stroke.end = begin + period;
  stroke.speed = random.uniform(options.slowest, options.fastest);
  stroke.place = {random.uniform(-0.15, 0.15), random.uniform(0.95, 1.05),
                  random.uniform(0.8, 0.9)};
  const double drop = random.uniform(0.18, 0.3);
  stroke.hit = stroke.release + std::sqrt(2.0 * drop / g) + error(random, timing_error);

  const Pose serve{stroke.place + Vector3(0.0, drop, 0.0), Quaternion::Identity()};
  paths.hand.move(begin + 0.05, begin + 0.4, serve);
  paths.hand.move(stroke.release + 0.02, stroke.release + 0.3,
                  {rest_of_hand, Quaternion::Identity()});

  const Vector3 direction =
      Vector3(random.uniform(-0.15, 0.15), random.uniform(0.0, 0.3), -1.0).normalized();
  const Vector3 aim = stroke.place + Vector3(error(random, aim_error), error(random, aim_error), 0);
  const double time = 15.0 / 8.0 * reach / stroke.speed;
  const double swing_begin = stroke.hit - 0.5 * time;
  paths.bat.move(begin - 0.25, begin + 0.3,
                 {aim - 0.5 * reach * direction, facing(direction, wrist * degree)});
  paths.bat.move(swing_begin, swing_begin + time,
                 {aim + 0.5 * reach * direction, facing(direction, -wrist * degree)});
  return stroke;
}

/// What a tracker tells of a path, one sample per 1/rate from `first` on.
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

void append_pose(CsvRow& row, const TrackSample& sample) {
  row.number(sample.time).vector(sample.pose.position);
}

}  // namespace

RallyRecording make_rally(const RallyOptions& options) {
  Random random(options.seed, plan);
  RallyRecording rally;
  Paths paths{HandPath({Vector3(0.0, 0.95, 1.2), facing(-Vector3::UnitZ(), wrist * degree)}),
              HandPath({rest_of_hand, Quaternion::Identity()})};
  // The two trackers and the frames each have a clock of their own.
  const double bat_phase = random.uniform() / options.rate;
  const double hand_phase = random.uniform() / options.rate;
  for (int k = 0; k < options.strokes; ++k) {
    rally.strokes.push_back(make_stroke(k * period + 0.25, options, random, paths));
  }
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
