#include "ccd/certified.hpp"
#include "tests/judge/families.hpp"

#include <array>
#include <cmath>

namespace kairos::judge {
namespace {

/// Asked again from the answer, as a scheme does that did not change the velocities.
Query repeated(Random& random) {
  Query q = any_query(random);
  const TimeOfImpact answer = q.ask(*ccd::make_certified());
  if (answer.status == ToiStatus::impact || answer.status == ToiStatus::undecided) {
    advance(q, answer.t_lo);
  }
  return q;
}

/// Asked again from the answer, with the normal velocity turned round, as an impact does.
Query rebound(Random& random) {
  Query q = any_query(random);
  const TimeOfImpact answer = q.ask(*ccd::make_certified());
  if (answer.status == ToiStatus::impact) {
    advance(q, answer.t_lo);
    const Vector3 n = answer.normal;
    const Vector3 at = answer.witness_b;
    const double closing = n.dot(q.b.velocity + q.b.spin.cross(at - q.b.position) - q.a.velocity -
                                 q.a.spin.cross(at - q.a.position));
    if (std::isfinite(closing) && closing < 0.0) {
      q.b.velocity -= (1.0 + random.uniform()) * closing * n;
    }
  }
  return q;
}

Query exchanged(Random& random) { return any_query(random).exchanged(); }

Query shifted(Random& random) {
  Query q = any_query(random);
  shift(q, random.direction() * 1e6);
  return q;
}

/// Seen in a mirror: x turns its sign.
Query mirrored(Random& random) {
  Query q = any_query(random);
  for (Body* body : {&q.a, &q.b}) {
    for (Vector3* v : {&body->position, &body->velocity, &body->acceleration}) {
      v->x() *= -1.0;
    }
    body->normal.x() *= -1.0;
    body->spin.y() *= -1.0;
    body->spin.z() *= -1.0;
    body->orientation.y() *= -1.0;
    body->orientation.z() *= -1.0;
  }
  return q;
}

/// Motions that began earlier than the window, at times of their own; late on the clock.
Query time_shifted(Random& random) {
  Query q = any_query(random);
  q.start = Instant{} + random.log_uniform(1.0, 1e6);
  for (Body* body : {&q.a, &q.b}) {
    const double age = 0x1p-20 * static_cast<double>(random.below(1U << 24U));
    body->age = random.below(2) == 0 ? 0.0 : age;
    body->velocity -= body->acceleration * body->age;
    body->position -= body->velocity * body->age + 0.5 * body->acceleration * body->age * body->age;
    body->orientation = rotate(-body->spin * body->age, body->orientation).normalized();
  }
  return q;
}

/// Quaternions as arithmetic leaves them: of length one to a few roundings.
Query rounded_quaternions(Random& random) {
  Query q = any_query(random);
  for (Body* body : {&q.a, &q.b}) {
    body->orientation.coeffs() *= 1.0 + 0x1p-52 * (static_cast<double>(random.below(9)) - 4.0);
  }
  return q;
}

Query turned(Random& random) {
  Query q = any_query(random);
  turn(q, random.orientation());
  return q;
}

Query with_tolerance(Random& random) {
  Query q = any_query(random);
  q.tolerance = random.log_uniform(1e-15, 1e-2);
  return q;
}

constexpr Family families[] = {
    {"repeated", "asked again from the answer", repeated},
    {"rebound", "asked again from the answer, after an impact", rebound},
    {"exchanged", "a and b exchanged", exchanged},
    {"shifted", "moved by 1e6 m", shifted},
    {"mirrored", "x turned round", mirrored},
    {"time-shifted", "motions that began before the window", time_shifted},
    {"quaternions", "of length one but for roundings", rounded_quaternions},
    {"turned", "the world turned", turned},
    {"tolerance", "a tolerance of 1e-15 to 1e-2 m", with_tolerance},
};

}  // namespace

std::span<const Family> changed_families() { return families; }

Query any_query(Random& random) {
  const std::array<std::span<const Family>, 4> all{touching_families(), plane_families(),
                                                   graze_families(), scale_families()};
  std::size_t count = 0;
  for (const auto& some : all) {
    count += some.size();
  }
  std::size_t index = random.below(count);
  for (const auto& some : all) {
    if (index < some.size()) {
      return some[index].make(random);
    }
    index -= some.size();
  }
  return {};
}

}  // namespace kairos::judge
