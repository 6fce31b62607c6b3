#include "tests/judge/contact.hpp"

#include <cmath>
#include <numbers>

namespace kairos::judge {
namespace {

Vector3 axis_of(const Quaternion& q, int i) { return q * Vector3::Unit(i); }

/// The quaternion whose body axes are u, v, w: right-handed, of length one.
Quaternion with_axes(const Vector3& u, const Vector3& v, const Vector3& w) {
  Matrix3 columns;
  columns << u, v, w;
  return Quaternion(columns).normalized();
}

/// The point of the box (relative to its centre) farthest along n, with `free` of its body axes
/// (those across n) anywhere along `share` of their length.
Vector3 farthest(Random& random, const Body& box, const Vector3& n, double straight, double share) {
  Vector3 point = Vector3::Zero();
  for (int i = 0; i < 3; ++i) {
    const Vector3 u = axis_of(box.orientation, i);
    const double along = u.dot(n);
    const double place = std::abs(along) < straight ? random.uniform(-share, share)
                         : along > 0                ? 1.0
                                                    : -1.0;
    point += place * box.half_extents[i] * u;
  }
  return point;
}

Contact touching(const Body& a, const Body& b, const Vector3& n, const Vector3& point_a,
                 const Vector3& point_b) {
  Contact contact;
  contact.query.a = a;
  contact.query.b = b;
  contact.query.b.position = a.position + point_a - point_b;
  contact.normal = n;
  contact.point = a.position + point_a;
  return contact;
}

/// An orientation of b with axis j along -n, and edge k at `angle` from `along`.
Quaternion facing(const Vector3& n, int j, const Vector3& along, double angle) {
  const Vector3 first = (std::cos(angle) * along + std::sin(angle) * n.cross(along)).normalized();
  const Vector3 second = (-n).cross(first);
  switch (j) {
    case 0:
      return with_axes(-n, first, second);
    case 1:
      return with_axes(second, -n, first);
    default:
      return with_axes(first, second, -n);
  }
}

}  // namespace

Vector3 across(Random& random, const Vector3& n) {
  Vector3 t = n.cross(random.direction());
  while (t.norm() < 0.1) {
    t = n.cross(random.direction());
  }
  return t.normalized();
}

Vector3 random_half_extents(Random& random, double lowest, double highest) {
  const double x = random.log_uniform(lowest, highest);
  const double y = random.log_uniform(lowest, highest);
  return {x, y, random.log_uniform(lowest, highest)};
}

Body random_box(Random& random, double lowest, double highest) {
  Body body;
  body.half_extents = random_half_extents(random, lowest, highest);
  body.orientation = random.orientation();
  return body;
}

Body random_sphere(Random& random) {
  Body body;
  body.kind = Kind::sphere;
  body.half_extents = Vector3::Constant(random.log_uniform(0.1, 2.0));
  body.orientation = random.orientation();
  return body;
}

Body random_plane(Random& random) {
  Body body;
  body.kind = Kind::half_space;
  switch (random.below(4)) {
    case 0:
      body.normal = random.direction();
      break;
    case 1:
      body.normal = random.direction();
      body.orientation = random.orientation();
      break;
    default:
      body.orientation = random.orientation();
  }
  return body;
}

Contact boxes_in_touch(Random& random, Feature feature, const Body& a, const Body& b_in) {
  Body b = b_in;
  const int i = static_cast<int>(random.below(3));
  const int j = static_cast<int>(random.below(3));
  const Vector3 n = axis_of(a.orientation, i) * (random.below(2) == 0 ? 1.0 : -1.0);
  const Vector3 edge = axis_of(a.orientation, (i + 1) % 3);
  const double quarter = 0.5 * std::numbers::pi;
  switch (feature) {
    case Feature::edge_edge:
      return crossing_edges(random, random.uniform(0.2, 1.0), a, b);
    case Feature::same_tilt:
      b.orientation = a.orientation;
      break;
    case Feature::face_face:
      b.orientation =
          facing(n, j, edge, random.below(2) == 0 ? 0.0 : random.uniform(0.0, 4 * quarter));
      break;
    case Feature::edge_face: {
      const Quaternion flat = facing(n, j, edge, random.uniform(0.0, 4 * quarter));
      b.orientation = (Quaternion(Eigen::AngleAxisd(random.uniform(0.1, quarter - 0.1),
                                                    axis_of(flat, (j + 1) % 3))) *
                       flat)
                          .normalized();
      break;
    }
    case Feature::vertex_face:
    case Feature::edge_vertex:
    case Feature::vertex_vertex:
      break;
  }
  const double share_a = feature == Feature::vertex_vertex ? 0.0 : 0.95;
  Vector3 on_a = farthest(random, a, n, 1e-6, share_a);
  if (feature == Feature::vertex_vertex || feature == Feature::edge_vertex) {
    on_a = Vector3::Zero();
    for (int k = 0; k < 3; ++k) {
      const bool inside = k == (i + 1) % 3 && feature == Feature::edge_vertex;
      const double side = k == i   ? (axis_of(a.orientation, k).dot(n) > 0 ? 1.0 : -1.0)
                          : inside ? random.uniform(-0.95, 0.95)
                          : random.below(2) == 0 ? 1.0
                                                 : -1.0;
      on_a += side * a.half_extents[k] * axis_of(a.orientation, k);
    }
  }
  return touching(a, b, n, on_a, farthest(random, b, -n, 1e-6, 0.95));
}

Contact crossing_edges(Random& random, double sine, const Body& a, const Body& b_in) {
  Body b = b_in;
  const int i = static_cast<int>(random.below(3));
  const int j = static_cast<int>(random.below(3));
  const Vector3 u = axis_of(a.orientation, i);
  // A normal inside the cone of a's edge, and b's edge across it.
  const double lean = random.uniform(0.1, 1.4);
  const Vector3 n =
      (std::cos(lean) * axis_of(a.orientation, (i + 1) % 3) * (random.below(2) == 0 ? 1.0 : -1.0) +
       std::sin(lean) * axis_of(a.orientation, (i + 2) % 3) * (random.below(2) == 0 ? 1.0 : -1.0))
          .normalized();
  const double angle = sine >= 1.0 ? 0.5 * std::numbers::pi : std::asin(sine);
  const Vector3 v = std::cos(angle) * u + std::sin(angle) * n.cross(u);
  const double lean_b = random.uniform(0.1, 1.4);
  const Vector3 s = n.cross(v);
  const Vector3 p = std::cos(lean_b) * n + std::sin(lean_b) * s;
  const Vector3 q = v.cross(p);
  b.orientation = j == 0 ? with_axes(v, p, q) : j == 1 ? with_axes(q, v, p) : with_axes(p, q, v);
  const auto on_edge = [&](const Body& body, int along, const Vector3& direction) {
    Vector3 point = Vector3::Zero();
    for (int k = 0; k < 3; ++k) {
      const Vector3 axis = axis_of(body.orientation, k);
      const double place = k == along                ? random.uniform(-0.95, 0.95)
                           : axis.dot(direction) > 0 ? 1.0
                                                     : -1.0;
      point += place * body.half_extents[k] * axis;
    }
    return point;
  };
  return touching(a, b, n, on_edge(a, i, n), on_edge(b, j, -n));
}

Contact on_plane(Random& random, const Body& plane, const Body& b_in) {
  Body b = b_in;
  const Vector3 n = half_space_normal(HalfSpace{plane.normal}, {plane.position, plane.orientation});
  const Vector3 t = across(random, n);
  const Vector3 place = t * random.uniform(0.0, 10.0);
  Vector3 reach;
  if (b.kind == Kind::sphere) {
    reach = -n * b.half_extents.x();
  } else {
    switch (random.below(4)) {
      case 0:
        b.orientation = facing(-n, static_cast<int>(random.below(3)), t, 0.0);
        break;
      case 1: {
        const Quaternion flat = facing(-n, 1, t, 0.0);
        b.orientation =
            (Quaternion(Eigen::AngleAxisd(random.uniform(0.1, 1.4), axis_of(flat, 0))) * flat)
                .normalized();
        break;
      }
      case 2:
        b.orientation = plane.orientation;
        break;
      default:
        break;
    }
    reach = farthest(random, b, -n, 1e-6, 0.95);
  }
  return touching(plane, b, n, place, reach);
}

Contact on_ball(Random& random, const Body& a, const Body& ball) {
  const Vector3 n_any = random.direction();
  if (a.kind == Kind::sphere) {
    return touching(a, ball, n_any, n_any * a.half_extents.x(), -n_any * ball.half_extents.x());
  }
  // Against a box: on a face, an edge or a vertex, with a normal of its cone.
  Vector3 n_B = Vector3::Zero();
  Vector3 point_B = Vector3::Zero();
  const std::uint64_t sides = 1 + random.below(3);
  const std::uint64_t first = random.below(3);
  for (std::uint64_t k = 0; k < 3; ++k) {
    const int i = static_cast<int>((first + k) % 3);
    const double side = random.below(2) == 0 ? 1.0 : -1.0;
    point_B[i] = (k < sides ? side : random.uniform(-0.95, 0.95)) * a.half_extents[i];
    n_B[i] = k < sides ? side * random.uniform(0.2, 1.0) : 0.0;
  }
  const Vector3 n = a.orientation * n_B.normalized();
  return touching(a, ball, n, a.orientation * point_B, -n * ball.half_extents.x());
}

Contact any_contact(Random& random) {
  switch (random.below(10)) {
    case 0:
      return on_plane(random, random_plane(random), random_sphere(random));
    case 1:
    case 2:
      return on_plane(random, random_plane(random), random_box(random));
    case 3:
      return on_ball(random, random_sphere(random), random_sphere(random));
    case 4:
      return on_ball(random, random_box(random), random_sphere(random));
    default:
      return boxes_in_touch(random, static_cast<Feature>(random.below(feature_count)),
                            random_box(random), random_box(random));
  }
}

Query set_moving(Random& random, const Contact& contact, const Approach& approach, double time,
                 double duration) {
  Query q = contact.query;
  q.duration = duration;
  const Vector3& n = contact.normal;
  q.b.position += approach.gap * n;
  q.a.spin = approach.spin_a * random.direction();
  q.b.spin = approach.spin_b * random.direction();
  const Vector3 shared = approach.drift * random.direction();
  const Vector3 own =
      approach.a_moves ? Vector3(random.direction() * random.uniform()) : Vector3::Zero();
  q.a.velocity = shared + own;
  const Vector3 wanted = -approach.closing * n + approach.sliding * across(random, n);
  // Velocities of the contact point as part of either body differ by what is wanted.
  q.b.velocity = q.a.velocity + q.a.spin.cross(contact.point - q.a.position) -
                 q.b.spin.cross(contact.point - q.b.position) + wanted;
  q.b.acceleration = approach.pull * n;
  // Back from the contact to the start of the window.
  for (Body* body : {&q.a, &q.b}) {
    body->velocity -= body->acceleration * time;
    body->position -= body->velocity * time + 0.5 * body->acceleration * time * time;
    if (time != 0.0 && !body->spin.isZero(0.0)) {
      body->orientation = rotate(-body->spin * time, body->orientation).normalized();
    }
  }
  return q;
}

void shift(Query& query, const Vector3& by) {
  query.a.position += by;
  query.b.position += by;
}

void turn(Query& query, const Quaternion& by) {
  for (Body* body : {&query.a, &query.b}) {
    for (Vector3* v : {&body->position, &body->velocity, &body->acceleration, &body->spin}) {
      *v = by * *v;
    }
    body->orientation = (by * body->orientation).normalized();
  }
}

void advance(Query& query, double seconds) {
  for (Body* body : {&query.a, &query.b}) {
    const Motion later = body->motion(query.start, query.duration).shifted(body->age + seconds);
    body->position = later.position(0.0);
    body->velocity = later.velocity(0.0);
    const Vector4& q = later.quaternion[0];
    body->orientation = Quaternion(q[0], q[1], q[2], q[3]);
    body->age = 0.0;
  }
  query.duration -= seconds;
}

}  // namespace kairos::judge
