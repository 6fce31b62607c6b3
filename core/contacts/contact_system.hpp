#pragma once

#include "core/contacts/group_joints.hpp"
#include "core/force.hpp"

#include <Eigen/Core>

#include <memory>
#include <utility>
#include <vector>

namespace kairos {
inline namespace core {

/// A body of a contact group as forces see it, at one instant.
struct GroupBody {
  double inverse_mass = 0.0;                  ///< 1/kg; 0: nothing moves it
  Matrix3 inverse_inertia = Matrix3::Zero();  ///< world frame, 1/(kg m^2); 0: nothing turns it
  Vector3 position = Vector3::Zero();         ///< of its origin, m
};

[[nodiscard]] inline bool moves(const GroupBody& body) { return body.inverse_mass > 0.0; }

/// As the model knows it, at this pose; what is not free has inverses of 0.
[[nodiscard]] GroupBody group_body(const BodyInertia& inertia, const Pose& pose);

/// Where two bodies of a group press on each other along one direction: on b along it, on a against
/// it.
struct ContactRow {
  std::size_t a = 0;  ///< place in the group
  std::size_t b = 0;
  Vector3 direction = Vector3::Zero();  ///< unit, from a to b, world frame
  Vector3 arm_a = Vector3::Zero();      ///< from the origin of a to the point, m
  Vector3 arm_b = Vector3::Zero();
};

/// Bodies and the rows along which they press: J, M and what follows of them. Velocities,
/// accelerations and impulses alike are `Twist`s, one per body.
struct ContactSystem {
  std::vector<GroupBody> bodies;
  std::vector<ContactRow> rows;
  /// They pass on what the rows do; null: none.
  std::shared_ptr<const GroupJoints> joints{};

  void add(std::size_t a, std::size_t b, const Vector3& point, const Vector3& direction);
  /// J M^-1 J^T: what a unit impulse of a row does to the rates of all, 1/kg.
  [[nodiscard]] Eigen::MatrixXd coupling() const;
  /// J v, m/s.
  [[nodiscard]] double rate(const ContactRow& row, const std::vector<Twist>& v) const;
  [[nodiscard]] Eigen::VectorXd rates(const std::vector<Twist>& v) const;
  /// v += M^-1 J^T impulse.
  void push(const Eigen::VectorXd& impulses, std::vector<Twist>& v) const;
  /// What driven sides of joints do while these pass on such impulses, J.
  [[nodiscard]] double driven_work(const Eigen::VectorXd& impulses) const;
  /// What bodies do that nothing moves and that move at these velocities, while such impulses press
  /// on them, J.
  [[nodiscard]] double carrying_work(const Eigen::VectorXd& impulses,
                                     const std::vector<Twist>& v) const;
  /// Projects v onto J v = 0, or `wanted`, in the metric of the kinetic energy; twice, so that only
  /// the roundoff of a residual is left. Returns `driven_work` and `carrying_work` of that.
  double project(std::vector<Twist>& v, const Eigen::VectorXd* wanted = nullptr) const;
  /// Undoes a change of linear velocities (from `before` to `v`) for bodies that it moves along a
  /// row faster than before, unless the difference is a small part of their speed.
  void undo_where_faster(const std::vector<Twist>& before, std::vector<Twist>& v) const;

 private:
  /// Of a row, six numbers for each body: J, and M^-1 J^T.
  [[nodiscard]] std::pair<Eigen::VectorXd, Eigen::VectorXd> unpassed(const ContactRow& row) const;
  /// The same among joints, M^-1 J^T as these pass it on.
  [[nodiscard]] std::pair<Eigen::VectorXd, Eigen::VectorXd> passed(const ContactRow& row) const;
  [[nodiscard]] Eigen::MatrixXd coupling_through_joints() const;
};

/// Two unit vectors along the surface of a contact with this normal, the first where `along`
/// points, or, where joints let nothing move along some direction of the surface, across that; n,
/// they: a right-handed frame.
[[nodiscard]] std::pair<Vector3, Vector3> contact_tangents(const ContactSystem& bodies,
                                                           std::size_t a, std::size_t b,
                                                           const Vector3& point, const Vector3& n,
                                                           const Vector3& along);

}  // namespace core
}  // namespace kairos
