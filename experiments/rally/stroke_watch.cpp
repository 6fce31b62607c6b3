#include "experiments/rally/stroke_watch.hpp"

#include "experiments/metrics/metrics.hpp"
#include "simulation/registry.hpp"

#include <algorithm>
#include <limits>

namespace kairos::experiments {
namespace {

/// The true speed of the bat, between its samples on a straight line.
double true_speed(const RallyRecording& rally, double t) {
  const auto& samples = rally.bat.samples;
  const auto next =
      std::upper_bound(samples.begin(), samples.end(), t,
                       [](double time, const TrackSample& sample) { return time < sample.time; });
  if (next == samples.begin() || next == samples.end()) {
    return 0.0;
  }
  const auto i = static_cast<std::size_t>(next - samples.begin());
  const double part = (t - samples[i - 1].time) / (samples[i].time - samples[i - 1].time);
  return ((1.0 - part) * rally.bat_velocity[i - 1] + part * rally.bat_velocity[i]).norm();
}

}  // namespace

StrokeWatch::StrokeWatch(const RallyRecording& rally)
    : rally_(rally), detector_(find_detector("certified")), strokes_(rally.strokes.size()) {}

void StrokeWatch::begin(const Model& model) {
  model_ = &model;
  bat_ = subject_of(model, "bat");
  ball_ = subject_of(model, "ball");
  crossing_.emplace(model, ball_, bat_);
}

StrokeOutcome* StrokeWatch::stroke_at(Instant t) {
  const auto next =
      std::upper_bound(rally_.strokes.begin(), rally_.strokes.end(), t.seconds,
                       [](double time, const Stroke& stroke) { return time < stroke.begin; });
  if (next == rally_.strokes.begin() || (next - 1)->end <= t.seconds) {
    return nullptr;
  }
  return &strokes_[static_cast<std::size_t>(next - 1 - rally_.strokes.begin())];
}

void StrokeWatch::frame(const Frame& frame) {
  crossing_->frame(frame);
  if (StrokeOutcome* stroke = stroke_at(frame.time)) {
    look(frame, *stroke);
  }
  crossed_ = crossing_->crossings();
}

void StrokeWatch::look(const Frame& frame, StrokeOutcome& stroke) {
  const BodyState& bat = frame.bodies[bat_];
  speeds_.push_back({bat.twist.linear.norm(), true_speed(rally_, frame.time.seconds)});
  if (frame.in_hand[ball_] != 0) {
    return;
  }
  stroke.crossings += static_cast<int>(crossing_->crossings() - crossed_);
  const double gap =
      detector_
          ->overlap(model_->shape(bat_), bat.pose, model_->shape(ball_), frame.bodies[ball_].pose)
          .gap;
  // Less is roundoff of coordinates of a few metres: touching is not penetration.
  if (gap < -64.0 * std::numeric_limits<double>::epsilon()) {
    ++stroke.penetrating;
    stroke.depth = std::max(stroke.depth, -gap);
  }
}

void StrokeWatch::event(const Event& event) {
  const bool bat_and_ball = std::min(event.a, event.b) == std::min(bat_, ball_) &&
                            std::max(event.a, event.b) == std::max(bat_, ball_);
  StrokeOutcome* stroke = stroke_at(event.time);
  if (event.kind != EventKind::impact || !bat_and_ball || stroke == nullptr) {
    return;
  }
  const BodyState& before = event.a == ball_ ? event.before_a : event.before_b;
  const BodyState& after = event.a == ball_ ? event.after_a : event.after_b;
  ++stroke->hits;
  stroke->jumps.push_back((after.pose.position - before.pose.position).norm());
  stroke->kicks.push_back((after.twist.linear - before.twist.linear).norm());
}

}  // namespace kairos::experiments
