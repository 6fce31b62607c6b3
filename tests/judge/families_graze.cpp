#include "tests/judge/families.hpp"

#include <cmath>
#include <numbers>

namespace kairos::judge {
namespace {

double signed_log(Random& random, double lowest, double highest) {
  const double size = random.log_uniform(lowest, highest);
  return random.below(2) == 0 ? size : -size;
}

/// The least distance is 1e-16 to 1e-6 m, or minus that.
Query graze(Random& random) {
  Approach approach{.closing = 0.0, .sliding = random.uniform(0.0, 2.0)};
  approach.spin_a = random.below(2) == 0 ? 0.0 : random.uniform(0.0, 2.0);
  approach.spin_b = random.below(2) == 0 ? 0.0 : random.uniform(0.0, 2.0);
  approach.gap = signed_log(random, 1e-16, 1e-6);
  approach.pull = random.uniform(5.0, 60.0);
  return set_moving(random, any_contact(random), approach, random.uniform(0.1, 0.9), 1.0);
}

/// A graze made by rotation alone.
Query turning_graze(Random& random) {
  Approach approach{.closing = 0.0, .sliding = random.uniform(0.0, 2.0)};
  approach.spin_a = random.below(2) == 0 ? 0.0 : random.uniform(0.0, 3.0);
  approach.spin_b = random.uniform(0.1, 3.0);
  approach.gap = signed_log(random, 1e-16, 1e-6);
  return set_moving(random, any_contact(random), approach, random.uniform(0.1, 0.9), 1.0);
}

Query near_parallel(Random& random) {
  const double sine = random.log_uniform(1e-16, 1e-3);
  const Contact contact = crossing_edges(random, sine, random_box(random), random_box(random));
  Approach approach{.closing = random.uniform(-0.2, 1.0), .sliding = random.uniform(0.0, 2.0)};
  switch (random.below(3)) {
    case 0:
      approach.spin_b = random.log_uniform(1e-2, 10.0) * std::max(sine, 1e-9);
      break;
    case 1:
      approach.spin_b = random.uniform(0.0, 3.0);
      break;
    default:
      break;
  }
  return set_moving(random, contact, approach,
                    random.below(3) == 0 ? 0.0 : random.uniform(0.05, 0.95), 1.0);
}

/// Faces and edges almost parallel: one orientation, turned by a sine.
Query near_aligned(Random& random) {
  Contact contact =
      boxes_in_touch(random, Feature::same_tilt, random_box(random), random_box(random));
  const Vector3 by = random.direction() * random.log_uniform(1e-16, 1e-3);
  contact.query.b.orientation = rotate(by, contact.query.b.orientation).normalized();
  Approach approach{.closing = random.uniform(-0.2, 1.0), .sliding = random.uniform(0.0, 1.0)};
  approach.spin_b = random.below(2) == 0 ? 0.0 : random.log_uniform(1e-9, 1e-2);
  return set_moving(random, contact, approach, random.below(3) == 0 ? 0.0 : random.uniform(), 1.0);
}

/// A tumbling box whose corners come close several times before one of them touches.
Query several_roots(Random& random) {
  Approach approach{.closing = random.log_uniform(1e-3, 0.3), .sliding = random.uniform(0.0, 0.2)};
  approach.spin_a = random.below(2) == 0 ? 0.0 : random.uniform(1.0, 20.0);
  approach.spin_b = random.uniform(3.0, 30.0);
  approach.pull = random.below(2) == 0 ? 0.0 : random.uniform(-0.2, 0.2);
  return set_moving(random, any_contact(random), approach, random.uniform(0.3, 1.0) * 4.0, 4.0);
}

/// In, out and in again: thrown up twice through a double root.
Query turn_around(Random& random) {
  Approach approach{.closing = random.uniform(0.0, 1e-3), .sliding = random.uniform(0.0, 1.0)};
  approach.pull = random.uniform(1.0, 20.0);
  approach.gap = signed_log(random, 1e-14, 1e-4);
  approach.drift = random.uniform(0.0, 10.0);
  const double duration = random.log_uniform(1.0, 30.0);
  return set_moving(random, any_contact(random), approach, random.uniform(0.1, 0.9) * duration,
                    duration);
}

/// Up to 1e6 rad in the window.
Query fast_spin(Random& random) {
  const double duration = random.log_uniform(0.01, 10.0);
  const double turns = random.log_uniform(10.0, 1e6) / duration;
  Contact contact = any_contact(random);
  Approach approach{.closing = random.log_uniform(0.1, 1e3), .sliding = random.uniform(0.0, 10.0)};
  approach.spin_b = turns;
  approach.spin_a = random.below(2) == 0 || contact.query.a.kind == Kind::half_space
                        ? 0.0
                        : turns * random.uniform();
  return set_moving(random, contact, approach, random.uniform() * duration, duration);
}

/// A body that turns, up to 1e6 rad, and one beside all places where it can be, or just not.
Query spin_beside(Random& random) {
  Query q;
  q.a = random_box(random);
  const Vector3 axis =
      random.below(2) == 0 ? Vector3(q.a.orientation * Vector3::UnitZ()) : random.direction();
  q.duration = random.log_uniform(0.1, 1e3);
  q.a.spin = axis * random.log_uniform(1.0, 1e6) / q.duration;
  const Vector3 out = random.below(2) == 0 ? across(random, axis) : random.direction();
  // How far the corners reach along `out` at any angle.
  double reach = 0.0;
  for (int signs = 0; signs < 8; ++signs) {
    Vector3 corner = q.a.half_extents;
    for (int i = 0; i < 3; ++i) {
      corner[i] *= (signs >> i & 1) != 0 ? 1.0 : -1.0;
    }
    corner = q.a.orientation * corner;
    reach = std::max(reach, axis.dot(corner) * axis.dot(out) +
                                axis.cross(corner).norm() * axis.cross(out).norm());
  }
  q.b = random.below(2) == 0 ? random_sphere(random) : random_box(random);
  double extent = q.b.half_extents.x();
  if (q.b.kind == Kind::box) {
    const Vector3 out_B = q.b.orientation.conjugate() * out;
    extent = q.b.half_extents.dot(out_B.cwiseAbs());
  }
  q.b.position = out * (reach + extent + signed_log(random, 1e-15, 1e-1));
  if (random.below(3) == 0) {
    q.b.velocity = across(random, out) * random.log_uniform(1e-3, 1.0) / q.duration;
  }
  return q;
}

/// Centres at rest; what touches was turned there.
Query pure_spin(Random& random) {
  Contact contact = any_contact(random);
  Query q = contact.query;
  q.duration = random.log_uniform(0.1, 10.0);
  q.b.position += contact.normal * (random.below(2) == 0 ? 0.0 : signed_log(random, 1e-12, 1e-1));
  q.b.spin = random.direction() * random.log_uniform(0.01, 30.0);
  if (random.below(2) == 0 && q.a.kind != Kind::half_space) {
    q.a.spin = random.direction() * random.log_uniform(0.01, 30.0);
  }
  return q;
}

/// Both turn about the line along which they move.
Query screw(Random& random) {
  Query q;
  q.a = random_box(random);
  q.b = random_box(random);
  const Vector3 axis = random.below(2) == 0 ? random.direction() : Vector3(Vector3::UnitZ());
  if (random.below(2) == 0) {
    q.a.orientation = q.b.orientation = rotate(axis * random.uniform(), Quaternion::Identity());
    if (axis == Vector3::UnitZ() && random.below(2) == 0) {
      q.b.orientation = Quaternion::Identity();
    }
  }
  const double away = random.uniform(1.0, 8.0);
  q.b.position = axis * away;
  q.b.velocity = -axis * random.log_uniform(0.1, 10.0);
  q.b.spin = axis * random.uniform(-20.0, 20.0);
  q.a.spin =
      random.below(2) == 0 ? Vector3::Zero().eval() : Vector3(axis * random.uniform(-20.0, 20.0));
  q.duration = 10.0;
  return q;
}

/// Cubes that meet by edges, corners and faces at once.
Query ties(Random& random) {
  const double angles[] = {0.0, std::numbers::pi / 4, std::atan(std::sqrt(0.5)),
                           std::numbers::pi / 2, std::numbers::pi / 3};
  const auto some = [&] { return angles[random.below(5)]; };
  Query q;
  const double size = random.below(2) == 0 ? 1.0 : 0.1;
  for (Body* body : {&q.a, &q.b}) {
    body->half_extents = Vector3::Constant(size);
    body->orientation =
        rotate(Vector3::UnitX() * some(), rotate(Vector3::UnitZ() * some(), Quaternion::Identity()))
            .normalized();
  }
  if (random.below(2) == 0) {
    q.b.orientation = q.a.orientation;
  }
  const int i = static_cast<int>(random.below(3));
  q.b.position = Vector3::Unit(i) * random.uniform(4.0, 6.0) * size;
  if (random.below(2) == 0) {
    q.b.position += Vector3::Unit((i + 1) % 3) * size;
  }
  q.b.velocity = -Vector3::Unit(i) * random.uniform(0.5, 2.0) * size;
  if (random.below(2) == 0) {
    q.b.spin = Vector3::Unit(static_cast<int>(random.below(3))) * random.uniform(-3.0, 3.0);
    q.a.spin = random.below(2) == 0 ? Vector3::Zero().eval() : Vector3(-q.b.spin);
  }
  q.duration = 10.0;
  return q;
}

/// Numbers that are exact in binary, faces along the axes: touches are exact, too.
Query aligned(Random& random) {
  const auto dyadic = [&](std::uint64_t count) {
    return 0.125 * static_cast<double>(random.below(count));
  };
  Query q;
  for (Body* body : {&q.a, &q.b}) {
    const std::uint64_t kind = random.below(6);
    body->kind = kind == 0                   ? Kind::sphere
                 : kind == 1 && body == &q.a ? Kind::half_space
                                             : Kind::box;
    body->half_extents = Vector3(0.125, 0.125, 0.125) + Vector3(dyadic(8), dyadic(8), dyadic(8));
    if (body->kind == Kind::sphere) {
      body->half_extents = Vector3::Constant(body->half_extents.x());
    }
    body->velocity = Vector3(dyadic(9), dyadic(9), dyadic(9)) - Vector3::Constant(0.5);
    body->velocity *= random.below(3) == 0 ? 0.0 : 1.0;
    if (random.below(4) == 0) {
      body->acceleration = Vector3::Unit(static_cast<int>(random.below(3))) * (dyadic(33) - 2.0);
    }
  }
  q.b.position = Vector3(dyadic(33), dyadic(33), dyadic(33)) - Vector3::Constant(2.0);
  if (random.below(3) == 0) {
    const int i = static_cast<int>(random.below(3));
    q.b.position[i] = q.a.half_extents[i] + q.b.half_extents[i];
  }
  q.duration = 1.0 + dyadic(64);
  return q;
}

/// Nothing special: boxes that tumble at one another.
Query tumble(Random& random) {
  Approach approach{.closing = random.uniform(-0.5, 3.0), .sliding = random.uniform(0.0, 2.0)};
  approach.spin_a = random.uniform(0.0, 5.0);
  approach.spin_b = random.uniform(0.0, 5.0);
  approach.pull = random.uniform(-5.0, 5.0);
  approach.a_moves = true;
  return set_moving(random, any_contact(random), approach, random.uniform(),
                    random.uniform(0.2, 2.0));
}

constexpr Family families[] = {
    {"tumble", "nothing special", tumble},
    {"graze", "double roots to +-1e-16 m, by acceleration", graze},
    {"turning-graze", "the same, by rotation", turning_graze},
    {"near-parallel", "edges that cross at sines of 1e-3 to 1e-16", near_parallel},
    {"near-aligned", "faces turned by 1e-3 to 1e-16", near_aligned},
    {"several-roots", "corners that pass close by before one touches", several_roots},
    {"turn-around", "an acceleration turns the motion at the contact", turn_around},
    {"fast-spin", "up to 1e6 rad in the window", fast_spin},
    {"spin-beside", "beside all places where a turning body can be, or just not", spin_beside},
    {"pure-spin", "centres at rest", pure_spin},
    {"screw", "spins about the line of motion", screw},
    {"ties", "cubes by corners, edges and faces at once", ties},
    {"aligned", "exact in binary, along the axes", aligned},
};

}  // namespace

std::span<const Family> graze_families() { return families; }

}  // namespace kairos::judge
