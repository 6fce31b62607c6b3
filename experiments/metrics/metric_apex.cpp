#include "experiments/metrics/metric_apex.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::experiments {

void ApexWatch::look_at(const Motion& motion, double s) {
  const double height = motion.position(s).y();
  if (!any_ || height > highest_.height) {
    highest_ = {(motion.start + s).seconds, height};
    any_ = true;
  }
}

void ApexWatch::look(const Motion& motion, double duration) {
  look_at(motion, 0.0);
  if (!std::isfinite(duration)) {
    return;
  }
  look_at(motion, duration);
  // Inside: the root of a parabola's slope; higher degrees differ from it within a step by less
  // than a step's own error.
  const double slope = motion.position.derivative(0.0).y();
  const double end_slope = motion.position.derivative(duration).y();
  if (slope > 0.0 && end_slope < 0.0) {
    look_at(motion, duration * slope / (slope - end_slope));
  }
}

void ApexWatch::motion(BodyIndex body, const Motion& motion) {
  if (body != body_) {
    return;
  }
  if (moving_) {
    look(current_, std::clamp(motion.start - current_.start, 0.0, current_.duration));
  }
  current_ = motion;
  moving_ = true;
}

void ApexWatch::event(const Event& event) {
  if (event.kind != EventKind::impact || (event.a != body_ && event.b != body_)) {
    return;
  }
  if (moving_) {
    look(current_, std::clamp(event.time - current_.start, 0.0, current_.duration));
  }
  if (any_) {
    apexes_.push_back(highest_);
  }
  any_ = false;
  moving_ = false;  // what follows the impact is a new rise
}

}  // namespace kairos::experiments
