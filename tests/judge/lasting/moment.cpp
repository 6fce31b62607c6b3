#include "tests/judge/lasting/moment.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::judge {
namespace {

/// Value and derivative at once.
template <int Dim>
struct Jet {
  using Value = Eigen::Matrix<Real, Dim, 1>;
  Value value = Value::Zero();
  Value rate = Value::Zero();
};

template <int Dim>
Jet<Dim> jet(const Polynomial<Dim>& p, Real s) {
  Jet<Dim> out;
  for (int k = p.degree(); k >= 0; --k) {
    out.rate = (out.rate * s + out.value).eval();
    out.value = (out.value * s + p[k].template cast<Real>()).eval();
  }
  return out;
}

using Quad = Eigen::Matrix<Real, 4, 1>;  // w, x, y, z

/// Hamilton's product.
Quad product(const Quad& p, const Quad& q) {
  return {p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
          p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
          p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
          p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]};
}

/// Of a quaternion of any length.
Matrix rotation(const Quad& q) {
  const Real w = q[0];
  const Real x = q[1];
  const Real y = q[2];
  const Real z = q[3];
  const Real two = 2 / q.squaredNorm();
  Matrix r;
  r << 1 - two * (y * y + z * z), two * (x * y - w * z), two * (x * z + w * y),  //
      two * (x * y + w * z), 1 - two * (x * x + z * z), two * (y * z - w * x),   //
      two * (x * z - w * y), two * (y * z + w * x), 1 - two * (x * x + y * y);
  return r;
}

/// Angular velocity, world frame, of q/|q|: twice the vector part of q' q^-1.
Vector spin_of(const Quad& q, const Quad& rate) {
  const Quad inverse(q[0], -q[1], -q[2], -q[3]);
  return 2 * product(rate, inverse).tail<3>() / q.squaredNorm();
}

}  // namespace

Real seconds(Instant a, Instant b) {
  return (Real(b.seconds) - Real(a.seconds)) + (Real(b.correction) - Real(a.correction));
}

Moment moment_of(const Motion& motion, Real s) {
  const auto position = jet(motion.position, s);
  const auto velocity = jet(motion.velocity, s);
  const auto spin = jet(motion.angular_velocity, s);
  Moment now;
  now.position = position.value;
  now.velocity = velocity.value;
  now.acceleration = velocity.rate;
  now.strays = position.rate - velocity.value;
  now.spin = spin.value;
  now.spinning_up = spin.rate;
  now.turns_astray.setZero();
  const auto q = jet(motion.quaternion, s);
  now.turned = rotation(q.value);
  switch (motion.rotation) {
    case RotationKind::fixed:
      now.spin.setZero();
      now.spinning_up.setZero();
      break;
    case RotationKind::constant_rate: {
      const Vector w = real(motion.rotation_rate);
      const Real rate = w.norm();
      if (rate > 0) {
        const Real half = rate * s / 2;
        Quad turn;
        turn << std::cos(half), std::sin(half) / rate * w;
        now.turned = rotation(product(turn, q.value));
      }
      now.turns_astray = w - now.spin;
      break;
    }
    case RotationKind::polynomial:
      now.turns_astray = spin_of(q.value, q.rate) - now.spin;
      break;
  }
  return now;
}

const Motion& motion_at(const Trajectory& run, BodyIndex body, Instant t) {
  const auto& motions = run.motions(body);
  const auto later =
      std::upper_bound(motions.begin(), motions.end(), t,
                       [](Instant time, const Motion& motion) { return time < motion.start; });
  return later == motions.begin() ? *later : *std::prev(later);
}

Moment moment_at(const Trajectory& run, BodyIndex body, Instant t) {
  const Motion& motion = motion_at(run, body, t);
  const Real s = std::max<Real>(seconds(motion.start, t), 0);
  Moment now = moment_of(motion, s);
  now.beyond = std::max<Real>(s - Real(motion.duration), 0);
  return now;
}

}  // namespace kairos::judge
