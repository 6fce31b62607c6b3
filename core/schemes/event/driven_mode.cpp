#include "core/schemes/event/driven_mode.hpp"

#include "core/power_nodes.hpp"
#include "core/schemes/event/mode_guards.hpp"
#include "core/schemes/shared/support.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Accelerations below this part of the largest are roundoff.
constexpr double roundoff = 1e-12;
/// Part of the window after which something that begins to slide has begun.
constexpr double begun = 1e-6;

/// sum |c_k . axis| s^k.
double most(const Polynomial<3>& p, const Vector3& axis, double s) {
  double sum = 0.0;
  for (int k = p.degree(); k >= 0; --k) {
    sum = sum * s + std::abs(axis.dot(Vector3(p[k])));
  }
  return sum;
}

/// factor p . axis + constant, as the x of a polynomial.
Polynomial<3> along(const Polynomial<3>& p, const Vector3& axis, double factor, double constant) {
  Polynomial<3> f;
  f.resize(p.degree());
  for (int k = 0; k <= p.degree(); ++k) {
    f[k] = Vector3(factor * axis.dot(Vector3(p[k])), 0.0, 0.0);
  }
  f[0].x() += constant;
  return f;
}

/// Of friction against `slides`, times what presses, and of the plane, until the sliding ends.
Polynomial<3> work(const DrivenMode& mode, const Motion& under, const Polynomial<3>& presses,
                   const Vector3& slides, const Vector3& n) {
  const double duration = std::min(mode.until, mode.motion.duration);
  Eigen::VectorXd rubs(PowerNodes::count);
  Eigen::VectorXd carries(PowerNodes::count);
  for (int k = 0; k < PowerNodes::count; ++k) {
    const double s = PowerNodes::at(k) * duration;
    const double pressed = presses(s).x();
    const Vector3 v = under.twist(s).linear;
    rubs[k] = -pressed * slides.dot(mode.motion.twist(s).linear - v);
    carries[k] = pressed * (n - slides).dot(v);
  }
  Polynomial<3> both = PowerNodes::work(rubs, duration);
  const Polynomial<3> carried = PowerNodes::work(carries, duration);
  for (int k = 0; k <= carried.degree(); ++k) {
    both[k].z() = carried[k].x();
  }
  return both;
}

}  // namespace

DrivenMode driven_mode(const DrivenTouch& touch, const Motion& under) {
  DrivenMode mode;
  const double window = std::min(touch.duration, under.duration);
  const Vector3& n = touch.normal;
  const Polynomial<3> A = under.velocity.differentiated();
  const double weight = -touch.load.dot(n);
  const Vector3 pull = touch.load + n * weight;
  const Vector3 v = under.twist(0.0).linear;
  Vector3 slip = touch.body.twist.linear - v;
  slip -= n * n.dot(slip);
  double largest = touch.load.norm();
  for (int axis = 0; axis < 3; ++axis) {
    largest = std::max(largest, most(A, Vector3::Unit(axis), window));
  }
  if (under.rotation != RotationKind::fixed) {
    mode.refusal = "the body that carries it turns";
    return mode;
  }
  const Polynomial<3> presses = along(A, n, 1.0, weight);
  const bool constant = most(A, n, window) <= roundoff * largest;
  mode.pressing = constant ? weight : presses[0].x();
  const double lift_off = first_positive(along(A, n, -1.0, -weight), window);
  if (constant ? !(weight > 0.0) : !(lift_off > begun * window)) {
    mode.refusal = constant ? "nothing presses" : "";
    mode.parts = !constant;
    return mode;
  }
  if (touch.friction == 0.0) {
    mode.velocity = v + slip;
    mode.motion = ride(Motion::ballistic(under.start, window, touch.body.pose,
                                         {mode.velocity, Vector3::Zero()}, pull),
                       under, n);
    mode.until = lift_off;
    return mode;
  }
  Vector3 line = pull;
  for (int k = 0; k <= A.degree(); ++k) {
    line = Vector3(A[k]).norm() > line.norm() ? Vector3(A[k]) : line;
  }
  if (slip.norm() > touch.still) {
    line = slip;
  }
  line -= n * n.dot(line);
  const double length = line.norm();
  const Vector3 x = length > 0.0 ? Vector3(line / length) : n.unitOrthogonal();
  const Vector3 y = n.cross(x);
  if (most(A, y, window) > roundoff * largest || std::abs(y.dot(pull)) > roundoff * largest) {
    mode.refusal = "a body slides on a curved path";
    return mode;
  }
  const double most_friction = touch.friction * weight;
  Vector3 d = x;  // where it slides
  if (slip.norm() <= touch.still) {
    // Acceleration that friction must give along x: A - pull.
    const double offset = -x.dot(pull);
    double ends = infinity;
    bool forwards = true;
    for (const double sign : {1.0, -1.0}) {
      double s = infinity;
      if (!std::isinf(touch.friction)) {
        const Vector3 axis = constant ? Vector3(sign * x) : Vector3(sign * x - touch.friction * n);
        s = first_positive(along(A, axis, 1.0, sign * offset - most_friction), window);
      }
      if (s < ends) {
        ends = s;
        forwards = sign < 0.0;
      }
    }
    if (ends > at_once * window) {
      mode.slip = Slip::sticks;
      const double needed = most(A, x, window) + std::abs(offset);
      const double share = constant ? needed / weight : needed > 0.0 ? infinity : 0.0;
      mode.leans = std::min(touch.friction, share) * x;
      mode.motion = under;
      mode.motion.duration = window;
      mode.motion.position[0] = touch.body.pose.position;
      const Quaternion& q = touch.body.pose.orientation;
      mode.motion.quaternion = Polynomial<4>(Vector4(q.w(), q.x(), q.y(), q.z()));
      mode.velocity = v;
      mode.until = std::min(ends, lift_off);
      return mode;
    }
    d = forwards ? x : Vector3(-x);  // it lags behind
    mode.slip = Slip::begins;
    slip.setZero();
  } else {
    mode.slip = Slip::slides;
  }
  if (std::isinf(most_friction)) {
    mode.refusal = "a body with infinite friction slides";
    return mode;
  }
  mode.pushes = mode.pressing * (n - touch.friction * d);
  mode.leans = -touch.friction * d;
  mode.velocity = v + slip;
  Motion own =
      Motion::ballistic(under.start, window, touch.body.pose, {mode.velocity, Vector3::Zero()},
                        pull - touch.friction * mode.pressing * d);
  for (int k = 1; !constant && k <= presses.degree(); ++k) {
    const Vector3 a = -touch.friction * presses[k].x() * d;
    own.velocity.resize(std::max(own.velocity.degree(), k + 1));
    own.position.resize(std::max(own.position.degree(), k + 2));
    own.velocity[k + 1] = a / (k + 1.0);
    own.position[k + 2] = a / ((k + 1.0) * (k + 2.0));
  }
  mode.motion = ride(own, under, n);
  // -(v - V) . d > 0: it has stopped.
  Polynomial<3> back = along(under.velocity, d, 1.0, 0.0);
  back.resize(std::max(back.degree(), own.velocity.degree()));
  for (int k = 0; k <= own.velocity.degree(); ++k) {
    back[k].x() -= d.dot(Vector3(own.velocity[k]));
  }
  const double moment = mode.slip == Slip::begins ? begun * window : 0.0;
  mode.until = moment + first_positive(back.shifted(moment), window - moment);
  if (!constant) {
    mode.until = std::min(mode.until, lift_off);
    mode.worked = work(mode, under, presses, touch.friction * d, n);
  }
  return mode;
}

}  // namespace core
}  // namespace kairos
