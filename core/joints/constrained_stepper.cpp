#include "core/joints/constrained_stepper.hpp"

#include "core/archive.hpp"
#include "core/bent_motion.hpp"
#include "core/joint_system.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace kairos {
inline namespace core {
namespace {

/// A stand-in for joint forces: they depend on velocities, and have no potential.
class VelocityForce final : public Force {
 public:
  void add(Instant, std::span<const BodyState>, std::span<Wrench>) const override {}
  [[nodiscard]] double potential(Instant, std::span<const BodyState>) const override { return 0.0; }
  [[nodiscard]] bool conservative() const override { return false; }
  [[nodiscard]] std::string description() const override { return "the force of a joint"; }
};

class ConstrainedStepper final : public Stepper {
 public:
  ConstrainedStepper(std::unique_ptr<Stepper> inner, double most_drift)
      : inner_(std::move(inner)), most_drift_(most_drift) {}

  [[nodiscard]] StepperInfo info() const override { return inner_->info(); }
  [[nodiscard]] std::string refuses(const Island& island) const override {
    static const VelocityForce velocity_force;
    Island probe = island;
    probe.forces.push_back(&velocity_force);
    return inner_->refuses(probe);
  }
  [[nodiscard]] std::int64_t evaluations() const override { return inner_->evaluations(); }

  void start(const Island& island, Instant t, std::span<const BodyState> states) override {
    begin_at(states);
    inner_->start(island, t, states);
  }
  void restart(const Island& island, Instant t, std::span<const BodyState> states) override {
    begin_at(states);
    inner_->restart(island, t, states);
  }

  StepResult step(const Island& island, Instant t, double h, std::span<BodyState> states) override {
    if (!asked_) {
      asked_ = true;
      stuck_ = is_stuck(island, t, states);
    }
    if (stuck_) {
      StepResult result;
      result.ok = false;
      result.reason =
          "the joints are at a dead centre: what is stretched straight between two points has no "
          "position near by in which it moves as it is pushed (give it slack)";
      return result;
    }
    if (anew_) {
      own_.assign(states.begin(), states.end());
      inner_->restart(island, t, own_);
      anew_ = false;
    }
    before_.assign(states.begin(), states.end());
    StepResult result = inner_->step(island, t, h, own_);
    if (!result.ok) {
      return result;
    }
    h_ = result.advanced;
    std::copy(own_.begin(), own_.end(), states.begin());
    const JointSystem& joints = *island.joints;
    const Instant end = t + h_;
    const double drift = joints.residual(end, states);
    if (drift > joints.size()) {
      result.ok = false;
      result.reason =
          "a step ends farther off the joints than they are long; a shorter step may help";
      return result;
    }
    const JointProjection positions = joints.project_positions(end, states, island.constant_force);
    if (!positions.converged) {
      result.ok = false;
      result.reason =
          "the joints fit no position within reach: what is stretched straight between two points "
          "has none that moves (give it slack), and a shorter step may help elsewhere";
      return result;
    }
    const JointProjection velocities = joints.project_velocities(end, states);
    result.projection = {velocities.velocity, velocities.driven, positions.position, true};
    after_.assign(states.begin(), states.end());
    anew_ = !info().variable_order || drift > most_drift_ * joints.size();
    return result;
  }

  void dense_output(std::span<Motion> motions) const override {
    inner_->dense_output(motions);
    for (std::size_t k = 0; k < motions.size(); ++k) {
      bend_to(motions[k], h_, before_[k], after_[k]);
    }
  }

  bool persist(Archive& archive) override {
    archive(own_, before_, after_, h_, anew_);
    return inner_->persist(archive);
  }

 private:
  void begin_at(std::span<const BodyState> states) {
    own_.assign(states.begin(), states.end());
    before_ = after_ = own_;
    anew_ = false;
  }

  static bool is_stuck(const Island& island, Instant t, std::span<const BodyState> states) {
    Island applied = island;
    applied.forces.pop_back();  // that of the joints
    std::vector<Wrench> wrenches(states.size());
    applied.wrenches(t, states, wrenches);
    return island.joints->is_stuck(t, states, wrenches);
  }

  std::unique_ptr<Stepper> inner_;
  double most_drift_;              ///< of a multistep method's own states, relative to the size
  std::vector<BodyState> own_;     ///< of the stepper, not put back
  std::vector<BodyState> before_;  ///< of the last step, as they are told
  std::vector<BodyState> after_;
  double h_ = 0.0;
  bool anew_ = false;   ///< the stepper begins at what is told with the next step
  bool asked_ = false;  ///< whether the joints are stuck where the first step begins
  bool stuck_ = false;
};

}  // namespace

std::unique_ptr<Stepper> make_constrained(std::unique_ptr<Stepper> stepper, const Island& island,
                                          double most_drift) {
  if (island.joints == nullptr || stepper == nullptr || stepper->holds_joints()) {
    return stepper;
  }
  return std::make_unique<ConstrainedStepper>(std::move(stepper), most_drift);
}

}  // namespace core
}  // namespace kairos
