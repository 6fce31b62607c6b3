#pragma once

#include "tests/ccd/convex_reference.hpp"

#include <numbers>

/// Random queries over all pairs of shapes, each made to touch, or to miss narrowly, at a known
/// time.
namespace kairos::convex {

inline constexpr std::array<const char*, 7> shape_names{"sphere", "box",  "capsule",   "cylinder",
                                                        "cone",   "hull", "half-space"};
enum class Course { hit, graze, enter, leave, spin };
inline constexpr std::array<const char*, 5> course_names{"hit", "graze", "enter", "leave", "spin"};

/// One of the shapes; one of eight is a sliver.
inline Shape random_shape(Random& random, int kind) {
  const bool sliver = random.below(8) == 0;
  const auto size = [&] { return random.log_uniform(sliver ? 1e-3 : 0.2, 2.0); };
  switch (kind) {
    case 0:
      return Sphere{size()};
    case 1:
      return Box{{size(), size(), size()}};
    case 2:
      return Capsule{size(), size()};
    case 3:
      return Cylinder{size(), size()};
    case 4:
      return Cone{size(), size()};
    case 5: {
      std::vector<Vector3> points;
      const Vector3 scale(size(), size(), size());
      const auto count = 4 + random.below(28);
      for (std::uint64_t i = 0; i < count; ++i) {
        points.push_back(random.direction().cwiseProduct(scale));
      }
      return Hull{convex_hull(points).polytope, random.below(4) == 0 ? 0.1 * size() : 0.0};
    }
    default:
      return HalfSpace{};
  }
}

/// A direction in which the shape is met along a face, an edge or anywhere, body frame.
inline Vector3 random_normal(Random& random, const Shape& shape) {
  const auto kind = random.below(3);
  if (const auto* hull = std::get_if<Hull>(&shape); hull != nullptr && kind == 0) {
    return hull->core->normals[random.below(hull->core->normals.size())];
  }
  if (const auto* hull = std::get_if<Hull>(&shape); hull != nullptr && kind == 1) {
    return random.direction().cross(hull->core->directions[0]).normalized();
  }
  if (kind == 0) {
    return Vector3::Unit(static_cast<int>(random.below(3))) * (random.below(2) == 0 ? 1.0 : -1.0);
  }
  if (kind == 1) {
    return random.direction().cross(Vector3::UnitY()).normalized();
  }
  return random.direction();
}

inline Vector3 any_vector(Random& random, double most) {
  const double x = random.uniform(-most, most);
  const double y = random.uniform(-most, most);
  return {x, y, random.uniform(-most, most)};
}

inline Vector3 rounded(const Vec& x) { return x.cast<double>(); }

inline Query random_query(Random& random, int kind_a, int kind_b, Course course) {
  Query q;
  q.a = random_shape(random, kind_a);
  q.b = random_shape(random, kind_b);
  q.family = course_names[static_cast<std::size_t>(course)];
  const bool starts_in_touch = course == Course::enter || course == Course::leave;
  q.touch = starts_in_touch ? 0.0 : random.uniform(0.1, 0.9);
  Pose at_a{any_vector(random, 3.0), random.orientation()};
  Pose at_b{Vector3::Zero(), random.orientation()};
  Vector3 n = at_a.orientation * random_normal(random, q.a);
  const bool plane = kind_b == 6;
  if (plane) {
    n = -(at_b.orientation * std::get<HalfSpace>(q.b).normal_B);
  } else if (random.below(2) == 0) {
    n = -(at_b.orientation * random_normal(random, q.b));
  }
  // In touch along n at `touch`, but for a narrow gap of a graze.
  const double size = std::min(smallest_extent(q.a), smallest_extent(q.b));
  const double miss = course == Course::graze
                          ? size * random.log_uniform(1e-9, 1e-3) * (random.below(2) == 0 ? 1 : -1)
                          : 0.0;
  const Vector3 on_a = rounded(
      highest({&q.a, at_a.position.cast<Real>(), at_a.orientation.cast<Real>()}, n.cast<Real>()));
  const Vector3 of_b =
      plane ? Vector3(Vector3::Zero())
            : rounded(highest({&q.b, Vec::Zero(), at_b.orientation.cast<Real>()}, -n.cast<Real>()));
  at_b.position = on_a + miss * n - of_b;
  const double closing = course == Course::leave   ? random.log_uniform(1e-3, 2.0)
                         : course == Course::graze ? 0.0
                                                   : -random.log_uniform(1e-3, 2.0);
  q.closing = closing;
  const Vector3 slide = random.direction().cross(n) * random.uniform(0.0, 2.0);
  const double spin = course == Course::spin ? 40.0 : random.below(3) == 0 ? 0.0 : 3.0;
  const Vector3 w_a = any_vector(random, spin);
  const Vector3 w_b = plane ? Vector3(Vector3::Zero()) : any_vector(random, spin);
  // The point of contact moves as is wanted against a.
  const Vector3 arm_a = on_a - at_a.position;
  const Vector3 v_a = any_vector(random, 1.0);
  const Vector3 v_b = v_a + w_a.cross(arm_a) - w_b.cross(of_b) + closing * n + slide;
  const Vector3 pull = random.below(2) == 0 ? any_vector(random, 5.0) : Vector3(Vector3::Zero());
  const auto back = [&](const Pose& pose, const Vector3& v, const Vector3& w, const Vector3& g) {
    const double t = q.touch;
    const Pose start{pose.position - t * v + 0.5 * t * t * g,
                     rotate(-t * w, pose.orientation).normalized()};
    return Motion::ballistic(Instant{}, q.duration, start, {v - t * g, w}, g);
  };
  q.motion_a = back(at_a, v_a, w_a, pull);
  q.motion_b = back(at_b, v_b, w_b, plane ? Vector3(Vector3::Zero()) : any_vector(random, 1.0));
  return q;
}

}  // namespace kairos::convex
