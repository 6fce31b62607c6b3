#include "integrators/splitting.hpp"

#include "integrators/ode_stepper.hpp"
#include "integrators/top_splitting.hpp"

namespace kairos::integrators {
namespace {

// 1/(2 - 2^(1/3)) and 1/(4 - 4^(1/3)).
constexpr double forest_ruth_weight = 1.3512071919596577;
constexpr double suzuki_weight = 0.41449077179437571;

constexpr double strang_steps[] = {1.0};
constexpr double forest_ruth_steps[] = {forest_ruth_weight, 1.0 - 2.0 * forest_ruth_weight,
                                        forest_ruth_weight};
constexpr double suzuki_steps[] = {suzuki_weight, suzuki_weight, 1.0 - 4.0 * suzuki_weight,
                                   suzuki_weight, suzuki_weight};

class Splitting final : public Stepper {
 public:
  Splitting(const StepperInfo& info, std::span<const double> weights)
      : info_(info), weights_(weights) {}
  [[nodiscard]] StepperInfo info() const override { return info_; }
  [[nodiscard]] std::int64_t evaluations() const override { return evaluations_; }

  [[nodiscard]] std::string refuses(const Island& island) const override {
    for (const Force* force : island.forces) {
      if (!force->conservative()) {
        return std::string(info_.name) + " is for forces that have a potential; " +
               force->description() + " has none";
      }
    }
    return {};
  }

  void start(const Island& island, Instant t, std::span<const BodyState> states) override {
    ode_.layout(island);
    dense_.resize(2, ode_.size());
    wrenches_.assign(states.size(), {});
    orientations_.assign(states.size(), Quaternion::Identity());
    momenta_.assign(states.size(), Vector3::Zero());
    restart(island, t, states);
  }

  void restart(const Island& /*island*/, Instant /*t*/,
               std::span<const BodyState> /*states*/) override {
    primed_ = false;
  }

  StepResult step(const Island& island, Instant t, double h, std::span<BodyState> states) override {
    if (!primed_) {
      prime(island, t, states);
    }
    constant_acceleration_ = island.constant_acceleration();
    dense_.begin(t);
    record(island, states, dense_.add(0.0));
    double s = 0.0;
    for (const double weight : weights_) {
      const double part = weight * h;
      kick(island, 0.5 * part, states);
      drift(island, part, states);
      s += part;
      evaluate(island, t + s, states);
      kick(island, 0.5 * part, states);
    }
    record(island, states, dense_.add(h));
    return {.advanced = h, .error = 0.0, .ok = true, .reason = {}};
  }

  void dense_output(std::span<Motion> motions) const override {
    dense_.motions(ode_, constant_acceleration_, orientations_, motions);
  }

  bool replay(const Island& island, double s, std::span<const BodyState> before,
              std::span<ReplayedStep> after) const override {
    return replay_parabola(island, s, before, after);
  }

  bool persist(Archive& archive) override {
    archive(ode_, dense_, wrenches_, orientations_, momenta_, primed_, constant_acceleration_,
            evaluations_);
    return true;
  }

 private:
  // Momenta are memory: turned into velocities and back at each step they would wear out.
  void prime(const Island& island, Instant t, std::span<const BodyState> states) {
    for (std::size_t i = 0; i < states.size(); ++i) {
      orientations_[i] = states[i].pose.orientation;
      if (island.inertia[i].rotates) {
        momenta_[i] = angular_momentum(island.inertia[i], states[i].pose.orientation,
                                       states[i].twist.angular);
      }
    }
    evaluate(island, t, states);
    primed_ = true;
  }

  void evaluate(const Island& island, Instant t, std::span<const BodyState> states) {
    ++evaluations_;
    island.wrenches(t, states, wrenches_);
  }

  void kick(const Island& island, double h, std::span<BodyState> states) {
    for (std::size_t i = 0; i < states.size(); ++i) {
      const BodyInertia& inertia = island.inertia[i];
      states[i].twist.linear += wrenches_[i].force / inertia.mass * h;
      if (inertia.rotates) {
        momenta_[i] += wrenches_[i].torque * h;
        states[i].twist.angular =
            angular_velocity(inertia, states[i].pose.orientation, momenta_[i]);
      }
    }
  }

  void drift(const Island& island, double h, std::span<BodyState> states) {
    for (std::size_t i = 0; i < states.size(); ++i) {
      const BodyInertia& inertia = island.inertia[i];
      BodyState& state = states[i];
      state.pose.position += state.twist.linear * h;
      if (inertia.rotates) {
        state.pose.orientation = split_top(inertia, momenta_[i], h, state.pose.orientation);
      }
    }
  }

  // State and rate as a node of the dense output.
  void record(const Island& island, std::span<const BodyState> states,
              const HermiteMotion::Node& node) const {
    ode_.pack(states, node.y);
    ode_.rate(island, states, wrenches_, node.rate);
  }

  StepperInfo info_;
  std::span<const double> weights_;
  IslandOde ode_;
  HermiteMotion dense_;
  std::vector<Wrench> wrenches_;  ///< at the current states
  std::vector<Quaternion> orientations_;
  std::vector<Vector3> momenta_;  ///< angular, world frame
  bool primed_ = false;
  bool constant_acceleration_ = false;
  std::int64_t evaluations_ = 0;
};

}  // namespace

std::unique_ptr<Stepper> make_free_top_splitting(const StepperOptions& /*options*/) {
  return std::make_unique<Splitting>(free_top_splitting_info, strang_steps);
}
std::unique_ptr<Stepper> make_forest_ruth(const StepperOptions& /*options*/) {
  return std::make_unique<Splitting>(forest_ruth_info, forest_ruth_steps);
}
std::unique_ptr<Stepper> make_suzuki4(const StepperOptions& /*options*/) {
  return std::make_unique<Splitting>(suzuki4_info, suzuki_steps);
}

}  // namespace kairos::integrators
