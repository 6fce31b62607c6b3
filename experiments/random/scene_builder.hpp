#pragma once

#include "core/random.hpp"
#include "experiments/random/random_scene.hpp"

#include <cstdint>
#include <string>

namespace kairos::experiments {

/// A coefficient of friction; draws 0, .3 and rough often, as they are special.
[[nodiscard]] double random_friction(Random& random);

/// A vector of any direction, its length uniform. The length is drawn first. (Draws stand one in a
/// statement everywhere here: within an expression each compiler has an order of its own.)
[[nodiscard]] Vector3 random_vector(Random& random, double shortest, double longest);

/// What the makers of scenes of bodies in touch and on joints share: draws, planes, balls, boxes.
class SceneBuilder {
 protected:
  SceneBuilder(std::uint64_t seed, std::uint64_t index, std::string name);

  bool chance(double p) { return random_.uniform() < p; }
  /// Draws 0 and 1 often, as they are special.
  double restitution();
  double size() { return chance(0.5) ? 0.125 : random_.log_uniform(0.02, 0.5); }
  Vector3 vector(double shortest, double longest) {
    return random_vector(random_, shortest, longest);
  }
  double mass() { return chance(0.5) ? 1.0 : random_.log_uniform(1e-3, 1e3); }

  RandomBody& plane(const Vector3& normal, const Vector3& position = Vector3::Zero());
  RandomBody& ball(const Vector3& position, double radius);
  RandomBody& box(const Vector3& position, const Vector3& half);

  Random random_;
  RandomScene scene_;
};

}  // namespace kairos::experiments
