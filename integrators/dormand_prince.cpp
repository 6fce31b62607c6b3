#include "integrators/dormand_prince.hpp"

#include "integrators/dense_output.hpp"
#include "integrators/ode_stepper.hpp"
#include "integrators/step_control.hpp"

#include <array>

namespace kairos::integrators {
namespace {

constexpr std::size_t stages = 7;

// The tableau [Hairer1993, table II.5.2]; row 6 is also the solution of order 5.
constexpr std::array<double, stages> c{0.0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1.0, 1.0};
constexpr std::array<std::array<double, stages - 1>, stages> a{{
    {},
    {1.0 / 5},
    {3.0 / 40, 9.0 / 40},
    {44.0 / 45, -56.0 / 15, 32.0 / 9},
    {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
    {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
    {35.0 / 384, 0.0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84},
}};
// Solution of order 5 minus that of order 4.
constexpr std::array<double, stages> error_weights{
    71.0 / 57600, 0.0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
// Of the continuous extension [Hairer1993, code DOPRI5].
constexpr std::array<double, stages> dense_weights{
    -12715105075.0 / 11282082432,  0.0,
    87487479700.0 / 32700410799,   -10690763975.0 / 1880347072,
    701980252875.0 / 199316789632, -1453857185.0 / 822651844,
    69997945.0 / 29380423};

class DormandPrince final : public OdeStepper {
 public:
  /// `first_step`: 0: not known.
  explicit DormandPrince(const StepperOptions& options, double first_step = 0.0)
      : OdeStepper(2), control_(options, 5), first_step_(first_step) {}
  [[nodiscard]] StepperInfo info() const override { return dopri5_info; }

  void start(const Island& island, Instant t, std::span<const BodyState> states) override {
    OdeStepper::start(island, t, states);
    rotates_.clear();
    for (const BodyInertia& inertia : island.inertia) {
      rotates_.push_back(inertia.rotates);
    }
    for (std::vector<double>& k : k_) {
      k.assign(ode_.size(), 0.0);
    }
    stage_.assign(ode_.size(), 0.0);
    control_.forget();
    control_.propose(first_step_);
    h_ = 0.0;
  }

  StepResult step(const Island& island, Instant t, double h, std::span<BodyState> states) override {
    const HermiteMotion::Node first = begin_step(island, t, states);
    std::copy_n(first.rate, ode_.size(), k_[0].begin());
    if (!control_.has_proposal()) {
      control_.propose_first([this](double s, const double* y, double* dy) { ode_.rhs(s, y, dy); },
                             first.y, first.rate, h, stage_, k_[1]);
    }
    for (double trial = control_.first_trial(h); trial > 0.0;) {
      const HermiteMotion::Node last = attempt(first, trial);
      const double error = control_.active() ? largest_error(first.y, last.y, trial) : 0.0;
      if (error <= 1.0) {
        control_.accept(trial, error);
        h_ = trial;
        end_step(states);
        return {.advanced = trial, .error = error, .ok = true, .reason = {}};
      }
      trial = control_.shorter(trial, error);
    }
    return {.advanced = 0.0,
            .error = 0.0,
            .ok = false,
            .reason = "dopri5: no step is short enough for the tolerance"};
  }

  void dense_output(std::span<Motion> motions) const override {
    OdeStepper::dense_output(motions);  // the frame, and parabolas under constant force
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const std::size_t offset = ode_.slots()[i].offset;
      if (!constant_acceleration()) {
        motions[i].position = extension<3>(offset + IslandOde::position);
        motions[i].velocity = extension<3>(offset + IslandOde::velocity);
      }
      if (rotates_[i]) {
        motions[i].quaternion = extension<4>(offset + IslandOde::quaternion);
        motions[i].angular_velocity = extension<3>(offset + IslandOde::angular);
      }
    }
  }

  bool persist(Archive& archive) override {
    archive(control_, k_, h_);
    return OdeStepper::persist(archive);
  }

 private:
  HermiteMotion::Node attempt(const HermiteMotion::Node& first, double h) {
    for (std::size_t stage = 1; stage + 1 < stages; ++stage) {
      combine(first.y, h, stage, stage_.data());
      ode_.rhs(c[stage] * h, stage_.data(), k_[stage].data());
    }
    dense_.truncate(1);
    const HermiteMotion::Node last = dense_.add(h);
    combine(first.y, h, stages - 1, last.y);
    finish_node(h, last);
    std::copy_n(last.rate, ode_.size(), k_[stages - 1].begin());
    return last;
  }

  // out = y + h sum_j a_ij k_j
  void combine(const double* y, double h, std::size_t row, double* out) const {
    for (std::size_t n = 0; n < ode_.size(); ++n) {
      double slope = 0.0;
      for (std::size_t j = 0; j < row; ++j) {
        slope += a[row][j] * k_[j][n];
      }
      out[n] = y[n] + h * slope;
    }
  }

  [[nodiscard]] double weighted(const std::array<double, stages>& weights, std::size_t n) const {
    double sum = 0.0;
    for (std::size_t j = 0; j < stages; ++j) {
      sum += weights[j] * k_[j][n];
    }
    return sum;
  }

  [[nodiscard]] double largest_error(const double* y0, const double* y1, double h) {
    for (std::size_t n = 0; n < ode_.size(); ++n) {
      stage_[n] = h * weighted(error_weights, n);
    }
    return control_.largest(stage_, y0, y1);
  }

  // y(theta) = r1 + theta (r2 + (1 - theta) (r3 + theta (r4 + (1 - theta) r5))), theta = s / h
  // [Hairer1993, code DOPRI5], in powers of s.
  template <int Dim>
  [[nodiscard]] Polynomial<Dim> extension(std::size_t offset) const {
    Polynomial<Dim> result;
    result.resize(4);
    for (int axis = 0; axis < Dim; ++axis) {
      const std::size_t n = offset + static_cast<std::size_t>(axis);
      const double y0 = dense_.y(0)[n];
      const double r2 = dense_.y(1)[n] - y0;
      const double r3 = h_ * k_[0][n] - r2;
      const double r4 = r2 - h_ * k_[stages - 1][n] - r3;
      const double r5 = h_ * weighted(dense_weights, n);
      result[0][axis] = y0;
      result[1][axis] = k_[0][n];
      result[2][axis] = (r4 + r5 - r3) / h_ / h_;
      result[3][axis] = (-2.0 * r5 - r4) / h_ / h_ / h_;
      result[4][axis] = r5 / h_ / h_ / h_ / h_;
    }
    return result;
  }

  StepControl control_;
  double first_step_;  ///< s
  std::array<std::vector<double>, stages> k_;
  std::vector<double> stage_;
  std::vector<char> rotates_;
  double h_ = 0.0;
};

}  // namespace

std::unique_ptr<Stepper> make_dopri5(const StepperOptions& options) {
  return std::make_unique<DormandPrince>(options);
}

std::unique_ptr<Stepper> make_dopri5(const StepperOptions& options, double first_step) {
  return std::make_unique<DormandPrince>(options, first_step);
}

}  // namespace kairos::integrators
