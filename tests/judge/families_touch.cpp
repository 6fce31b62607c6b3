#include "tests/judge/families.hpp"

#include <cmath>

namespace kairos::judge {
namespace {

Query started(Random& random, double closing, double sliding) {
  Approach approach{.closing = closing, .sliding = sliding, .a_moves = random.below(2) == 0};
  if (random.below(2) == 0) {
    approach.spin_a = random.log_uniform(1e-3, 10.0);
  }
  if (random.below(2) == 0) {
    approach.spin_b = random.log_uniform(1e-3, 10.0);
  }
  return set_moving(random, any_contact(random), approach, 0.0, random.log_uniform(0.1, 20.0));
}

Query enter(Random& random) {
  return started(random, random.log_uniform(1e-6, 10.0), random.uniform() * 2.0);
}
Query leave(Random& random) {
  return started(random, -random.log_uniform(1e-6, 10.0), random.uniform() * 2.0);
}
Query slide(Random& random) {
  const double into = random.below(2) == 0 ? 0.0 : random.log_uniform(1e-16, 1e-6);
  return started(random, random.below(2) == 0 ? into : -into, random.uniform(0.1, 2.0));
}

/// Face on face at one tilted orientation, no spin: the motion of a crate on a crate.
Query tilted_crates(Random& random) {
  const Contact contact =
      boxes_in_touch(random, random.below(3) == 0 ? Feature::face_face : Feature::same_tilt,
                     random_box(random, 0.3, 1.0), random_box(random, 0.3, 1.0));
  Approach approach{.closing = 0.0, .sliding = random.uniform(0.1, 1.0)};
  switch (random.below(4)) {
    case 0:
      approach.closing = random.log_uniform(1e-9, 1.0);
      break;
    case 1:
      approach.closing = -random.log_uniform(1e-9, 1.0);
      break;
    case 2:
      approach.closing = -1.0;
      approach.pull = -random.uniform(0.1, 10.0);
      break;
    default:
      break;
  }
  return set_moving(random, contact, approach, 0.0, 20.0);
}

/// A distance at the start of the order of the tolerance, or an overlap of that order.
Query near_touch(Random& random) {
  Approach approach{.closing = random.uniform(-1.0, 1.0), .sliding = random.uniform()};
  approach.gap = random.log_uniform(1e-17, 1e-7) * (random.below(2) == 0 ? 1.0 : -1.0);
  approach.spin_b = random.below(2) == 0 ? 0.0 : random.uniform(0.0, 3.0);
  return set_moving(random, any_contact(random), approach, 0.0, random.log_uniform(0.1, 10.0));
}

/// In touch far from the origin, parting at once or turning back.
Query retreat(Random& random) {
  Contact contact = any_contact(random);
  const double far = random.log_uniform(1e5, 1e8);
  const Vector3 by = random.direction() * far;
  shift(contact.query, by);
  contact.point += by;
  Approach approach{.closing = random.uniform(-1.0, 1.0)};
  approach.gap = random.below(2) == 0 ? 0.0 : random.log_uniform(1e-17, 1e-14) * far;
  return set_moving(random, contact, approach, 0.0, 1.0);
}

/// In touch at the start with nothing but accelerations to decide.
Query from_rest(Random& random) {
  Approach approach{.closing = 0.0};
  approach.pull = random.log_uniform(1e-3, 20.0) * (random.below(2) == 0 ? 1.0 : -1.0);
  approach.spin_b = random.below(2) == 0 ? 0.0 : random.log_uniform(1e-6, 3.0);
  return set_moving(random, any_contact(random), approach, 0.0, random.log_uniform(0.01, 10.0));
}

/// Edges in touch that part, at sines of about 1e-3 and less.
Query edges_leave(Random& random) {
  const Contact contact = crossing_edges(random, random.log_uniform(1e-6, 1e-1), random_box(random),
                                         random_box(random));
  Approach approach{.closing = -random.log_uniform(1e-3, 2.0), .sliding = random.uniform()};
  approach.spin_b = random.below(2) == 0 ? 0.0 : random.uniform(0.0, 1.0);
  return set_moving(random, contact, approach, 0.0, 1.0);
}

constexpr Family families[] = {
    {"touch-enter", "in touch at the start, entering", enter},
    {"touch-leave", "in touch at the start, parting", leave},
    {"touch-slide", "in touch at the start, sliding; into or away by up to 1e-6 m/s", slide},
    {"tilted-crates", "boxes of one tilted orientation, face on face, sliding", tilted_crates},
    {"near-touch", "apart or overlapping by 1e-17 to 1e-7 m at the start", near_touch},
    {"retreat", "in touch at up to 1e8 m from the origin", retreat},
    {"from-rest", "in touch at the start, at rest at the contact, accelerating", from_rest},
    {"edges-leave", "edges in touch at a small sine, parting", edges_leave},
};

}  // namespace

std::span<const Family> touching_families() { return families; }

}  // namespace kairos::judge
