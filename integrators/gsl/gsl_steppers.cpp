#include "integrators/gsl/gsl_steppers.hpp"

#include "integrators/composite_stepper.hpp"
#include "integrators/step_control.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include <algorithm>
#include <limits>

namespace kairos::integrators {
namespace {

constexpr std::string_view failure = "GSL: no step is short enough for the tolerance";

template <auto release>
struct Release {
  template <typename T>
  void operator()(T* resource) const {
    release(resource);
  }
};
using StepHandle = std::unique_ptr<gsl_odeiv2_step, Release<gsl_odeiv2_step_free>>;
using DriverHandle = std::unique_ptr<gsl_odeiv2_driver, Release<gsl_odeiv2_driver_free>>;

/// An `IslandOde` as GSL sees it; `offset` is what its time is behind the system's.
struct System {
  IslandOde* ode = nullptr;
  double offset = 0.0;
  std::vector<double> varied, plus, minus;  ///< scratch of the Jacobian

  static int rhs(double t, const double y[], double dydt[], void* self) {
    auto& system = *static_cast<System*>(self);
    system.ode->rhs(system.offset + t, y, dydt);
    return GSL_SUCCESS;
  }

  /// Central differences: their error, eps^(2/3) relative, slows convergence and moves no solution.
  static int jacobian(double t, const double y[], double* dfdy, double dfdt[], void* self) {
    auto& system = *static_cast<System*>(self);
    const std::size_t size = system.ode->size();
    const double step = std::cbrt(std::numeric_limits<double>::epsilon());
    system.varied.assign(y, y + size);
    for (std::size_t j = 0; j < size; ++j) {
      const double delta = step * std::max(1.0, std::abs(y[j]));
      system.varied[j] = y[j] + delta;
      rhs(t, system.varied.data(), system.plus.data(), self);
      system.varied[j] = y[j] - delta;
      rhs(t, system.varied.data(), system.minus.data(), self);
      system.varied[j] = y[j];
      for (std::size_t i = 0; i < size; ++i) {
        dfdy[i * size + j] = (system.plus[i] - system.minus[i]) / (2.0 * delta);
      }
    }
    rhs(t + step, y, system.plus.data(), self);
    rhs(t - step, y, system.minus.data(), self);
    for (std::size_t i = 0; i < size; ++i) {
      dfdt[i] = (system.plus[i] - system.minus[i]) / (2.0 * step);
    }
    return GSL_SUCCESS;
  }
};

/// Common to all: the system, and GSL told to return its errors.
class GslStepper : public CompositeStepper {
 public:
  void start(const Island& island, Instant t, std::span<const BodyState> states) override {
    CompositeStepper::start(island, t, states);
    system_.ode = &ode_;
    system_.plus.assign(ode_.size(), 0.0);
    system_.minus.assign(ode_.size(), 0.0);
    system_.varied.assign(ode_.size(), 0.0);
    gsl_system_ = {System::rhs, System::jacobian, ode_.size(), &system_};
  }

 protected:
  GslStepper(std::size_t nodes, const StepperOptions& options)
      : CompositeStepper(nodes, failure, options) {
    gsl_set_error_handler_off();
  }

  System system_;
  gsl_odeiv2_system gsl_system_{};
};

/// Runge-Kutta and extrapolation: GSL's step under our control.
class GslOneStep final : public GslStepper {
 public:
  GslOneStep(const StepperInfo& info, const gsl_odeiv2_step_type* type, int control_order,
             const StepperOptions& options)
      : GslStepper(nodes_for(info.velocity_order), options),
        info_(info),
        type_(type),
        control_(options, control_order) {}
  [[nodiscard]] StepperInfo info() const override { return info_; }

  void start(const Island& island, Instant t, std::span<const BodyState> states) override {
    GslStepper::start(island, t, states);
    step_.reset(gsl_odeiv2_step_alloc(type_, ode_.size()));
    errors_.assign(ode_.size(), 0.0);
    control_.forget();
  }

  bool persist(Archive& archive) override {
    archive(control_);
    return persist_memoryless(archive);
  }

 private:
  Substep substep(double s, double h, const double* y, const double* rate, double* y1) override {
    system_.offset = s;
    if (!control_.has_proposal()) {
      control_.propose_first(
          [&](double ds, const double* state, double* dy) { ode_.rhs(s + ds, state, dy); }, y, rate,
          h, system_.varied, system_.plus);
    }
    for (double trial = control_.first_trial(h); trial > 0.0;) {
      std::copy_n(y, ode_.size(), y1);
      const int status = gsl_odeiv2_step_apply(step_.get(), 0.0, trial, y1, errors_.data(), rate,
                                               nullptr, &gsl_system_);
      const double error = status != GSL_SUCCESS ? std::numeric_limits<double>::infinity()
                           : control_.active()   ? control_.largest(errors_, y, y1)
                                                 : 0.0;
      if (error <= 1.0) {
        control_.accept(trial, error);
        return {.advanced = trial, .error = error};
      }
      gsl_odeiv2_step_reset(step_.get());
      trial = control_.shorter(trial, error);
    }
    return {};
  }

  StepperInfo info_;
  const gsl_odeiv2_step_type* type_;
  StepControl control_;
  StepHandle step_;
  std::vector<double> errors_;
};

/// Adams in Nordsieck form, orders 1 to 12: it chooses step and order itself and is started anew
/// after an impact.
class GslAdams final : public GslStepper {
 public:
  explicit GslAdams(const StepperOptions& options) : GslStepper(3, options), options_(options) {}
  [[nodiscard]] StepperInfo info() const override { return gsl_msadams_info; }

  [[nodiscard]] std::string refuses(const Island& island) const override {
    if (!StepControl(options_, 1).active()) {
      return "gsl-msadams chooses its steps itself: it needs finite tolerances";
    }
    return GslStepper::refuses(island);
  }

  void start(const Island& island, Instant t, std::span<const BodyState> states) override {
    GslStepper::start(island, t, states);
    // GSL accepts errors up to 1.1 of the tolerance; no tolerance is below roundoff.
    const double least = 4.0 * std::numeric_limits<double>::epsilon();
    driver_.reset(gsl_odeiv2_driver_alloc_y_new(
        &gsl_system_, gsl_odeiv2_step_msadams, first_step,
        std::max(options_.absolute_tolerance, std::numeric_limits<double>::min()) / 1.1,
        std::max(options_.relative_tolerance, least) / 1.1));
    solution_.assign(ode_.size(), 0.0);
    fresh_ = true;
  }

  void restart(const Island& island, Instant t, std::span<const BodyState> states) override {
    GslStepper::restart(island, t, states);
    fresh_ = true;
  }

 private:
  // Its history would be lost.
  [[nodiscard]] bool rewind() override { return false; }

  static constexpr double first_step = 1e-6;  // s; the controller lengthens it at once

  Substep substep(double s, double h, const double* y, const double* /*rate*/,
                  double* y1) override {
    // GSL remembers the times of past steps: its clock must run on.
    if (fresh_ || h < 1e-9 * clock_) {
      gsl_odeiv2_driver_reset_hstart(driver_.get(), first_step);
      std::copy_n(y, ode_.size(), solution_.begin());
      clock_ = 0.0;
      fresh_ = false;
    }
    system_.offset = s - clock_;
    const double end = clock_ + h;
    double t = clock_;
    const double proposed = driver_->h;
    double next = std::min(proposed, h);
    const int status = gsl_odeiv2_evolve_apply(driver_->e, driver_->c, driver_->s, &gsl_system_, &t,
                                               end, &next, solution_.data());
    const double advanced = t < end ? t - clock_ : h;
    if (status != GSL_SUCCESS || !(advanced > 0.0)) {
      return {};
    }
    clock_ = t;
    // A step that was cut to what was asked for does not shorten the next.
    driver_->h = t < end ? next : std::max(next, std::min(proposed, 10.0 * h));
    std::copy(solution_.begin(), solution_.end(), y1);
    return {.advanced = advanced, .error = 0.0};
  }

  StepperOptions options_;
  DriverHandle driver_;
  std::vector<double> solution_;  ///< the solver's own, whose quaternions are not normalised
  double clock_ = 0.0;            ///< the solver's time since it was started anew, s
  bool fresh_ = true;
};

}  // namespace

std::unique_ptr<Stepper> make_gsl_rkf45(const StepperOptions& options) {
  return std::make_unique<GslOneStep>(gsl_rkf45_info, gsl_odeiv2_step_rkf45, 5, options);
}
std::unique_ptr<Stepper> make_gsl_rkck(const StepperOptions& options) {
  return std::make_unique<GslOneStep>(gsl_rkck_info, gsl_odeiv2_step_rkck, 5, options);
}
std::unique_ptr<Stepper> make_gsl_rk8pd(const StepperOptions& options) {
  return std::make_unique<GslOneStep>(gsl_rk8pd_info, gsl_odeiv2_step_rk8pd, 8, options);
}
std::unique_ptr<Stepper> make_gsl_msadams(const StepperOptions& options) {
  return std::make_unique<GslAdams>(options);
}
std::unique_ptr<Stepper> make_gsl_bsimp(const StepperOptions& options) {
  return std::make_unique<GslOneStep>(gsl_bsimp_info, gsl_odeiv2_step_bsimp, 8, options);
}

}  // namespace kairos::integrators
