#include "tests/judge/families.hpp"

namespace kairos::judge {
namespace {

/// Deep in one another at the start, apart at about `time`.
Query parted(Random& random, const Contact& contact, double spin_a) {
  const double duration = random.log_uniform(0.1, 10.0);
  Approach approach{.closing = -random.log_uniform(1e-3, 3.0), .sliding = random.uniform(0.0, 1.0)};
  approach.spin_a = spin_a;
  approach.spin_b = random.below(2) == 0 ? 0.0 : random.log_uniform(1e-3, 3.0);
  approach.pull = random.below(2) == 0 ? 0.0 : random.uniform(-2.0, 5.0);
  return set_moving(random, contact, approach, random.uniform(0.01, 1.2) * duration, duration);
}

Query any_parting(Random& random) { return parted(random, any_contact(random), 0.0); }

/// Out of a half-space that turns, far from its origin.
Query plane_parting(Random& random) {
  const Body body = random.below(2) == 0 ? random_box(random) : random_sphere(random);
  Contact contact = on_plane(random, random_plane(random), body);
  const Vector3 n = contact.normal;
  const Vector3 along = across(random, n) * random.log_uniform(1e-2, 1e4);
  contact.query.b.position += along;
  contact.point += along;
  return parted(random, contact, random.log_uniform(1e-6, 2.0));
}

constexpr Family families[] = {
    {"parting", "overlapping at the start: when are they apart?", any_parting, true},
    {"parting-plane", "the same, of a half-space that turns", plane_parting, true},
};

}  // namespace

std::span<const Family> parting_families() { return families; }

}  // namespace kairos::judge
