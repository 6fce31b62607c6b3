#include "experiments/accuracy/random_query.hpp"

#include "core/rotation_between.hpp"

namespace kairos::reference {

Shape random_shape(Random& random, int kind, double size) {
  switch (kind) {
    case 0:
      return Sphere{size * random.uniform(0.2, 1.0)};
    case 1: {
      // One draw a statement: compilers differ in which argument they make first.
      const double z = size * random.uniform(0.1, 1.0);
      const double y = size * random.uniform(0.1, 1.0);
      const double x = size * random.uniform(0.1, 1.0);
      return box(x, y, z);
    }
    default:
      return HalfSpace{};
  }
}

void roughen(Random& random, Motion& motion, double size) {
  motion.position.resize(5);
  for (int k = 2; k <= 5; ++k) {
    motion.position[k] = random.vector(1.5 * size / k);
  }
  motion.velocity = motion.position.differentiated();
  motion.rotation = RotationKind::polynomial;
  motion.quaternion.resize(4);
  for (int k = 1; k <= 4; ++k) {
    for (int i = 0; i < 4; ++i) {
      motion.quaternion[k][i] = random.uniform(-0.5, 0.5) / k;
    }
  }
}

Query random_query(Difficulty difficulty, ShapeKinds kinds, std::uint64_t seed) {
  Random random(seed * 64 + static_cast<std::uint64_t>(difficulty) * 8 +
                static_cast<std::uint64_t>(kinds.a * 3 + kinds.b));
  const double size = difficulty == Difficulty::scaled ? random.log_uniform(1e-9, 1e9) : 1.0;
  const Vector3 offset =
      difficulty == Difficulty::far_away ? Vector3(1e6, -1e6, 5e5) : Vector3(Vector3::Zero());
  const double w = difficulty == Difficulty::straight   ? 0.0
                   : difficulty == Difficulty::spinning ? 60.0
                                                        : 3.0;
  const double size_a = difficulty == Difficulty::unequal ? random.log_uniform(1e-9, 1e-3) : size;
  Query q{random_shape(random, kinds.a, size_a), random_shape(random, kinds.b, size), {}, {}, 1.0};
  for (Shape* shape : {&q.a, &q.b}) {
    auto* thin = std::get_if<Box>(shape);
    if (thin != nullptr && difficulty == Difficulty::thin) {
      thin->half_extents[random.below(3)] *= 1e-6;
    }
  }
  const Vector3 away = random.direction();
  Pose at_a{offset + random.vector(0.5 * size), random.orientation()};
  Pose at_b{offset + size * random.uniform(2.0, 5.0) * away, random.orientation()};
  Twist twist_a{random.vector(3.0 * size), random.vector(w)};
  const Vector3 approach = random.uniform(0.0, 4.0) * size * away;
  Twist twist_b{random.vector(2.0 * size) - approach, random.vector(w)};
  if (kinds.b == 2) {
    at_b.orientation = rotation_between(Vector3::UnitY(), -away);
    at_b.position = offset + random.uniform(1.5, 3.0) * size * away;
    if (difficulty != Difficulty::all_turning) {
      twist_b.angular.setZero();
    }
  }
  q.motion_a = Motion::ballistic({}, 1.0, at_a, twist_a, random.vector(3.0 * size));
  q.motion_b = Motion::ballistic({}, 1.0, at_b, twist_b, random.vector(3.0 * size));
  if (difficulty == Difficulty::polynomial) {
    roughen(random, q.motion_a, size);
    roughen(random, q.motion_b, size);
  }
  return q;
}

}  // namespace kairos::reference
