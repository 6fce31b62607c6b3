#pragma once

#include "core/archive.hpp"
#include "core/exponential.hpp"
#include "core/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace kairos::integrators {

/// Error control of one-step methods: the one meaning of tolerance of `StepperOptions`, and how
/// long the next step should be [Hairer1993, II.4]. Remembers its proposal across restarts: after
/// an impact the forces are as smooth as before.
class StepControl {
 public:
  /// `order`: of the local error that the estimate tells.
  StepControl(const StepperOptions& options, int order)
      : relative_(options.relative_tolerance),
        absolute_(options.absolute_tolerance),
        exponent_(-1.0 / order) {}

  /// False: every step is as long as asked for.
  [[nodiscard]] bool active() const { return std::isfinite(relative_) && std::isfinite(absolute_); }
  void forget() { proposed_ = 0.0; }
  [[nodiscard]] bool has_proposal() const { return !active() || proposed_ > 0.0; }
  void propose(double h) { proposed_ = h; }
  void persist(Archive& archive) { archive(proposed_, asked_, shrunk_); }

  /// The error of one component in units of its tolerance. No tolerance is below roundoff.
  [[nodiscard]] double scaled(double error, double y0, double y1) const {
    constexpr double roundoff = 4.0 * std::numeric_limits<double>::epsilon();
    const double size = std::max(std::abs(y0), std::abs(y1));
    const double allowed = absolute_ + std::max(relative_, roundoff) * size;
    return std::abs(error) / std::max(allowed, std::numeric_limits<double>::min());
  }

  /// The largest of all components; infinite if any is not a number.
  [[nodiscard]] double largest(std::span<const double> errors, const double* y0,
                               const double* y1) const {
    double worst = 0.0;
    for (std::size_t n = 0; n < errors.size(); ++n) {
      const double error = scaled(errors[n], y0[n], y1[n]);
      if (!std::isfinite(error)) {
        return std::numeric_limits<double>::infinity();
      }
      worst = std::max(worst, error);
    }
    return worst;
  }

  /// A first guess from the sizes of y' and, by an Euler step, y'' [Hairer1993, II.4]. `rhs(s, y,
  /// dy)` is called once; `stage` and `slope` are scratch.
  template <typename Rhs>
  void propose_first(const Rhs& rhs, const double* y, const double* rate, double h,
                     std::span<double> stage, std::span<double> slope) {
    double d0 = 0.0, d1 = 0.0, d2 = 0.0;
    for (std::size_t n = 0; n < stage.size(); ++n) {
      d0 = std::max(d0, scaled(y[n], y[n], 0.0));
      d1 = std::max(d1, scaled(rate[n], y[n], 0.0));
    }
    const double guess = std::min(h, d0 > 0.0 && d1 > 0.0 ? 0.01 * d0 / d1 : 1e-6 * h);
    for (std::size_t n = 0; n < stage.size(); ++n) {
      stage[n] = y[n] + guess * rate[n];
    }
    rhs(guess, stage.data(), slope.data());
    for (std::size_t n = 0; n < stage.size(); ++n) {
      d2 = std::max(d2, scaled((slope[n] - rate[n]) / guess, y[n], 0.0));
    }
    // [Hairer1993] takes a second for the time in which y changes by its own size: here it is that
    // time, whatever its unit.
    const double change = std::min(d0 / d1, std::sqrt(d0 / d2));
    const double from_order =
        std::isfinite(change) && change > 0.0 ? change * power(0.01 / d0, -exponent_) : h;
    proposed_ = std::min({100.0 * guess, from_order, h});
  }

  /// The first length to try when at most h is asked for; rather two halves than a whole and a
  /// sliver.
  [[nodiscard]] double first_trial(double h) {
    shrunk_ = false;
    asked_ = h;
    return !active() || proposed_ >= h ? h : std::min(proposed_, 0.5 * h);
  }
  /// A trial got only this far, for another's reasons: what `shorter` compares with.
  void cut(double reached) { asked_ = std::min(asked_, reached); }
  /// A trial had this error > 1: the next length to try; 0: there is none.
  [[nodiscard]] double shorter(double trial, double error) {
    constexpr double least_fraction = 1e-14;
    shrunk_ = true;
    const double next = trial * std::min(factor(error), 0.9);
    return next >= least_fraction * asked_ ? next : 0.0;
  }
  /// A trial was accepted. One that was cut to what was asked for does not shorten the next.
  void accept(double trial, double error) {
    const double next = trial * factor(error);
    proposed_ =
        shrunk_ ? std::min(next, trial) : std::max(next, trial < proposed_ ? proposed_ : 0.0);
  }

 private:
  [[nodiscard]] double factor(double error) const {
    constexpr double safety = 0.9, least = 0.2, most = 5.0;
    if (!std::isfinite(error)) {
      return least;
    }
    return error > 0.0 ? std::clamp(safety * power(error, exponent_), least, most) : most;
  }

  double relative_;
  double absolute_;
  double exponent_;
  double proposed_ = 0.0;  ///< s; 0: not known yet
  double asked_ = 0.0;
  bool shrunk_ = false;
};

}  // namespace kairos::integrators
