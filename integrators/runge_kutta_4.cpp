#include "integrators/runge_kutta_4.hpp"

#include "integrators/ode_stepper.hpp"

namespace kairos::integrators {
namespace {

class RungeKutta4 final : public OdeStepper {
 public:
  RungeKutta4() : OdeStepper(2) {}
  [[nodiscard]] StepperInfo info() const override { return rk4_info; }

  void start(const Island& island, Instant t, std::span<const BodyState> states) override {
    OdeStepper::start(island, t, states);
    stage_.assign(ode_.size(), 0.0);
    k2_ = k3_ = k4_ = stage_;
  }

  StepResult step(const Island& island, Instant t, double h, std::span<BodyState> states) override {
    const HermiteMotion::Node first = begin_step(island, t, states);
    evaluate(first.y, first.rate, 0.5 * h, k2_);
    evaluate(first.y, k2_.data(), 0.5 * h, k3_);
    evaluate(first.y, k3_.data(), h, k4_);
    const HermiteMotion::Node last = dense_.add(h);
    for (std::size_t i = 0; i < ode_.size(); ++i) {
      last.y[i] =
          first.y[i] + h * ((first.rate[i] + k4_[i]) + 2.0 * (k2_[i] + k3_[i])) * (1.0 / 6.0);
    }
    finish_node(h, last);
    end_step(states);
    return {.advanced = h, .error = 0.0, .ok = true, .reason = {}};
  }

 private:
  // k = f(ch, y + ch slope)
  void evaluate(const double* y, const double* slope, double ch, std::vector<double>& k) {
    for (std::size_t i = 0; i < stage_.size(); ++i) {
      stage_[i] = y[i] + ch * slope[i];
    }
    ode_.rhs(ch, stage_.data(), k.data());
  }

  std::vector<double> stage_, k2_, k3_, k4_;
};

}  // namespace

std::unique_ptr<Stepper> make_rk4(const StepperOptions& /*options*/) {
  return std::make_unique<RungeKutta4>();
}

}  // namespace kairos::integrators
