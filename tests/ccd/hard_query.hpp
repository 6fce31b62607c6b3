#pragma once

#include "experiments/accuracy/random_query.hpp"

/// Seeded queries of the classes in which a proof is hard: starts in touch, tilted planes and long
/// windows, error radii, near-parallel edges, grazes, places far away, fast spins. A query is
/// repeated from its class and seed.
namespace kairos::reference {

enum class Hard {
  touch_enter,    ///< boxes of one tilted orientation in touch: sliding, and slowly entering
  touch_edges,    ///< edges that cross at a small sine, in touch, leaving
  touch_corner,   ///< a corner or an edge in touch that turns away
  tangential,     ///< spheres in touch, or nearly, that move past each other
  tilted_plane,   ///< along a tilted plane for long
  turning_plane,  ///< a half-space that turns about a point far away
  error_radius,   ///< boxes whose motions have error radii
  far_quick,      ///< 1e8 m away, contact within 1e-4 s
  near_parallel,  ///< boxes whose edges are parallel but for 1e-9 to 1e-3
  graze,          ///< turning boxes whose least gap is -1e-13 to 1e-3 of their size
  long_way,       ///< a graze at the end of a way of 1e3 to 1e7 extents
  spin,           ///< up to 1e6 rad beside something
};
inline constexpr int hard_classes = 12;
inline constexpr const char* hard_names[] = {
    "touch-enter",  "touch-edges", "touch-corner",  "tangential", "tilted-plane", "turning-plane",
    "error-radius", "far-quick",   "near-parallel", "graze",      "long-way",     "spin"};

inline Motion steady(const Pose& at, const Vector3& velocity, const Vector3& angular,
                     const Vector3& acceleration, double duration) {
  return Motion::ballistic({}, duration, at, {velocity, angular}, acceleration);
}

inline Box random_box(Random& random) {
  return box(random.uniform(0.2, 1.0), random.uniform(0.2, 1.0), random.uniform(0.2, 1.0));
}

inline Vector3 across(Random& random, const Vector3& n) {
  const Vector3 x = n.cross(random.direction());
  return x.norm() > 0.1 ? Vector3(x.normalized()) : across(random, n);
}

/// Box b upon face `face` of box a, both of orientation q, the faces `gap` apart.
inline Pose upon(Random& random, const Box& a, const Box& b, const Quaternion& q, int face,
                 double gap) {
  Vector3 at = random.vector(0.8).cwiseProduct(a.half_extents + b.half_extents);
  at[face] =
      (random.below(2) == 0 ? -1.0 : 1.0) * (a.half_extents[face] + b.half_extents[face] + gap);
  return {q * at, q};
}

inline Query touch_enter(Random& random) {
  const Quaternion q = random.orientation();
  const Box a = random_box(random);
  const Box b = random_box(random);
  const int face = random.below(3);
  const Pose at_b = upon(random, a, b, q, face, 0.0);
  const Vector3 n = q * Vector3::Unit(face) * ((q.conjugate() * at_b.position)[face] < 0 ? -1 : 1);
  const double slowly = random.log_uniform(1e-6, 1.0);
  const Vector3 velocity = across(random, n) * random.uniform(0.1, 1.0) - n * slowly;
  return {a, b,
          steady({Vector3::Zero(), q}, Vector3::Zero(), Vector3::Zero(), Vector3::Zero(), 4.0),
          steady(at_b, velocity, Vector3::Zero(), Vector3::Zero(), 4.0), 4.0};
}

/// Two edges that cross at `angle`, `gap` apart along a tilted direction; b's velocity is given in
/// that frame (x along a's edge, y up).
inline Query crossed_edges(Random& random, double angle, double gap, const Vector3& velocity,
                           const Vector3& angular, double duration) {
  const Quaternion tilt = random.orientation();
  const double side = random.uniform(0.2, 1.0);
  const Box a = box(random.uniform(0.5, 1.0), side, side);
  const Box b = box(random.uniform(0.5, 1.0), side, side);
  const Quaternion edge_up = turned(Vector3::UnitX(), std::atan(1.0));
  const Quaternion edge_down = turned(Vector3::UnitY(), angle) * edge_up;
  const Vector3 offset(random.uniform(-0.1, 0.1), 2.0 * std::sqrt(2.0) * side + gap, 0.0);
  return {a, b,
          steady({Vector3::Zero(), tilt * edge_up}, Vector3::Zero(), Vector3::Zero(),
                 Vector3::Zero(), duration),
          steady({tilt * offset, tilt * edge_down}, tilt * velocity, tilt * angular,
                 Vector3::Zero(), duration),
          duration};
}

inline Query touch_corner(Random& random) {
  const double rate = random.log_uniform(0.01, 10.0);
  const double angle = random.uniform(0.1, 0.7);
  // A box on its lower edge above a plane face, turning about an axis through that edge, so that
  // the touching corner leaves at second order, or along the face.
  const Box a = box(2.0, 0.5, 2.0);
  const Box b = random_box(random);
  const Quaternion q_b = turned(Vector3::UnitZ(), angle);
  double low = 0.0;
  for (int c = 0; c < 8; ++c) {
    const Vector3 x((c & 1) != 0 ? b.half_extents.x() : -b.half_extents.x(),
                    (c & 2) != 0 ? b.half_extents.y() : -b.half_extents.y(), 0.0);
    low = std::min(low, (q_b * x).y());
  }
  const Quaternion tilt = random.orientation();
  const Vector3 angular = Vector3(0, 0, rate * (random.below(2) == 0 ? -1.0 : 1.0));
  const Vector3 at(0.0, 0.5 - low, 0.0);
  // The corner's velocity is cancelled, or what remains of it is along the face.
  Vector3 corner = Vector3::Zero();
  for (int c = 0; c < 4; ++c) {
    const Vector3 x((c & 1) != 0 ? b.half_extents.x() : -b.half_extents.x(),
                    (c & 2) != 0 ? b.half_extents.y() : -b.half_extents.y(), 0.0);
    corner = (q_b * x).y() < corner.y() ? Vector3(q_b * x) : corner;
  }
  Vector3 velocity = -angular.cross(corner);
  velocity.x() += random.below(2) == 0 ? 0.0 : random.uniform(-1.0, 1.0);
  velocity.y() += random.below(3) == 0 ? random.log_uniform(1e-12, 1e-2) : 0.0;
  return {
      a, b, steady({Vector3::Zero(), tilt}, Vector3::Zero(), Vector3::Zero(), Vector3::Zero(), 1.0),
      steady({tilt * at, tilt * q_b}, tilt * velocity, tilt * angular, Vector3::Zero(), 1.0), 1.0};
}

inline Query tangential(Random& random) {
  const Sphere a{random.uniform(0.2, 1.0)};
  const Sphere b{random.uniform(0.2, 1.0)};
  const Vector3 n = random.direction();
  const double gap = random.below(2) == 0 ? 0.0 : random.log_uniform(1e-18, 1e-12);
  const Vector3 velocity = across(random, n) * random.log_uniform(1e-3, 1e3);
  return {a, b,
          steady({Vector3::Zero(), Quaternion::Identity()}, Vector3::Zero(), Vector3::Zero(),
                 Vector3::Zero(), 10.0),
          steady({n * (a.radius + b.radius + gap), Quaternion::Identity()}, velocity,
                 Vector3::Zero(), Vector3::Zero(), 10.0),
          10.0};
}

inline Query tilted_plane(Random& random) {
  const double duration = random.log_uniform(1.0, 1e5);
  const Quaternion q = random.orientation();
  const Vector3 n = q * Vector3::UnitY();
  const bool ball = random.below(2) == 0;
  const Box body = random_box(random);
  const Quaternion q_a = random.orientation();
  const double reach = ball ? 0.5 : body.half_extents.dot((q_a.conjugate() * n).cwiseAbs());
  const double gap = random.below(3) == 0 ? 0.0 : random.log_uniform(1e-12, 1.0);
  const Vector3 along = across(random, n);
  const Vector3 velocity = along * random.log_uniform(1.0, 1e3) -
                           n * (random.below(2) == 0 ? 0.0 : random.log_uniform(1e-15, 1.0));
  const Vector3 acceleration =
      random.below(2) == 0 ? Vector3(Vector3::Zero()) : Vector3(across(random, n) * 9.81);
  return {ball ? Shape(Sphere{0.5}) : Shape(body), HalfSpace{},
          steady({n * (reach + gap), q_a}, velocity, Vector3::Zero(), acceleration, duration),
          steady({Vector3::Zero(), q}, Vector3::Zero(), Vector3::Zero(), Vector3::Zero(), duration),
          duration};
}

inline Query turning_plane(Random& random) {
  const Quaternion q = random.orientation();
  const Vector3 n = q * Vector3::UnitY();
  const double lever = random.log_uniform(1.0, 1e4);
  const bool ball = random.below(2) == 0;
  const Box body = random_box(random);
  const Vector3 at = across(random, n) * lever + n * random.uniform(1.0, 3.0);
  return {ball ? Shape(Sphere{0.5}) : Shape(body), HalfSpace{},
          steady({at, random.orientation()}, random.vector(1.0), random.vector(1.0),
                 random.vector(1.0), 1.0),
          steady({Vector3::Zero(), q}, random.vector(1.0), random.vector(3.0 / lever),
                 Vector3::Zero(), 1.0),
          1.0};
}

inline Query with_error_radius(Random& random) {
  Query q = random_query(random.below(2) == 0 ? Difficulty::straight : Difficulty::turning, {1, 1},
                         random.bits() >> 20);
  if (random.below(3) == 0) {
    q = touch_enter(random);
    const Vector3 out = q.motion_b.position[0].normalized();
    q.motion_b.position[0] += out * random.uniform(0.0, 0.2);
  }
  q.motion_a.error_radius = random.log_uniform(1e-12, 0.1);
  q.motion_b.error_radius = random.below(2) == 0 ? 0.0 : random.log_uniform(1e-12, 0.1);
  return q;
}

inline Query far_quick(Random& random) {
  const Vector3 offset = random.direction() * 1e8;
  const bool balls = random.below(2) == 0;
  const Quaternion q = turned(Vector3::UnitZ(), random.uniform(0.0, 3.0));
  const Vector3 n = balls ? random.direction() : Vector3(q * Vector3::UnitX());
  const double gap = random.log_uniform(1e-9, 1e-4);
  const Shape shape = balls ? Shape(Sphere{1.0}) : Shape(box(1, 1, 1));
  return {shape, shape, steady({offset, q}, Vector3::Zero(), Vector3::Zero(), Vector3::Zero(), 1.0),
          steady({offset + n * (2.0 + gap), q}, -n, Vector3::Zero(), Vector3::Zero(), 1.0), 1.0};
}

inline Query near_parallel(Random& random) {
  const Quaternion q = random.orientation();
  const Box a = random_box(random);
  const Box b = random_box(random);
  const double angle = random.log_uniform(1e-9, 1e-3);
  Pose at_b = upon(random, a, b, q, random.below(3), random.log_uniform(1e-6, 0.5));
  const Vector3 n = at_b.position.normalized();
  at_b.orientation = turned(random.direction(), angle) * q;
  const Vector3 angular = random.below(2) == 0 ? Vector3(Vector3::Zero())
                                               : random.vector(random.log_uniform(1e-6, 1.0));
  return {a, b,
          steady({Vector3::Zero(), q}, Vector3::Zero(), Vector3::Zero(), Vector3::Zero(), 1.0),
          steady(at_b, -n * random.uniform(0.5, 2.0) + random.vector(0.3), angular, Vector3::Zero(),
                 1.0),
          1.0};
}

/// Two turning boxes, one moved along the direction between them, so that their least gap is what
/// is wanted: by secants on the least of the reference's separation.
inline Query graze(Random& random) {
  Query q{random_box(random),
          random_box(random),
          steady({Vector3::Zero(), random.orientation()}, Vector3::Zero(), random.vector(1.0),
                 Vector3::Zero(), 1.0),
          {},
          1.0};
  const Vector3 n = random.direction();
  const Vector3 velocity = across(random, n) * random.uniform(0.5, 4.0);
  const Vector3 middle = n * 3.0;
  q.motion_b = steady({middle - 0.5 * velocity, random.orientation()}, velocity, random.vector(3.0),
                      random.vector(1.0), 1.0);
  const double wanted = random.log_uniform(1e-13, 1e-3) * (random.below(2) == 0 ? -1.0 : 1.0);
  for (int i = 0; i < 40; ++i) {
    const Real least_gap = least([&q](Real t) { return q.separation(t); }, 0, 1, 200);
    q.motion_b.position[0] -= n * static_cast<double>(least_gap - Real(wanted));
  }
  return q;
}

inline Query long_way(Random& random) {
  const double duration = random.log_uniform(1e3, 1e6);
  const Quaternion q = random.orientation();
  const Box a = random_box(random);
  const Box b = random_box(random);
  const double speed = random.uniform(1.0, 10.0);
  const Vector3 way = random.direction() * speed;
  const int face = random.below(3);
  // At 0.9 of the window b passes a face of a, the faces `gap` apart and the way nearly along it.
  const Vector3 n = q * Vector3::Unit(face);
  const Vector3 along = (way - n * n.dot(way)).normalized() * speed;
  const Pose there = upon(random, a, b, q, face,
                          random.log_uniform(1e-12, 1e-2) * (random.below(2) == 0 ? -1.0 : 1.0));
  return {a, b,
          steady({Vector3::Zero(), q}, Vector3::Zero(), Vector3::Zero(), Vector3::Zero(), duration),
          steady({there.position - along * (0.9 * duration), q}, along, Vector3::Zero(),
                 Vector3::Zero(), duration),
          duration};
}

inline Query spin(Random& random) {
  const double rate = random.log_uniform(1e2, 1e6);
  const Box a = random_box(random);
  const Vector3 axis = random.below(2) == 0 ? Vector3(Vector3::UnitZ()) : random.direction();
  const bool ball = random.below(2) == 0;
  const Shape b = ball ? Shape(Sphere{0.3}) : Shape(random_box(random));
  const Vector3 out = across(random, axis);
  const double apart = a.half_extents.norm() + bounding_radius(b);
  return {a, b,
          steady({Vector3::Zero(), Quaternion::Identity()}, Vector3::Zero(), axis * rate,
                 Vector3::Zero(), 1.0),
          steady({out * apart * random.uniform(0.8, 1.1), random.orientation()},
                 out * random.uniform(-1.0, 0.2), Vector3::Zero(), Vector3::Zero(), 1.0),
          1.0};
}

inline Query hard_query(Hard hard, std::uint64_t seed) {
  Random random(seed * 64 + 40 + static_cast<std::uint64_t>(hard));
  switch (hard) {
    case Hard::touch_enter:
      return touch_enter(random);
    case Hard::touch_edges:
      return crossed_edges(random, random.log_uniform(1e-4, 0.5), 0.0,
                           {random.uniform(-0.1, 0.1), random.log_uniform(1e-3, 1.0), 0.0},
                           random.below(2) == 0 ? Vector3(Vector3::Zero()) : random.vector(1e-4),
                           1.0);
    case Hard::touch_corner:
      return touch_corner(random);
    case Hard::tangential:
      return tangential(random);
    case Hard::tilted_plane:
      return tilted_plane(random);
    case Hard::turning_plane:
      return turning_plane(random);
    case Hard::error_radius:
      return with_error_radius(random);
    case Hard::far_quick:
      return far_quick(random);
    case Hard::near_parallel:
      return random.below(2) == 0
                 ? near_parallel(random)
                 : crossed_edges(random, random.log_uniform(1e-9, 1e-3), random.uniform(0.1, 0.5),
                                 {random.uniform(-0.1, 0.1), -1.0, 0.0}, random.vector(1e-3), 1.0);
    case Hard::graze:
      return graze(random);
    case Hard::long_way:
      return long_way(random);
    case Hard::spin:
      break;
  }
  return spin(random);
}

}  // namespace kairos::reference
