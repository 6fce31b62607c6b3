#include "tests/judge/families.hpp"

#include <cmath>

namespace kairos::judge {
namespace {

/// Boxes and balls that meet after 1e3 to 1e6 s.
Query long_window(Random& random) {
  const double duration = random.log_uniform(1e3, 1e6);
  Approach approach{.closing = random.log_uniform(1e-6, 10.0),
                    .sliding = random.log_uniform(1e-6, 1.0)};
  if (random.below(4) == 0) {
    approach.closing = random.below(2) == 0 ? -1e-9 : 1e-9;
    approach.sliding = 0.0;
  }
  approach.spin_b = random.below(3) == 0 ? random.log_uniform(1e-9, 1e-2) : 0.0;
  approach.drift = random.below(2) == 0 ? 0.0 : random.log_uniform(1e-3, 10.0);
  return set_moving(random, any_contact(random), approach, random.uniform() * duration, duration);
}

/// The same, of one orientation: faces meet flat.
Query long_flat(Random& random) {
  const double duration = random.log_uniform(1e3, 1e6);
  Approach approach{.closing = random.log_uniform(1e-3, 10.0)};
  approach.sliding = random.below(2) == 0 ? 0.0 : random.log_uniform(1e-6, 1.0);
  approach.gap = 0.0;
  const Contact contact =
      boxes_in_touch(random, Feature::same_tilt, random_box(random), random_box(random));
  // It may turn back at about the time of contact.
  if (random.below(3) == 0) {
    approach.closing = 0.0;
    approach.pull = random.log_uniform(1e-9, 1e-3);
    approach.gap = random.uniform(-1e-6, 1e-6);
  }
  return set_moving(random, contact, approach, random.uniform(0.1, 1.0) * duration, duration);
}

Query far_away(Random& random) {
  Approach approach{.closing = random.log_uniform(1e-3, 100.0),
                    .sliding = random.uniform(0.0, 10.0)};
  approach.spin_b = random.below(2) == 0 ? 0.0 : random.uniform(0.0, 5.0);
  approach.drift = random.below(2) == 0 ? 0.0 : random.log_uniform(1.0, 1e4);
  Query q = set_moving(random, any_contact(random), approach, random.uniform(), 1.0);
  shift(q, random.direction() * random.log_uniform(1e3, 1e8));
  return q;
}

Body plate_or_needle(Random& random) {
  Body body;
  const double thin = random.log_uniform(1e-9, 1e-2);
  body.half_extents = random.below(2) == 0 ? Vector3(1.0, thin, random.uniform(0.1, 1.0))
                                           : Vector3(thin, 1.0, thin * random.uniform(0.1, 1.0));
  body.orientation = random.orientation();
  return body;
}

Query thin_bodies(Random& random) {
  const Body a = plate_or_needle(random);
  const Body b = random.below(2) == 0 ? plate_or_needle(random) : random_box(random);
  Contact contact;
  switch (random.below(6)) {
    case 0:
      contact = on_plane(random, random_plane(random), a);
      break;
    case 1:
      contact = on_ball(random, a, random_sphere(random));
      break;
    default:
      contact = boxes_in_touch(random, static_cast<Feature>(random.below(feature_count)), a, b);
  }
  Approach approach{.closing = random.log_uniform(1e-3, 100.0),
                    .sliding = random.uniform(0.0, 2.0)};
  approach.spin_a = random.below(2) == 0 || contact.query.a.kind == Kind::half_space
                        ? 0.0
                        : random.uniform(0.0, 5.0);
  approach.spin_b = random.below(2) == 0 ? 0.0 : random.uniform(0.0, 5.0);
  return set_moving(random, contact, approach, random.below(4) == 0 ? 0.0 : random.uniform(), 1.0);
}

Query mixed_extents(Random& random) {
  Body a = random_box(random, 1.0, 1e3);
  Body b = random.below(3) == 0 ? random_sphere(random) : random_box(random);
  b.half_extents *= random.log_uniform(1e-9, 1e-3);
  const Contact contact =
      b.kind == Kind::sphere
          ? on_ball(random, a, b)
          : boxes_in_touch(random, static_cast<Feature>(random.below(feature_count)), a, b);
  Approach approach{.closing = random.log_uniform(1e-6, 100.0),
                    .sliding = random.log_uniform(1e-6, 10.0)};
  approach.spin_a = random.below(2) == 0 ? 0.0 : random.log_uniform(1e-6, 1.0);
  approach.spin_b = random.below(2) == 0 ? 0.0 : random.log_uniform(1e-3, 100.0);
  Query q =
      set_moving(random, contact, approach, random.below(4) == 0 ? 0.0 : random.uniform(), 1.0);
  return random.below(2) == 0 ? q : q.exchanged();
}

/// The same motion in another unit of time, from 1e-12 s to 1e9 s.
Query other_durations(Random& random) {
  Approach approach{.closing = random.uniform(0.1, 3.0), .sliding = random.uniform(0.0, 1.0)};
  approach.spin_b = random.below(2) == 0 ? 0.0 : random.uniform(0.0, 5.0);
  approach.pull = random.below(2) == 0 ? 0.0 : random.uniform(-3.0, 3.0);
  Query q = set_moving(random, any_contact(random), approach, random.uniform(), 1.0);
  const double unit =
      random.below(2) == 0 ? random.log_uniform(1e-12, 1e-3) : random.log_uniform(1e3, 1e9);
  q.duration *= unit;
  for (Body* body : {&q.a, &q.b}) {
    body->velocity /= unit;
    body->acceleration /= unit * unit;
    body->spin /= unit;
  }
  return q;
}

/// Contact at the very start or the very end, and just outside.
Query at_the_ends(Random& random) {
  const double duration = random.log_uniform(0.01, 100.0);
  Approach approach{.closing = random.log_uniform(0.1, 100.0), .sliding = random.uniform(0.0, 1.0)};
  approach.spin_b = random.below(2) == 0 ? 0.0 : random.uniform(0.0, 5.0);
  const double off = random.log_uniform(1e-17, 1e-6) * (random.below(2) == 0 ? 1.0 : -1.0);
  const double time = random.below(3) == 0 ? std::abs(off) : duration * (1.0 + off);
  return set_moving(random, any_contact(random), approach, time, duration);
}

/// In and out again within 1e-9 to 1e-3 of the window: what flies by cuts a corner.
Query short_contact(Random& random) {
  Contact contact;
  switch (random.below(4)) {
    case 0:
      contact = on_ball(random, random_sphere(random), random_sphere(random));
      break;
    case 1:
      contact = on_ball(random, random_box(random), random_sphere(random));
      break;
    case 2:
      contact =
          boxes_in_touch(random, Feature::vertex_vertex, random_box(random), random_box(random));
      break;
    default:
      contact =
          crossing_edges(random, random.uniform(0.1, 1.0), random_box(random), random_box(random));
  }
  Approach approach{.closing = 0.0, .sliding = random.log_uniform(1.0, 1e6)};
  approach.gap = -random.log_uniform(1e-12, 1e-2);
  approach.spin_b = random.below(2) == 0 ? 0.0 : random.uniform(0.0, 5.0);
  const double length = 1e-3 / approach.sliding;
  const double when[] = {length, random.uniform(), 1.0 - length, 1.0 + length};
  return set_moving(random, contact, approach, when[random.below(4)], 1.0);
}

/// The same in another unit of length.
Query in_unit(Random& random, double lowest, double highest) {
  Approach approach{.closing = random.uniform(0.1, 3.0), .sliding = random.uniform(0.0, 1.0)};
  approach.spin_b = random.below(2) == 0 ? 0.0 : random.uniform(0.0, 5.0);
  Query q = set_moving(random, any_contact(random), approach, random.uniform(), 1.0);
  const double unit = std::pow(10.0, random.uniform(lowest, highest));
  for (Body* body : {&q.a, &q.b}) {
    for (Vector3* v :
         {&body->half_extents, &body->position, &body->velocity, &body->acceleration}) {
      *v *= unit;
    }
  }
  return q;
}

Query other_units(Random& random) { return in_unit(random, -60.0, 60.0); }
Query huge(Random& random) { return in_unit(random, 60.0, 160.0); }
Query tiny(Random& random) { return in_unit(random, -160.0, -60.0); }
Query subnormal(Random& random) { return in_unit(random, -318.0, -290.0); }

/// Errors of the motion are added to the bodies.
Query error_radii(Random& random) {
  Contact contact = any_contact(random);
  const double error = random.log_uniform(1e-9, 0.3);
  Approach approach{.closing = random.uniform(-0.2, 3.0), .sliding = random.uniform(0.0, 2.0)};
  approach.spin_a = random.below(2) == 0 ? 0.0 : random.uniform(0.0, 3.0);
  approach.spin_b = random.below(2) == 0 ? 0.0 : random.uniform(0.0, 3.0);
  approach.pull = random.below(2) == 0 ? 0.0 : random.uniform(-5.0, 5.0);
  approach.gap = random.below(2) == 0 ? error : error * random.uniform(0.0, 2.0);
  Query q = set_moving(random, contact, approach, random.below(4) == 0 ? 0.0 : random.uniform(),
                       random.uniform(0.5, 2.0));
  const double share = random.below(2) == 0 ? 0.0 : random.uniform();
  q.a.error_radius = share * error;
  q.b.error_radius = (1.0 - share) * error;
  return q;
}

constexpr Family families[] = {
    {"long-window", "contact after up to 1e6 s", long_window},
    {"long-flat", "the same, faces flat", long_flat},
    {"far-away", "up to 1e8 m from the origin", far_away},
    {"thin", "plates and needles, aspects to 1e9", thin_bodies},
    {"mixed-extents", "1e-9 beside 1e3 m", mixed_extents},
    {"durations", "windows of 1e-12 to 1e9 s", other_durations},
    {"ends", "contact within 1e-6 of the ends of the window, inside and outside", at_the_ends},
    {"short-contact", "in and out within 1e-9 to 1e-3 of the window", short_contact},
    {"units", "lengths of 1e-60 to 1e60 m", other_units},
    {"error-radius", "motions with an error radius", error_radii},
};

constexpr Family extremes[] = {
    {"huge", "lengths of 1e60 to 1e160 m", huge, false, true},
    {"tiny", "lengths of 1e-160 to 1e-60 m", tiny, false, true},
    {"subnormal", "lengths of 1e-318 to 1e-290 m", subnormal, false, true},
};

}  // namespace

std::span<const Family> scale_families() { return families; }
std::span<const Family> extreme_families() { return extremes; }

}  // namespace kairos::judge
