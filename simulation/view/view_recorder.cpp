#include "simulation/view/view_recorder.hpp"

#include "core/impact_law.hpp"
#include "simulation/view/straight_motion.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

namespace kairos {
inline namespace simulation {
namespace {

/// Rounding of a path that is handed on from frame to frame, m; see `BodyTrack`.
constexpr double same_pose = 2e-11;
/// Browsers keep a text of up to half a gigabyte; base64 makes four bytes of three.
constexpr std::size_t most_bytes = 300'000'000;

bool same(const Pose& a, const Pose& b) {
  return (a.position - b.position).norm() <= same_pose * (1.0 + b.position.norm()) &&
         (a.orientation.coeffs() - b.orientation.coeffs()).norm() <= same_pose;
}

}  // namespace

void ViewRecorder::begin(const Model& model) {
  model_ = &model;
  run_ = {};
  run_.title = model.scene().name;
  run_.summary = model.scene().summary;
  for (Actor& actor : actors_of(model)) {
    run_.bodies.push_back({std::move(actor), model.mobility(run_.bodies.size())});
  }
  run_.joints = model.scene().joints;
  run_.tracks.resize(model.size());
  for (const char* name : {"kinetic", "potential"}) {
    run_.energy.emplace_back(name, std::vector<double>());
  }
  for (std::size_t i = 0; i < energy_line_count; ++i) {
    run_.energy.emplace_back(to_string(static_cast<EnergyLine>(i)), std::vector<double>());
  }
  run_.energy.emplace_back("unexplained", std::vector<double>());
}

void ViewRecorder::motion(BodyIndex body, const Motion& motion) {
  run_.tracks[body].add(motion);
  if (++motions_ % 65536 == 0) {
    check_size();
  }
}

void ViewRecorder::frame(const Frame& frame) {
  for (BodyIndex i = 0; i < frame.bodies.size(); ++i) {
    follow(i, frame.time, frame.bodies[i]);
  }
  drawn_.assign(frame.bodies.begin(), frame.bodies.end());
  drawn_at_ = frame.time;
  run_.frame_times.push_back(frame.time.seconds);
  keep_energy(frame.ledger);
  if (run_.frame_times.size() % 1024 == 0) {
    check_size();
  }
}

/// Makes what a page shows at t what was drawn.
void ViewRecorder::follow(BodyIndex i, Instant t, const BodyState& drawn) {
  BodyTrack& track = run_.tracks[i];
  if (track.empty()) {
    track.add(model_->mobility(i) == Mobility::fixed
                  ? Motion::at_rest(t, drawn.pose)
                  : Motion::ballistic(t, 0.0, drawn.pose, drawn.twist, Vector3::Zero()));
  } else if (same(track.arriving(t), drawn.pose)) {
    return;
  } else if (track.last_start() == t && same(track.leaving(t), drawn.pose)) {
    track.count_at_start();
  } else if (track.last_start() < drawn_at_ || run_.frame_times.size() == 1) {
    track.add(straight_motion(drawn_at_, t - drawn_at_, drawn_[i], drawn));
  } else {
    track.add(Motion::ballistic(t, 0.0, drawn.pose, drawn.twist, Vector3::Zero()));
    track.count_at_start();
  }
}

void ViewRecorder::keep_energy(const EnergyLedger& ledger) {
  std::size_t column = 0;
  const auto keep = [&](double joules) { run_.energy[column++].second.push_back(joules); };
  keep(ledger.kinetic());
  keep(ledger.potential());
  for (std::size_t i = 0; i < energy_line_count; ++i) {
    keep(ledger.line(static_cast<EnergyLine>(i)));
  }
  keep(ledger.unexplained());
}

void ViewRecorder::event(const Event& event) {
  ViewEvent seen{.time = event.time.seconds,
                 .kind = event.kind,
                 .a = event.a,
                 .b = event.b,
                 .contact = event.contact};
  if (event.kind == EventKind::impact) {
    seen.approach = normal_velocity(event.contact, event.before_a, event.before_b);
    if (model_->is_free(event.b)) {
      seen.impulse =
          model_->body(event.b).mass * (event.after_b.twist.linear - event.before_b.twist.linear);
    } else if (model_->is_free(event.a)) {
      seen.impulse =
          model_->body(event.a).mass * (event.before_a.twist.linear - event.after_a.twist.linear);
    }
  }
  run_.events.push_back(seen);
}

void ViewRecorder::check_size() const {
  std::size_t numbers = run_.frame_times.size() * (run_.energy.size() + 1);
  for (const BodyTrack& track : run_.tracks) {
    numbers += track.coefficients.size() + 3 * track.start.size();
  }
  const std::size_t bytes = 8 * numbers + 100 * run_.events.size();
  if (bytes > most_bytes) {
    throw std::length_error(fmt::format(
        "{}: at t = {} s the page would hold more than {} MB, the most that browsers open; a "
        "shorter --duration fits, or event-driven, which needs one motion an impact",
        run_.title, drawn_at_.seconds, most_bytes / 1'000'000));
  }
}

ViewRun ViewRecorder::finish() && {
  for (BodyTrack& track : run_.tracks) {
    track.finish();
  }
  return std::move(run_);
}

}  // namespace simulation
}  // namespace kairos
