#pragma once

#include "core/contacts/flat_modes.hpp"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace kairos {
inline namespace core {

/// A patch whose points are at rest along the normal.
struct FrictionTouch {
  std::size_t patch = 0;
  std::size_t a = 0;
  std::size_t b = 0;
  Vector3 n, t1, t2;  ///< t1: where loads pull
  double mu = 0.0;
  Vector3 slip;  ///< of b along a, m/s
};

/// What a touch is proposed to do.
struct FrictionChoice {
  enum class Does : char { opens, sticks, slides, begins };
  Does does = Does::sticks;
  /// Of b along a, unit, where it slides or begins to; where it sticks, the one in which it may be
  /// at the edge of its cone, or zero.
  Vector3 direction = Vector3::Zero();
};

/// Verifies proposals of `friction_mode`: are there accelerations that the touches allow, and
/// forces inside their cones that cause them? Bodies have three degrees of freedom, spheres that
/// turn six; that no other body turns has to follow from the forces.
class FrictionForces {
 public:
  struct Solution {
    std::vector<Twist> accelerations;
    std::vector<Vector3> force;  ///< by touch, on b
    std::vector<FrictionChoice> choices;
  };

  /// Accelerations below this part of the largest load are roundoff of the solve.
  static constexpr double solve_roundoff = 1e-11;

  explicit FrictionForces(const ContactGroup& group);

  void add(FrictionTouch touch, const Vector3& along);
  [[nodiscard]] const std::vector<FrictionTouch>& touches() const { return touches_; }
  /// Largest acceleration that a load gives, m/s^2.
  [[nodiscard]] double load() const { return load_; }
  /// Linear systems solved so far.
  [[nodiscard]] int solves() const { return solves_; }
  /// Of b against a at the touch, of velocities or of accelerations.
  [[nodiscard]] Vector3 relative(const FrictionTouch& t, const std::vector<Twist>& v) const;

  /// Accelerations that the constraints allow, and forces inside the cones that bring them about.
  [[nodiscard]] std::optional<Solution> solve(const std::vector<FrictionChoice>& choices);
  /// Projects out velocities along the normals, and along the surface where it sticks, in the
  /// metric of the kinetic energy.
  void slow_down(const std::vector<FrictionChoice>& choices, std::vector<Twist>& velocities) const;

 private:
  /// Rows of what stays in touch and sticks, by unknown, over the square root of the mass.
  struct Constraints {
    Eigen::MatrixXd rows;
    Eigen::VectorXd rates;   ///< that the velocities have, belts included
    Eigen::VectorXd driven;  ///< accelerations of what is not free
  };
  /// Accelerations that they allow: start + free z.
  struct Allowed {
    Eigen::VectorXd start;
    Eigen::MatrixXd free;
  };
  /// A ray of a cone at one point, and what it does to the bodies.
  struct Push {
    std::size_t touch = 0;
    Vector3 direction;
    Eigen::VectorXd column;
  };

  [[nodiscard]] bool turns(std::size_t i) const;
  [[nodiscard]] bool can_turn(std::size_t i) const;
  [[nodiscard]] Vector3 arm(const FrictionTouch& t, std::size_t i, const Vector3& point) const;
  [[nodiscard]] Eigen::VectorXd row(const FrictionTouch& t, const Vector3& d) const;
  [[nodiscard]] Constraints constraints(const std::vector<FrictionChoice>& choices,
                                        const std::vector<Twist>& velocities) const;
  [[nodiscard]] Twist scaled(std::size_t i, const Eigen::VectorXd& z) const;
  [[nodiscard]] std::vector<Vector3> rays(const FrictionTouch& t, const FrictionChoice& c) const;
  [[nodiscard]] bool realign(const std::vector<FrictionChoice>& choices);
  [[nodiscard]] std::optional<Allowed> allowed(const std::vector<FrictionChoice>& choices) const;
  [[nodiscard]] std::vector<Push> pushes(const std::vector<FrictionChoice>& choices) const;
  [[nodiscard]] std::optional<Solution> solve_once(const std::vector<FrictionChoice>& choices);

  const ContactGroup& group_;
  double load_ = 0.0;
  double unit_ = 1.0;  ///< of inverse masses, a power of two near the greatest, 1/kg: roots of what
                       ///< remains are the same whatever unit masses are told in
  int solves_ = 0;
  Eigen::Index unknowns_ = 0;
  std::vector<Eigen::Index> first_;  ///< by body: of its unknowns
  Eigen::Index balances_ = 0;
  std::vector<Eigen::Index> balance_;  ///< by body: m/s^2 of it, and of its rim where it could turn
  std::vector<FrictionTouch> touches_;
  std::vector<Vector3> nearest_;  ///< forces of the last attempt, by touch
};

}  // namespace core
}  // namespace kairos
