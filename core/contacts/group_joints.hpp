#pragma once

#include "core/force.hpp"
#include "core/joint_system.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace kairos {
inline namespace core {

/// Bodies of a contact group that joints hold together, or forces between them: all of an island.
struct GroupMechanism {
  std::vector<std::size_t> places;        ///< in the group, as the island orders them
  const JointSystem* joints = nullptr;    ///< not owned; null: there are none
  std::vector<const Force*> forces = {};  ///< of the island, but for those of its joints; not owned
};

/// What joints make of pushes in a contact group, at one instant: of what a push would give to the
/// bodies without them, that which they leave. Contacts then see bodies as if there were no joints,
/// which move each other.
class GroupJoints {
 public:
  /// `states`: by place in the group. Mechanisms without joints have no part in it.
  GroupJoints(std::span<const GroupMechanism> mechanisms, Instant t,
              std::span<const BodyState> states);

  /// Replaces changes of velocity, six numbers for each body of the group, by those that are left.
  void pass_on(Eigen::VectorXd& changes) const;
  /// The same of what a push along `asks` gives; nothing where joints block it.
  void pass_on(const Eigen::VectorXd& asks, Eigen::VectorXd& gives) const;
  /// What driven sides of joints do while these pass on changes of velocity, six numbers for each
  /// body as they would be without joints: J, by mechanism. Of accelerations: W.
  [[nodiscard]] Eigen::VectorXd driven_work(const Eigen::VectorXd& changes) const;
  /// Whether some are driven.
  [[nodiscard]] bool driven() const;
  /// Of a mechanism its first body's place in the group.
  [[nodiscard]] std::size_t first_of(std::size_t mechanism) const {
    return mechanisms_[mechanism].places.front();
  }

 private:
  struct Mechanism {
    std::vector<std::size_t> places;
    JointSystem::Passing passing;
  };
  std::vector<Mechanism> mechanisms_;
};

/// Of a group whose bodies these are by place; null: no joints.
[[nodiscard]] std::shared_ptr<const GroupJoints> group_joints(
    std::span<const GroupMechanism> mechanisms, Instant t, std::span<const BodyState> states);

/// Puts the states of mechanisms back onto their joints, positions or velocities; false where no
/// position fits.
[[nodiscard]] bool put_positions_onto_joints(std::span<const GroupMechanism> mechanisms, Instant t,
                                             std::span<BodyState> states);
/// Returns the work of driven sides in that, J.
double put_velocities_onto_joints(std::span<const GroupMechanism> mechanisms, Instant t,
                                  std::span<BodyState> states);

/// Adds the forces of mechanisms and of their joints to those that act on the bodies of a group.
/// `place`: of a body of the group among `states` and `wrenches`.
void add_mechanism_forces(const GroupMechanism& mechanism, std::span<const std::size_t> place,
                          bool joints_too, Instant t, std::span<const BodyState> states,
                          std::span<Wrench> wrenches);

}  // namespace core
}  // namespace kairos
