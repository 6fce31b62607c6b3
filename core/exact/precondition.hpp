#pragma once

#include "core/error.hpp"
#include "core/exact_solution.hpp"

#include <string>

namespace kairos {
inline namespace core {
namespace exact {

/// Throws `InputError` with what the named solution needs, unless it holds.
inline void need(bool holds, const Scene& scene, const std::string& what) {
  if (!holds) {
    const std::string name = scene.exact ? scene.exact->solution : "exact solution";
    throw InputError(scene.path, 0, "exact.solution", "\"" + name + "\" needs " + what);
  }
}

/// Indices of the bodies that move freely.
inline std::vector<BodyIndex> free_bodies(const Scene& scene) {
  need(scene.joints.empty(), scene, "bodies that no joint holds");
  std::vector<BodyIndex> result;
  for (BodyIndex i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].entity->mobility() == Mobility::free) {
      result.push_back(i);
    }
  }
  return result;
}

/// A half-space that is a wall at rest.
inline bool is_plane(const Body& body) {
  return std::holds_alternative<HalfSpace>(body.shape) && body.drive == nullptr &&
         body.entity->physics_type() == PhysicsType::wall;
}
/// One with its normal upwards.
inline bool is_floor(const Body& body) {
  return is_plane(body) &&
         half_space_normal(std::get<HalfSpace>(body.shape), body.initial.pose) == Vector3::UnitY();
}

/// Acceleration of gravity on a body, m/s^2.
inline Vector3 gravity(const Scene& scene, const Body& body) {
  const double size = scene.gravity == GravityMode::force ? body.G / body.mass : body.G;
  return size * body.entity->gravity_direction();
}

/// The instant in a longer type: absolute times of many periods lose fewer bits.
inline long double seconds(Instant t) {
  return static_cast<long double>(t.seconds) + static_cast<long double>(t.correction);
}

}  // namespace exact
}  // namespace core
}  // namespace kairos
