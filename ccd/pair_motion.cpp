#include "ccd/pair_motion.hpp"

#include "ccd/core_of_shape.hpp"
#include "ccd/plane_normal.hpp"
#include "ccd/rotation_bounds.hpp"
#include "ccd/rounding/rotation_matrix.hpp"
#include "ccd/rounding/roundoff.hpp"
#include "ccd/sine_cosine.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

constexpr double u = unit_roundoff;

double local_start(const Motion& motion, const Window& window) {
  return window.start == motion.start ? 0.0 : window.start - motion.start;
}

struct RoundedBox {
  Vector3 half = Vector3::Zero();
  double radius = 0.0;
  bool oriented = false;
};

RoundedBox rounded_box(const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    return {Vector3::Zero(), sphere->radius, false};
  }
  if (const auto* box = std::get_if<Box>(&shape)) {
    return {box->half_extents, 0.0, true};
  }
  return {Vector3::Zero(), 0.0, true};
}

bool is_identity(const Vector4& q) { return q[1] == 0.0 && q[2] == 0.0 && q[3] == 0.0; }

/// Rotation of a body that turns at a constant rate for a short angle: as Motion::orientation, with
/// |w| known. The angle is off by 3.5 u of itself, sine and cosine by 3 u, the product by 4 u.
Quaternion turned_by(const Motion& motion, double rate, double s) {
  const double half = 0.5 * rate * s;
  if (!(std::abs(half) < 1.5)) {
    return motion.orientation(s);  // keeps the precision of many turns
  }
  double sine = 0.0;
  double cosine = 0.0;
  sine_cosine(half, sine, cosine);
  const Vector3& w = motion.rotation_rate;
  const Vector4& c = motion.quaternion[0];
  const double k = sine / rate;
  return Quaternion(cosine, k * w.x(), k * w.y(), k * w.z()) * Quaternion(c[0], c[1], c[2], c[3]);
}

/// Bound of the rounding of the rotation matrix of a quaternion polynomial at s: Horner's rule and
/// a rounded s move Q by 3 n u sum |c_k| |s|^k; of that over |Q| an entry moves four times as much.
double polynomial_rotation_error(const Motion& motion, double s) {
  const Polynomial<4>& q = motion.quaternion;
  double size = 0.0;
  for (int k = q.degree(); k >= 0; --k) {
    size = size * std::abs(s) + q[k].norm();
  }
  return (16.0 + 12.0 * q.degree() * (size / q(s).norm())) * u;
}

/// The rate of turn that the quaternion polynomial itself has (the motion's own polynomial for the
/// angular velocity may be a better approximation of something else): w = 2 Im(Q' Q*) / |Q|^2.
Vector3 rate_of_turn(const Motion& motion, double s) {
  const Vector4 q = motion.quaternion(s);
  const Vector4 r = motion.quaternion.derivative(s);
  const Vector3 q_vector(q[1], q[2], q[3]);
  const Vector3 r_vector(r[1], r[2], r[3]);
  return (2.0 / q.squaredNorm()) * (q[0] * r_vector - r[0] * q_vector - r_vector.cross(q_vector));
}

void orient(const Motion& motion, double rate, double s, bool turns, Matrix3& R, Vector3& w) {
  if (turns && motion.rotation == RotationKind::constant_rate && rate > 0.0) {
    R = rotation_matrix(turned_by(motion, rate, s));
    w = motion.rotation_rate;
    return;
  }
  R = rotation_matrix(motion.orientation(s));
  if (!turns) {
    w.setZero();
  } else {
    w = motion.rotation == RotationKind::polynomial ? rate_of_turn(motion, s)
                                                    : motion.rotation_rate;
  }
}

/// Upper bound of |p - p(s0)| on [s0, s1] by Bernstein coefficients.
double bound_from_start(const Polynomial<3>& p, double s0, double s1) {
  std::array<Polynomial<3>::Value, Polynomial<3>::max_degree + 1> b;
  bernstein(p, s0, s1, b);
  double largest = 0.0;
  double size = 0.0;
  const double reach = std::abs(s0) + 2.0 * (s1 - s0);
  for (int k = p.degree(); k >= 0; --k) {
    const auto& value = b[static_cast<std::size_t>(k)];
    largest = std::max(largest, (value - b[0]).norm());
    size = size * reach + p[k].norm();
  }
  return largest * (1.0 + 8.0 * u) + 24.0 * (p.degree() + 1) * u * size;
}

}  // namespace

PairMotion::PairMotion(const Motion& a, const Motion& b, const Window& window)
    : motion_a_(&a),
      motion_b_(&b),
      s_a_(local_start(a, window)),
      s_b_(local_start(b, window)),
      duration_(window.duration),
      error_reach_(a.error_radius + b.error_radius) {}

PairMotion::PairMotion(const MovingCore& a, const MovingCore& b, const Window& window)
    : PairMotion(a.motion, b.motion, window) {
  set_cores(a.core, &b.core);
  finish(Positions::whole);
}

PairMotion::PairMotion(const MovingCore& a, const MovingShape& b, const Window& window,
                       Positions positions)
    : PairMotion(a.motion, b.motion, window) {
  set_plane(std::get<HalfSpace>(b.shape));
  set_cores(a.core, nullptr);
  finish(positions);
}

PairMotion::PairMotion(const MovingShape& a, const MovingShape& b, const Window& window,
                       Positions positions)
    : PairMotion(a.motion, b.motion, window) {
  const RoundedBox box_a = rounded_box(a.shape);
  const RoundedBox box_b = rounded_box(b.shape);
  half_a_ = box_a.half;
  half_b_ = box_b.half;
  radius_a_ = half_a_.norm() * (1.0 + 4.0 * u);
  radius_b_ = half_b_.norm() * (1.0 + 4.0 * u);
  reach_ = (box_a.radius + box_b.radius) + error_reach_;
  extent_a_ = half_a_.sum();
  extent_b_ = half_b_.sum();
  if (const auto* half_space = std::get_if<HalfSpace>(&b.shape)) {
    set_plane(*half_space);
  }
  oriented_a_ = box_a.oriented;
  oriented_b_ = box_b.oriented;
  if (is_convex_pair(a.shape, b.shape)) {
    const ConvexCore core_a = core_around(a.shape);
    if (plane_b_) {
      set_cores(core_a, nullptr);
    } else {
      const ConvexCore core_b = core_around(b.shape);
      set_cores(core_a, &core_b);
    }
  }
  finish(positions);
}

void PairMotion::set_plane(const HalfSpace& half_space) {
  plane_b_ = true;
  oriented_b_ = true;
  normal_b_ = half_space.normal_B;
  // Unit to the roundings of who gave it; the product below is rounded too.
  rotation_error_ += (normal_b_.array() != 0.0).count() == 1 ? 0.0 : 16.0 * u;
}

void PairMotion::finish(Positions positions) {
  turns_a_ = oriented_a_ && motion_a_->rotation != RotationKind::fixed;
  turns_b_ = oriented_b_ && motion_b_->rotation != RotationKind::fixed;

  // A normal that is an axis of its body rounds nothing where that is not turned.
  const bool along_axis = (normal_b_.array() != 0.0).count() == 1;
  const bool tilted = !(along_axis && is_identity(motion_b_->quaternion[0]));
  if (plane_b_ && !turns_b_ && tilted && positions == Positions::heights) {
    subtract_heights();
  } else {
    subtract_positions();
  }
  if (d_.degree() > 2) {
    simple_ = false;
    curvature_ = d_.differentiated().differentiated();
    for (int k = 0; k <= curvature_.degree(); ++k) {
      curvature_[k] *= 0.5;
    }
  }
  add_rotation_errors();
}

/// A rotated point of a core is off by the error of the rotation's entries times the sum of the
/// magnitudes of its coordinates, in each component: along a unit direction by sqrt(3) times that.
void PairMotion::set_cores(const ConvexCore& a, const ConvexCore* b) {
  has_cores_ = true;
  core_a_ = a;
  oriented_a_ = core_a_.kind() != ConvexCore::Kind::point;
  half_a_.setZero();
  half_b_.setZero();
  radius_a_ = core_a_.radius();
  extent_a_ = 1.75 * core_a_.extent();
  reach_ = core_a_.rounding();
  if (b != nullptr) {
    core_b_ = *b;
    oriented_b_ = core_b_.kind() != ConvexCore::Kind::point;
    radius_b_ = core_b_.radius();
    extent_b_ = 1.75 * core_b_.extent();
    reach_ += core_b_.rounding();
  }
  reach_ += error_reach_;
}

void PairMotion::take_parts(const ConvexCore& a, const ConvexCore& b) {
  core_a_ = a;
  core_b_ = b;
  radius_a_ = a.radius();
  radius_b_ = b.radius();
  reach_ = a.rounding() + b.rounding() + error_reach_;
}

namespace {

/// Bound of the rounding of each coefficient of a polynomial that is seen from s on.
template <typename AddError>
Polynomial<3> seen_from(const Polynomial<3>& p, double s, const AddError& add_error) {
  if (s == 0.0 || p.degree() == 0) {
    return p;
  }
  Polynomial<3> magnitudes = p;
  for (int k = 0; k <= p.degree(); ++k) {
    magnitudes[k].setConstant(p[k].lpNorm<Eigen::Infinity>());
  }
  const Polynomial<3> shifted = magnitudes.shifted(std::abs(s));
  for (int k = 0; k <= p.degree(); ++k) {
    add_error(k, 4.0 * (p.degree() + 1) * u * shifted[k][0]);
  }
  return p.shifted(s);
}

}  // namespace

/// d = p_b - p_a in window time; of its rounding, that of the shifts grows as the motions do from
/// their own starts, that of the difference only with d itself: far from the origin two bodies
/// that move together lose nothing.
void PairMotion::subtract_positions() {
  const auto add = [this](int k, double error) {
    position_error_[static_cast<std::size_t>(k)] += error;
  };
  d_ = seen_from(motion_b_->position, s_b_, add);
  const Polynomial<3> p_a = seen_from(motion_a_->position, s_a_, add);
  d_.resize(std::max(d_.degree(), p_a.degree()));
  for (int k = 0; k <= p_a.degree(); ++k) {
    d_[k] -= p_a[k];
  }
  for (int k = 0; k <= d_.degree(); ++k) {
    add(k, (4.0 * k + 8.0) * u * d_[k].lpNorm<Eigen::Infinity>());
  }
}

/// Against a half-space that does not turn only the height counts: d = n (n . (p_b - p_a)), with n
/// in twice the precision, so that the way along the plane adds no rounding (eq. 12).
void PairMotion::subtract_heights() {
  const PlaneNormal n(normal_b_, motion_b_->quaternion[0]);
  const auto add = [this](int k, double error) {
    position_error_[static_cast<std::size_t>(k)] += error;
  };
  const Vector3 zero = Vector3::Zero();
  // What moves, less its constant part: the difference of those is exact.
  const auto heights = [&](const Motion& motion, double s) {
    Polynomial<3> h;
    h.resize(motion.position.degree());
    for (int k = 1; k <= motion.position.degree(); ++k) {
      const double height = n.height(motion.position[k], zero);
      h[k] = n.rounded() * height;
      add(k, PlaneNormal::error(height, motion.position[k].lpNorm<1>()));
    }
    return seen_from(h, s, add);
  };
  d_ = heights(*motion_b_, s_b_);
  const Polynomial<3> a = heights(*motion_a_, s_a_);
  d_.resize(std::max(d_.degree(), a.degree()));
  for (int k = 0; k <= a.degree(); ++k) {
    d_[k] -= a[k];
  }
  const double apart = n.height(motion_b_->position[0], motion_a_->position[0]);
  d_[0] += n.rounded() * apart;
  add(0, PlaneNormal::error(
             apart, motion_b_->position[0].lpNorm<1>() + motion_a_->position[0].lpNorm<1>()));
  for (int k = 0; k <= d_.degree(); ++k) {
    add(k, (4.0 * k + 8.0) * u * d_[k].lpNorm<Eigen::Infinity>());
  }
}

void PairMotion::add_rotation_errors() {
  for (const bool second : {false, true}) {
    const Motion& motion = second ? *motion_b_ : *motion_a_;
    const double s = second ? s_b_ : s_a_;
    if (!(second ? oriented_b_ : oriented_a_)) {
      continue;
    }
    if (!(second ? turns_b_ : turns_a_)) {
      rotation_error_ += is_identity(motion.quaternion[0]) ? 0.0 : 8.0 * u;
    } else if (motion.rotation == RotationKind::constant_rate) {
      const double rate = motion.rotation_rate.norm();
      rotation_error_ += 40.0 * u;
      (second ? rate_b_ : rate_a_) = rate;
      double& angle = second ? angle_error_b_ : angle_error_a_;
      double& growth = second ? angle_error_rate_b_ : angle_error_rate_a_;
      // The angle is a sum of two doubles, off by some u^2 of itself.
      angle += 32.0 * u * u * rate * std::abs(s);
      growth += 32.0 * u * u * rate;
      if (s != 0.0) {  // s + t is rounded
        angle += 2.0 * u * rate * std::abs(s);
        growth += 2.0 * u * rate;
      }
    } else {
      simple_ = false;
      constant_rates_ = false;
    }
  }
}

void PairMotion::evaluate_translation(double t, Kinematics& k) const {
  const int degree = d_.degree();
  k.t = t;
  Vector3 d = d_[degree];
  Vector3 v = Vector3::Zero();
  Vector3 c = Vector3::Zero();
  double error = position_error_[static_cast<std::size_t>(degree)];
  double error_rate = error * degree;
  double error_second = 0.5 * error_rate * (degree - 1);
  for (int i = degree - 1; i >= 0; --i) {
    c = c * t + v;
    v = v * t + d;
    d = d * t + d_[i];
    error = error * t + position_error_[static_cast<std::size_t>(i)];
    if (i > 0) {
      error_rate = error_rate * t + position_error_[static_cast<std::size_t>(i)] * i;
    }
    if (i > 1) {
      error_second =
          error_second * t + 0.5 * position_error_[static_cast<std::size_t>(i)] * i * (i - 1);
    }
  }
  k.d = d;
  k.v = v;
  k.c = c;
  // (eq. 11), without what rotations add.
  k.error = 2.0 * error + 16.0 * u * d.lpNorm<1>() + 4.0 * u * reach_;
  k.rate_error = 2.0 * error_rate + 32.0 * u * v.lpNorm<1>();
  k.second_error = 2.0 * error_second + 32.0 * u * c.lpNorm<1>();
  k.still_rate_error = k.rate_error;
  k.still_second_error = k.second_error;
}

void PairMotion::evaluate(double t, Kinematics& k) const {
  evaluate_translation(t, k);
  if (oriented_a_) {
    orient(*motion_a_, rate_a_, s_a_ + t, turns_a_, k.R_WA, k.w_a);
  } else {
    k.w_a.setZero();
    k.R_WA.setIdentity();
  }
  if (oriented_b_) {
    orient(*motion_b_, rate_b_, s_b_ + t, turns_b_, k.R_WB, k.w_b);
    if (plane_b_) {
      k.R_WB.col(1) = (k.R_WB * normal_b_).eval();
    }
  } else {
    k.w_b.setZero();
    k.R_WB.setIdentity();
  }
  const double distance = k.d.lpNorm<1>();
  const double extents = extent_a_ + extent_b_;
  double still = rotation_error_;
  const double angle_a = angle_error_a_ + angle_error_rate_a_ * t;
  const double angle_b = angle_error_b_ + angle_error_rate_b_ * t;
  if (!constant_rates_) {
    for (const bool second : {false, true}) {
      const Motion& motion = second ? *motion_b_ : *motion_a_;
      if ((second ? turns_b_ : turns_a_) && motion.rotation == RotationKind::polynomial) {
        still += polynomial_rotation_error(motion, (second ? s_b_ : s_a_) + t);
      }
    }
  }
  const double rotation = still + angle_a + angle_b;
  const double turning = k.w_a.lpNorm<1>() + k.w_b.lpNorm<1>();
  const double products = 2.0 * (rotation + 16.0 * u);
  // A body turned by a wrong angle has moved by that times its own extent, whatever direction
  // separates it from the other; a half-space has no extent (eq. 11).
  k.error += still * distance + (still + 16.0 * u) * extents + angle_a * extent_a_ +
             angle_b * (plane_b_ ? distance + extents : extent_b_);
  k.rate_error += 2.0 * rotation * k.v.lpNorm<1>() + products * turning * (distance + extents);
  k.second_error += 2.0 * rotation * k.c.lpNorm<1>() +
                    products * turning * (k.v.lpNorm<1>() + turning * (distance + extents));
}

TurnBounds PairMotion::bounds(double t, double horizon) const {
  TurnBounds turn;
  turn.until = std::min(t + horizon, duration_);
  const double s0_a = s_a_ + t;
  const double s1_a = s_a_ + turn.until;
  const double s0_b = s_b_ + t;
  const double s1_b = s_b_ + turn.until;
  if (turns_a_) {
    const RotationBounds a = rotation_bounds(*motion_a_, s0_a, s1_a);
    turn.w_a = a.speed;
    turn.alpha_a = a.acceleration;
  }
  if (turns_b_) {
    const RotationBounds b = rotation_bounds(*motion_b_, s0_b, s1_b);
    turn.w_b = b.speed;
    turn.alpha_b = b.acceleration;
  }
  turn.bend = bend(t, turn.until);
  return turn;
}

double PairMotion::bend(double t, double t1) const {
  return d_.degree() > 2 ? bound_from_start(curvature_, t, t1) : 0.0;
}

double PairMotion::speed_bound(const Kinematics& k, const TurnBounds& turn, double horizon) const {
  const double bent = 2.0 * (k.c.norm() + turn.bend);
  const double speed = k.v.norm() + (bent > 0.0 ? bent * horizon : 0.0);
  double lever = radius_b_;
  if (plane_b_ && turn.w_b > 0.0) {  // it carries all that is above it, however far
    lever = k.d.norm() + (speed > 0.0 ? speed * horizon : 0.0) + radius_a_;
  }
  return (speed + turn.w_a * radius_a_ + (lever > 0.0 ? turn.w_b * lever : 0.0)) * (1.0 + 16.0 * u);
}

double PairMotion::acceleration_bound(const Kinematics& k, double horizon) const {
  const TurnBounds turn = bounds(k.t, horizon);
  double lever = radius_b_;
  double coriolis = 0.0;
  if (plane_b_ && turn.w_b > 0.0) {
    lever = k.d.norm() + (horizon > 0.0 ? k.v.norm() * horizon : 0.0) + radius_a_;
    coriolis = 2.0 * turn.w_b * k.v.norm();
  }
  return 2.0 * (k.c.norm() + bend(k.t, duration_)) + coriolis +
         (turn.w_a * turn.w_a + turn.alpha_a) * radius_a_ +
         (turn.w_b * turn.w_b + turn.alpha_b) * lever;
}

double PairMotion::time_to_cover(double length, double speed, const Kinematics& k) const {
  const double half = 0.5 * acceleration_bound(k, 0.0);
  return 2.0 * length / (speed + std::sqrt(speed * speed + 4.0 * length * half));
}

Kinematics reversed(const Kinematics& k) {
  Kinematics back = k;
  back.v = -k.v;
  back.w_a = -k.w_a;
  back.w_b = -k.w_b;
  return back;
}

TurnBounds reversed(const TurnBounds& turn) {
  TurnBounds back = turn;
  back.bend *= 2.0;  // of d'' from what it is at the start, and that from what it is at the end
  return back;
}

}  // namespace kairos::ccd
