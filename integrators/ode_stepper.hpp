#pragma once

#include "core/stepper.hpp"
#include "integrators/constant_force.hpp"
#include "integrators/hermite_motion.hpp"

#include <vector>

namespace kairos::integrators {

/// What the steppers on an `IslandOde` with Hermite dense output have in common: the system, the
/// nodes of the last step, and the rate y' at its end, which is the first of the next step.
class OdeStepper : public Stepper {
 public:
  [[nodiscard]] std::string refuses(const Island& /*island*/) const override { return {}; }
  void start(const Island& island, Instant t, std::span<const BodyState> states) override;
  void restart(const Island& island, Instant t, std::span<const BodyState> states) override;
  void dense_output(std::span<Motion> motions) const override;
  bool replay(const Island& island, double s, std::span<const BodyState> before,
              std::span<ReplayedStep> after) const override {
    // What a method of variable order does to a parabola depends on its history.
    return !info().variable_order && replay_parabola(island, s, before, after);
  }
  [[nodiscard]] std::int64_t evaluations() const override { return ode_.evaluations(); }
  bool persist(Archive& archive) override {
    archive(ode_, dense_, orientations_, end_rate_, has_end_rate_, constant_acceleration_);
    return true;
  }

 protected:
  /// `nodes`: of the dense output, ends included.
  explicit OdeStepper(std::size_t nodes) : nodes_(nodes) {}

  /// The first node of a step: y from the states, y' evaluated unless the last step ended here.
  HermiteMotion::Node begin_step(const Island& island, Instant t,
                                 std::span<const BodyState> states);
  /// Completes the node at local time s, whose y is written: normalises it, evaluates y'.
  void finish_node(double s, const HermiteMotion::Node& node);
  /// Ends the step at the last node: keeps its rate, writes the states.
  void end_step(std::span<BodyState> states);

  /// Of the last step.
  [[nodiscard]] bool constant_acceleration() const { return constant_acceleration_; }

  IslandOde ode_;
  HermiteMotion dense_;

 private:
  std::size_t nodes_;
  std::vector<Quaternion> orientations_;  ///< of the bodies that do not rotate
  std::vector<double> end_rate_;
  bool has_end_rate_ = false;
  bool constant_acceleration_ = false;
};

}  // namespace kairos::integrators
