#include "integrators/sundials/arkode.hpp"

#include "integrators/composite_stepper.hpp"
#include "integrators/sundials/island_system.hpp"

namespace kairos::integrators {
namespace {

using sundials::IslandSystem;

struct FreeErkStep {
  void operator()(void* memory) const { ERKStepFree(&memory); }
};

/// Of ERKStep's default tables those of orders 2, 6 and 8 lose their order where it takes their
/// last stage for y' at the end of the step (6 falls to 3). A reset before each step makes it
/// evaluate y'.
constexpr bool forgets_last_stage(int order) {
  return sundials::erkstep_reuses_last_stage && (order == 2 || order == 6 || order == 8);
}

class Arkode final : public CompositeStepper {
 public:
  Arkode(const StepperInfo& info, const StepperOptions& options)
      : CompositeStepper(nodes_for(info.order), "ARKODE: no step is short enough for the tolerance",
                         options),
        info_(info),
        options_(options) {}
  [[nodiscard]] StepperInfo info() const override { return info_; }

  void start(const Island& island, Instant t, std::span<const BodyState> states) override {
    CompositeStepper::start(island, t, states);
    memory_.reset();
    context_ = sundials::make_context();
    y_ = sundials::make_vector(ode_.size(), context_.get());
    N_VConst(0.0, y_.get());
    system_ = {&ode_, 0.0};
    memory_.reset(ERKStepCreate(IslandSystem::rhs, 0.0, y_.get(), context_.get()));
    ERKStepSetUserData(memory_.get(), &system_);
    sundials::silence_erkstep(memory_.get());
    ERKStepSetOrder(memory_.get(), info_.order);
    if (sundials::controlled(options_)) {
      const sundials::Tolerances tolerances(options_, ode_.size());
      ERKStepSStolerances(memory_.get(), tolerances.relative, tolerances.absolute);
    } else {
      ERKStepSStolerances(memory_.get(), 1.0, 1.0);  // not looked at: steps are fixed
    }
    fresh_ = true;
  }

  void restart(const Island& island, Instant t, std::span<const BodyState> states) override {
    CompositeStepper::restart(island, t, states);
    fresh_ = true;
  }

 private:
  [[nodiscard]] bool rewind() override {
    fresh_ = true;
    return true;
  }

  Substep substep(double s, double h, const double* y, const double* /*rate*/,
                  double* y1) override {
    // The clock runs on from step to step, unless it no longer resolves h.
    if (fresh_ || forgets_last_stage(info_.order) || h < 1e-9 * clock_) {
      std::copy_n(y, ode_.size(), sundials::data(y_.get()));
      ERKStepReset(memory_.get(), 0.0, y_.get());
      clock_ = 0.0;
      fresh_ = false;
    }
    system_.offset = s - clock_;
    if (!sundials::controlled(options_)) {
      ERKStepSetFixedStep(memory_.get(), h);
    }
    const double end = clock_ + h;
    ERKStepSetStopTime(memory_.get(), end);
    sundials::Real reached = clock_;
    const int status = ERKStepEvolve(memory_.get(), end, y_.get(), &reached, ARK_ONE_STEP);
    const double advanced = reached < end ? reached - clock_ : h;
    if (status < 0 || !(advanced > 0.0)) {
      return {};
    }
    clock_ = reached;
    std::copy_n(sundials::data(y_.get()), ode_.size(), y1);
    return {.advanced = advanced, .error = 0.0};
  }

  StepperInfo info_;
  StepperOptions options_;
  sundials::Context context_;
  sundials::Vector y_;  ///< the solver's own, whose quaternions are not normalised
  IslandSystem system_;
  std::unique_ptr<void, FreeErkStep> memory_;
  double clock_ = 0.0;  ///< the solver's time since it was reset, s
  bool fresh_ = true;
};

}  // namespace

std::unique_ptr<Stepper> make_arkode_2(const StepperOptions& options) {
  return std::make_unique<Arkode>(arkode_info("arkode-2", 2), options);
}
std::unique_ptr<Stepper> make_arkode_3(const StepperOptions& options) {
  return std::make_unique<Arkode>(arkode_info("arkode-3", 3), options);
}
std::unique_ptr<Stepper> make_arkode_4(const StepperOptions& options) {
  return std::make_unique<Arkode>(arkode_info("arkode-4", 4), options);
}
std::unique_ptr<Stepper> make_arkode_5(const StepperOptions& options) {
  return std::make_unique<Arkode>(arkode_info("arkode-5", 5), options);
}
std::unique_ptr<Stepper> make_arkode_6(const StepperOptions& options) {
  return std::make_unique<Arkode>(arkode_info("arkode-6", 6), options);
}
std::unique_ptr<Stepper> make_arkode_8(const StepperOptions& options) {
  return std::make_unique<Arkode>(arkode_info("arkode-8", 8), options);
}

}  // namespace kairos::integrators
