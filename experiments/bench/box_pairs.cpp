#include "core/random.hpp"
#include "experiments/bench/bench_peers.hpp"

namespace kairos::experiments {

std::vector<BoxPair> random_box_pairs(std::size_t count, double spread, double turn) {
  constexpr std::uint64_t seed = 20260108;
  std::vector<BoxPair> pairs(count);
  for (std::size_t i = 0; i < count; ++i) {
    Random random(seed, i);
    const auto box = [&random] {
      const double x = random.uniform(0.2, 1.0);
      const double y = random.uniform(0.2, 1.0);
      return Box{{x, y, random.uniform(0.2, 1.0)}};
    };
    const auto spin = [&] {
      const double rate = turn * random.uniform();
      return Vector3(rate * random.direction());
    };
    BoxPair& pair = pairs[i];
    pair.a = box();
    pair.b = box();
    pair.start_a = {Vector3::Zero(), random.orientation()};
    const double distance = spread * random.uniform(0.6, 1.4);
    pair.start_b.position = distance * random.direction();
    pair.start_b.orientation = random.orientation();
    pair.twist_a = {Vector3::Zero(), spin()};
    // Towards the first, or beside it.
    const Vector3 velocity = -1.5 * pair.start_b.position + 2.0 * random.direction();
    pair.twist_b = {velocity, spin()};
    const auto end = [](const Pose& start, const Twist& twist) {
      return Pose{start.position + twist.linear, kairos::rotate(twist.angular, start.orientation)};
    };
    pair.end_a = end(pair.start_a, pair.twist_a);
    pair.end_b = end(pair.start_b, pair.twist_b);
  }
  return pairs;
}

}  // namespace kairos::experiments
