#pragma once

#include "core/pose.hpp"

namespace kairos {
inline namespace core {

/// What one contact does to two bodies while it is pressed together and springs back.
struct RouthImpact {
  Vector3 impulse = Vector3::Zero();   ///< N s
  Vector3 velocity = Vector3::Zero();  ///< relative, afterwards, m/s
  double normal_work = 0.0;            ///< of the normal impulse along its way, J, <= 0
  double friction_work = 0.0;          ///< of the tangential one, J, <= 0
  bool jammed = false;  ///< sliding pressed the bodies together, whatever the normal impulse did
                        ///< (Painleve's case in an impact); it ended when the sliding did
  bool solved = false;  ///< false: no end was found
};

/// An impact with Coulomb's friction as a motion in the normal impulse [Routh1905, Darboux1880,
/// Keller1986]: while it slides along d, du/dp = W (1, -mu d); where it stops it sticks if friction
/// can hold it, and slides on otherwise, back or aside. It ends where the normal impulse has given
/// back e^2 of the work that it took until the approach ended: Stronge's energetic restitution
/// [Stronge1990], so that the normal work is (1 - e^2) of that <= 0 and friction takes energy.
/// Without friction this is Newton's restitution.
///
/// `W`: what an impulse does to the relative velocity, symmetric, positive definite, 1/kg; but rows
/// and columns of tangents may be 0, along which joints let nothing move, and joints may leave it
/// singular: what friction then holds against any pressing stands still;
/// `u`: relative velocity before, u_0 < 0, a difference of `speeds`, m/s. Components: normal, then
/// two tangents. `mu` >= 0, may be infinite. Exact (piecewise linear) where sliding keeps its
/// direction, as in a plane and of spheres; otherwise by Taylor series [Jorba2005], to roundoff.
[[nodiscard]] RouthImpact routh_impact(const Matrix3& W, const Vector3& u, double mu, double e,
                                       double speeds = 0.0);

/// Whether sliding along d (unit, tangents) presses the bodies together the more the more they
/// press: W_nn - mu W_nt.d <= 0 [Painleve1895].
[[nodiscard]] bool painleve(const Matrix3& W, double mu, const Eigen::Vector2d& d);

}  // namespace core
}  // namespace kairos
