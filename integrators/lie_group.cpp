#include "integrators/lie_group.hpp"

#include "integrators/dense_output.hpp"
#include "integrators/ode_stepper.hpp"

#include <array>

namespace kairos::integrators {
namespace {

// dexp^-1(theta) w, cut where a method of order 4 no longer sees it.
Vector3 inverse_differential(const Vector3& theta, const Vector3& w) {
  const Vector3 bracket = theta.cross(w);
  return w - 0.5 * bracket + theta.cross(bracket) / 12.0;
}

class MuntheKaas4 final : public OdeStepper {
 public:
  MuntheKaas4() : OdeStepper(2) {}
  [[nodiscard]] StepperInfo info() const override { return rkmk4_info; }

  void start(const Island& island, Instant t, std::span<const BodyState> states) override {
    OdeStepper::start(island, t, states);
    stage_.assign(ode_.size(), 0.0);
    for (std::vector<double>& k : k_) {
      k.assign(ode_.size(), 0.0);
    }
    for (std::vector<Vector3>& theta : theta_rate_) {
      theta.assign(states.size(), Vector3::Zero());
    }
    theta_.assign(states.size(), Vector3::Zero());
  }

  StepResult step(const Island& island, Instant t, double h, std::span<BodyState> states) override {
    const HermiteMotion::Node first = begin_step(island, t, states);
    std::copy_n(first.rate, ode_.size(), k_[0].begin());
    for (std::size_t i = 0; i < states.size(); ++i) {
      theta_rate_[0][i] = states[i].twist.angular;
    }
    evaluate(first.y, states, 0, 0.5 * h);
    evaluate(first.y, states, 1, 0.5 * h);
    evaluate(first.y, states, 2, h);

    const HermiteMotion::Node last = dense_.add(h);
    for (std::size_t n = 0; n < ode_.size(); ++n) {
      last.y[n] =
          first.y[n] + h * (1.0 / 6.0) * ((k_[0][n] + k_[3][n]) + 2.0 * (k_[1][n] + k_[2][n]));
    }
    for (std::size_t i = 0; i < states.size(); ++i) {
      theta_[i] =
          h * (1.0 / 6.0) *
          ((theta_rate_[0][i] + theta_rate_[3][i]) + 2.0 * (theta_rate_[1][i] + theta_rate_[2][i]));
    }
    write_orientations(states, last.y);
    finish_node(h, last);
    end_step(states);
    return {.advanced = h, .error = 0.0, .ok = true, .reason = {}};
  }

 private:
  // Stage j + 1 at local time ch from the slopes of stage j.
  void evaluate(const double* y, std::span<const BodyState> states, std::size_t j, double ch) {
    for (std::size_t n = 0; n < stage_.size(); ++n) {
      stage_[n] = y[n] + ch * k_[j][n];
    }
    for (std::size_t i = 0; i < theta_.size(); ++i) {
      theta_[i] = ch * theta_rate_[j][i];
    }
    write_orientations(states, stage_.data());
    ode_.rhs(ch, stage_.data(), k_[j + 1].data());
    for (std::size_t i = 0; i < theta_.size(); ++i) {
      if (ode_.slots()[i].rotates) {
        const double* const w = &stage_[ode_.slots()[i].offset + IslandOde::angular];
        theta_rate_[j + 1][i] = inverse_differential(theta_[i], {w[0], w[1], w[2]});
      }
    }
  }

  // q = exp(theta / 2) q0 into a flat state.
  void write_orientations(std::span<const BodyState> states, double* y) const {
    for (std::size_t i = 0; i < states.size(); ++i) {
      if (ode_.slots()[i].rotates) {
        const Quaternion q = rotate(theta_[i], states[i].pose.orientation);
        Eigen::Map<Vector4>(y + ode_.slots()[i].offset + IslandOde::quaternion) = as_vector(q);
      }
    }
  }

  std::vector<double> stage_;
  std::array<std::vector<double>, 4> k_;
  std::vector<Vector3> theta_;
  std::array<std::vector<Vector3>, 4> theta_rate_;
};

}  // namespace

std::unique_ptr<Stepper> make_rkmk4(const StepperOptions& /*options*/) {
  return std::make_unique<MuntheKaas4>();
}

}  // namespace kairos::integrators
