#include "tests/judge/families.hpp"

#include <cmath>

namespace kairos::judge {
namespace {

/// Makes the motion of a body a polynomial of higher degree that agrees at `time`, as an
/// integrator's dense output is.
void bend(Random& random, Body& body, double time, double duration) {
  const double unit = duration;
  body.polynomial = true;
  Polynomial<3> extra;
  extra.resize(3 + static_cast<int>(random.below(5)));
  for (int k = 2; k <= extra.degree(); ++k) {
    extra[k] = random.direction() * random.uniform(0.0, 0.3) / std::pow(unit, k);
  }
  body.course = extra.shifted(-time);
  body.course[0] += body.position;
  body.course[1] += body.velocity;
  body.course[2] += 0.5 * body.acceleration;
  // q(time) turned on by a rotation vector that is a polynomial in time, to some degree.
  const Quaternion at = rotate(body.spin * time, body.orientation);
  Polynomial<4> turn;
  turn.resize(1 + static_cast<int>(random.below(5)));
  turn[0] = Vector4(at.w(), at.x(), at.y(), at.z());
  const Quaternion rate = Quaternion(0.0, body.spin.x(), body.spin.y(), body.spin.z()) * at;
  turn[1] = 0.5 * Vector4(rate.w(), rate.x(), rate.y(), rate.z());
  for (int k = 2; k <= turn.degree(); ++k) {
    const Vector3 v = random.direction() * random.uniform(0.0, 0.2) / (k * k * std::pow(unit, k));
    turn[k] = Vector4(random.uniform(-0.1, 0.1) / (k * k * std::pow(unit, k)), v.x(), v.y(), v.z());
  }
  body.turn = turn.shifted(-time);
}

Query curved(Random& random) {
  const double duration = random.log_uniform(1e-3, 1.0);
  Approach approach{.closing = random.uniform(-0.3, 1.0) / duration,
                    .sliding = random.uniform(0.0, 1.0) / duration};
  approach.spin_a = random.uniform(0.0, 0.5) / duration;
  approach.spin_b = random.uniform(0.0, 0.5) / duration;
  switch (random.below(4)) {
    case 0:
      approach.closing = 0.0;
      approach.gap = random.log_uniform(1e-16, 1e-4) * (random.below(2) == 0 ? 1.0 : -1.0);
      break;
    case 1:
      approach.closing = 0.0;
      approach.pull = random.uniform(0.0, 20.0) / (duration * duration);
      break;
    default:
      break;
  }
  const Contact contact = any_contact(random);
  const bool plane = contact.query.a.kind == Kind::half_space;
  if (plane) {
    approach.spin_a = 0.0;
  }
  const double time = random.below(3) == 0 ? 0.0 : random.uniform() * duration;
  Query q = set_moving(random, contact, approach, time, duration);
  bend(random, q.b, time, duration);
  if (!plane && random.below(2) == 0) {
    bend(random, q.a, time, duration);
  }
  if (random.below(3) == 0) {
    q.b.error_radius = random.log_uniform(1e-12, 1e-3);
  }
  return q;
}

constexpr Family families[] = {
    {"curved", "polynomials in time, rotations too, some with an error radius", curved},
};

}  // namespace

std::span<const Family> polynomial_families() { return families; }

}  // namespace kairos::judge
