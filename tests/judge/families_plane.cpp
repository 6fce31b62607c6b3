#include "tests/judge/families.hpp"

#include <cmath>

namespace kairos::judge {
namespace {

Body round_or_square(Random& random) {
  return random.below(2) == 0 ? random_sphere(random) : random_box(random);
}

Query plane_static(Random& random) {
  Approach approach{.closing = random.log_uniform(1e-6, 100.0),
                    .sliding = random.log_uniform(1e-3, 1e3)};
  approach.spin_b = random.below(2) == 0 ? 0.0 : random.log_uniform(1e-3, 30.0);
  const double duration = random.log_uniform(0.01, 100.0);
  return set_moving(random, on_plane(random, random_plane(random), round_or_square(random)),
                    approach, random.uniform() * duration, duration);
}

Query plane_accelerated(Random& random) {
  Approach approach{.closing = random.uniform(-1.0, 1.0) * 10.0,
                    .sliding = random.uniform(0.0, 10.0)};
  approach.pull = random.uniform(-10.0, 10.0);
  approach.spin_b = random.below(2) == 0 ? 0.0 : random.log_uniform(1e-3, 10.0);
  const double duration = random.log_uniform(0.1, 100.0);
  Query q =
      set_moving(random, on_plane(random, random_plane(random), round_or_square(random)), approach,
                 random.below(3) == 0 ? 0.0 : random.uniform() * duration, duration);
  if (random.below(2) == 0) {
    q.a.acceleration = random.direction() * random.uniform(0.0, 1.0);
  }
  return q;
}

Query plane_turning(Random& random) {
  Approach approach{.closing = random.log_uniform(1e-4, 10.0), .sliding = random.uniform(0.0, 2.0)};
  approach.spin_a = random.log_uniform(1e-10, 3.0);
  approach.spin_b = random.below(2) == 0 ? 0.0 : random.log_uniform(1e-3, 10.0);
  approach.pull = random.below(2) == 0 ? 0.0 : random.uniform(-5.0, 5.0);
  approach.a_moves = random.below(2) == 0;
  const double duration = random.log_uniform(0.1, 10.0);
  return set_moving(random, on_plane(random, random_plane(random), round_or_square(random)),
                    approach, random.below(3) == 0 ? 0.0 : random.uniform() * duration, duration);
}

/// Along the plane for hours: what rounding makes of a tilted normal.
Query plane_long(Random& random) {
  const double duration = random.log_uniform(1e3, 1e6);
  Approach approach{.closing = 0.0, .sliding = random.log_uniform(1.0, 1e3)};
  switch (random.below(4)) {
    case 0:
      approach.sliding = 0.0;
      approach.closing = -random.log_uniform(1e-6, 10.0);
      approach.pull = -random.log_uniform(1e-6, 10.0);
      break;
    case 1:
      approach.closing = random.log_uniform(1e-12, 1.0);
      break;
    case 2:
      approach.closing = -random.log_uniform(1e-12, 1e-3);
      break;
    default:
      break;
  }
  const double time = random.below(2) == 0 ? 0.0 : random.uniform() * duration;
  Query q = set_moving(random, on_plane(random, random_plane(random), round_or_square(random)),
                       approach, time, duration);
  if (random.below(8) == 0) {
    q.a.spin = random.direction() * random.log_uniform(1e-16, 1e-10);
  }
  return q;
}

/// A plane tilted by next to nothing, which may be taken for none.
Query plane_tilt(Random& random) {
  Body plane;
  plane.kind = Kind::half_space;
  plane.orientation =
      rotate(random.direction() * random.log_uniform(1e-12, 1e-4), Quaternion::Identity())
          .normalized();
  Approach approach{.closing = random.log_uniform(1e-9, 1.0),
                    .sliding = random.log_uniform(1.0, 1e4)};
  const double duration = random.log_uniform(1.0, 1e4);
  return set_moving(random, on_plane(random, plane, round_or_square(random)), approach,
                    random.uniform() * duration, duration);
}

Query balls(Random& random) {
  Approach approach{.closing = random.log_uniform(1e-9, 100.0),
                    .sliding = random.log_uniform(1e-3, 100.0)};
  if (random.below(3) == 0) {
    approach.closing = 0.0;
    approach.gap = random.log_uniform(1e-16, 1e-3) * (random.below(2) == 0 ? 1.0 : -1.0);
  }
  approach.pull = random.below(2) == 0 ? 0.0 : random.uniform(-10.0, 10.0);
  approach.drift = random.below(2) == 0 ? 0.0 : random.log_uniform(1.0, 1e4);
  const double duration = random.log_uniform(0.01, 1e3);
  return set_moving(random, on_ball(random, random_sphere(random), random_sphere(random)), approach,
                    random.below(3) == 0 ? 0.0 : random.uniform() * duration, duration);
}

Query ball_and_box(Random& random) {
  Approach approach{.closing = random.log_uniform(1e-6, 10.0),
                    .sliding = random.uniform(0.0, 10.0)};
  if (random.below(3) == 0) {
    approach.closing = 0.0;
    approach.gap = random.log_uniform(1e-16, 1e-3) * (random.below(2) == 0 ? 1.0 : -1.0);
    approach.pull = random.uniform(0.0, 20.0);
  }
  approach.spin_a = random.below(2) == 0 ? 0.0 : random.log_uniform(1e-3, 10.0);
  const double duration = random.log_uniform(0.01, 10.0);
  return set_moving(random, on_ball(random, random_box(random), random_sphere(random)), approach,
                    random.below(3) == 0 ? 0.0 : random.uniform() * duration, duration);
}

constexpr Family families[] = {
    {"plane", "onto a tilted half-space", plane_static},
    {"plane-accelerated", "a tilted half-space and accelerations", plane_accelerated},
    {"plane-turning", "a half-space that turns, by 1e-10 to 3 rad/s", plane_turning},
    {"plane-long", "along a tilted half-space for 1e3 to 1e6 s", plane_long},
    {"plane-tilt", "a half-space tilted by 1e-12 to 1e-4", plane_tilt},
    {"balls", "two balls", balls},
    {"ball-box", "a ball on face, edge and vertex of a box", ball_and_box},
};

}  // namespace

std::span<const Family> plane_families() { return families; }

}  // namespace kairos::judge
