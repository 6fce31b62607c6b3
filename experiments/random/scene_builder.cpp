#include "experiments/random/scene_builder.hpp"

#include <fmt/format.h>

#include <limits>
#include <utility>

namespace kairos::experiments {

double random_friction(Random& random) {
  const double u = random.uniform();
  return u < 0.15   ? 0.0
         : u < 0.25 ? std::numeric_limits<double>::infinity()
         : u < 0.6  ? 0.3
                    : random.log_uniform(0.01, 2.0);
}

Vector3 random_vector(Random& random, double shortest, double longest) {
  const double length = random.uniform(shortest, longest);
  return random.direction() * length;
}

SceneBuilder::SceneBuilder(std::uint64_t seed, std::uint64_t index, std::string name)
    : random_(seed, index) {
  scene_.name = std::move(name);
}

double SceneBuilder::restitution() {
  const double u = random_.uniform();
  return u < 0.2 ? 0.0 : u < 0.4 ? 1.0 : u < 0.5 ? 0.5 : random_.uniform();
}

RandomBody& SceneBuilder::plane(const Vector3& normal, const Vector3& position) {
  RandomBody b;
  b.name = fmt::format("plane-{}", scene_.bodies.size());
  b.entity = "wall";
  b.shape = "half-space";
  b.normal = normal.normalized();
  b.position = position;
  scene_.bodies.push_back(b);
  return scene_.bodies.back();
}

RandomBody& SceneBuilder::ball(const Vector3& position, double radius) {
  RandomBody b;
  b.name = fmt::format("ball-{}", scene_.bodies.size());
  b.entity = "ball";
  b.shape = "sphere";
  b.radius = radius;
  b.mass = mass();
  b.restitution = restitution();
  b.position = position;
  scene_.bodies.push_back(b);
  return scene_.bodies.back();
}

RandomBody& SceneBuilder::box(const Vector3& position, const Vector3& half) {
  RandomBody& b = ball(position, 0.0);
  b.name = fmt::format("box-{}", scene_.bodies.size());
  b.entity = "body";
  b.shape = "box";
  b.half_extents = half;
  return b;
}

}  // namespace kairos::experiments
