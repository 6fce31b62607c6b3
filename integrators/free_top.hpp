#pragma once

#include "core/archive.hpp"
#include "core/force.hpp"
#include "core/motion.hpp"

namespace kairos::integrators {

/// A rigid body that turns freely, exactly [vanZon2007]: its angular velocity by Jacobi's elliptic
/// functions, its angle about the angular momentum by an elliptic integral of the third kind.
/// Angular momentum and energy are those it started with, to roundoff, however late.
///
/// For tops that tumble: steady rotations (about a principal axis, or with equal moments) are not
/// for this class.
class FreeTop {
 public:
  FreeTop() = default;
  /// The state at time 0.
  FreeTop(const BodyInertia& inertia, const Quaternion& q_WB, const Vector3& w_W);

  /// False where doubles do not resolve the motion: within about 1e-12 of the separatrix, a body
  /// that turns about its middle axis but for roundoff, whose flips no one can foretell.
  [[nodiscard]] bool resolved() const { return resolved_; }

  struct Rotation {
    Quaternion orientation = Quaternion::Identity();
    Vector3 angular_velocity = Vector3::Zero();  ///< world frame, rad/s
  };
  [[nodiscard]] Rotation at(double time) const;

  /// Longest segment, s, over which `fit` is proven to stay within 1e-13 of the exact quaternion.
  [[nodiscard]] double segment() const;
  /// Bound of the distance between the polynomial of a `fit` over h and the exact unit quaternion,
  /// roundoff left out.
  [[nodiscard]] double fit_error(double h) const;
  /// Writes quaternion and angular velocity over [time, time + h] into a motion.
  void fit(double time, double h, Motion& motion) const;

  void persist(Archive& archive) {
    archive(moments_, amplitudes_, body_to_sorted_, momentum_frame_, L_, frequency_, modulus_,
            quarter_, characteristic_, quarter_integral_, phase_, resolved_, fastest_, coupling_);
  }

 private:
  struct Phase {
    Vector3 w_S;
    double third_kind;  ///< integral of du / (1 + n sn^2 u) from 0
  };
  [[nodiscard]] Phase phase(double u) const;
  [[nodiscard]] Rotation at(double time, double third_kind_at_start) const;

  // In axes S: the body's, in Jacobi's order, made right-handed.
  Vector3 moments_ = Vector3::Ones();                   ///< kg m^2
  Vector3 amplitudes_ = Vector3::Zero();                ///< of cn, sn, dn, rad/s
  Quaternion body_to_sorted_ = Quaternion::Identity();  ///< q_SB
  Quaternion momentum_frame_ = Quaternion::Identity();  ///< its z axis along L, world frame
  double L_ = 0.0;                                      ///< angular momentum, kg m^2/s
  double frequency_ = 0.0;                              ///< of the elliptic functions, rad/s
  double modulus_ = 0.0;                                ///< k
  double quarter_ = 0.0;                                ///< K(k); 0 where it is infinite
  double characteristic_ = 0.0;                         ///< n of the integral of the third kind
  double quarter_integral_ = 0.0;                       ///< that integral over K
  double phase_ = 0.0;                                  ///< u at time 0
  bool resolved_ = false;
  double fastest_ = 0.0;   ///< bound of |w|, rad/s
  double coupling_ = 0.0;  ///< bound of |w'| / |w|^2 in body axes
};

}  // namespace kairos::integrators
