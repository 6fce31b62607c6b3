#pragma once

#include "ccd/quadratic_gap.hpp"
#include "core/contact_detector.hpp"

#include <algorithm>

namespace kairos::ccd {

/// Local time of a motion at the start of a window.
[[nodiscard]] inline double start_of(const Motion& motion, const Window& window) {
  return window.start == motion.start ? 0.0 : window.start - motion.start;
}
/// Local time of a motion at window time t, as everybody else computes it.
[[nodiscard]] inline double local_time(const Motion& motion, const Window& window, double t) {
  return (window.start + t) - motion.start;
}

/// Roundoff of the coordinates at the start, m: a gap within it of zero is a contact.
[[nodiscard]] inline double touch_band(const Motion& a, const Motion& b, double size) {
  return 64.0 * unit_roundoff *
         (a.position[0].cwiseAbs().maxCoeff() + b.position[0].cwiseAbs().maxCoeff() + size);
}

/// Status and bracket of the first descent of a gap within a window.
[[nodiscard]] inline TimeOfImpact descent_answer(const FirstDescent& descent, double duration) {
  TimeOfImpact toi;
  toi.evaluations = 1;
  toi.t_lo = toi.t_hi = duration;
  if (descent.kind == Descent::none || descent.t_lo > duration) {
    return toi;
  }
  if (!(descent.t_lo >= 0.0)) {  // not a number: overflow inside a motion decides nothing
    toi.status = ToiStatus::undecided;
    toi.t_lo = 0.0;
    return toi;
  }
  toi.t_lo = descent.t_lo;
  toi.t_hi = std::min(descent.t_hi, duration);
  switch (descent.kind) {
    case Descent::inside:
      toi.status = ToiStatus::overlapping;
      break;
    case Descent::found:
      toi.status = descent.t_hi <= duration ? ToiStatus::impact : ToiStatus::undecided;
      break;
    case Descent::in_touch:
      toi.status = ToiStatus::impact;
      break;
    default:
      toi.status = ToiStatus::undecided;
  }
  return toi;
}

}  // namespace kairos::ccd
