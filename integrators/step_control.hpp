#pragma once

#include "core/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos::integrators {

/// Error control of one-step methods: the one meaning of tolerance of `StepperOptions`, and how
/// long the next step should be [Hairer1993, II.4].
class StepControl {
 public:
  /// `order`: of the error estimate's local error; `options`: see `StepperOptions`.
  StepControl(const StepperOptions& options, int order)
      : relative_(options.relative_tolerance),
        absolute_(options.absolute_tolerance),
        exponent_(-1.0 / order) {}

  /// False: every step is as long as asked for.
  [[nodiscard]] bool active() const { return std::isfinite(relative_) && std::isfinite(absolute_); }

  /// The error of one component in units of its tolerance. No tolerance is below roundoff.
  [[nodiscard]] double scaled(double error, double y0, double y1) const {
    constexpr double roundoff = 4.0 * std::numeric_limits<double>::epsilon();
    const double size = std::max(std::abs(y0), std::abs(y1));
    const double allowed = absolute_ + std::max(relative_, roundoff) * size;
    return std::abs(error) / std::max(allowed, std::numeric_limits<double>::min());
  }

  /// Factor by which the step may grow, or must shrink, after a step of this error.
  [[nodiscard]] double factor(double error) const {
    constexpr double safety = 0.9, least = 0.2, most = 5.0;
    if (!std::isfinite(error)) {
      return least;
    }
    return error > 0.0 ? std::clamp(safety * std::pow(error, exponent_), least, most) : most;
  }

 private:
  double relative_;
  double absolute_;
  double exponent_;
};

}  // namespace kairos::integrators
