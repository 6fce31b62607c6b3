#include "experiments/bench/shape_pairs.hpp"

#include "core/mesh_shapes.hpp"
#include "core/random.hpp"

namespace kairos::experiments {
namespace {

constexpr std::uint64_t seed = 20261123;

Pose moved(const Pose& start, const Twist& twist) {
  return {start.position + twist.linear, kairos::rotate(twist.angular, start.orientation)};
}

/// Shapes of about 1 m that fly past or into each other within 1 s, turning by up to 0.7 rad each.
template <typename Draw>
std::vector<ShapePair> pairs_of(std::size_t count, std::uint64_t stream, const Draw& draw) {
  std::vector<ShapePair> pairs(count);
  for (std::size_t i = 0; i < count; ++i) {
    Random random(seed, (stream << 32U) + i);
    const auto spin = [&random] {
      const double rate = 0.7 * random.uniform();
      return Vector3(rate * random.direction());
    };
    ShapePair& pair = pairs[i];
    pair.a = draw(random);
    pair.b = draw(random);
    pair.start_a = {Vector3::Zero(), random.orientation()};
    const double distance = random.uniform(2.0, 4.0);
    pair.start_b.position = distance * random.direction();
    pair.start_b.orientation = random.orientation();
    pair.twist_a = {Vector3::Zero(), spin()};
    const Vector3 velocity = -1.5 * pair.start_b.position + 2.0 * random.direction();
    pair.twist_b = {velocity, spin()};
    pair.end_a = moved(pair.start_a, pair.twist_a);
    pair.end_b = moved(pair.start_b, pair.twist_b);
  }
  return pairs;
}

}  // namespace

Hull random_hull(std::uint64_t number) {
  constexpr int corners = 30;
  Random random(seed, (std::uint64_t{1} << 32U) + number);
  const auto size = [&random] { return random.uniform(0.4, 1.0); };
  const double x = size();
  const double y = size();
  const Vector3 half(x, y, size());
  std::vector<Vector3> points;
  for (int k = 0; k < corners; ++k) {  // on an ellipsoid: all of them are corners
    points.push_back(random.direction().cwiseProduct(half));
  }
  return {convex_hull(points).polytope};
}

std::vector<ShapePair> random_hull_pairs(std::size_t count) {
  constexpr std::uint64_t kinds = 256;
  std::vector<Shape> hulls;
  for (std::uint64_t k = 0; k < kinds; ++k) {
    hulls.emplace_back(random_hull(k));
  }
  return pairs_of(count, 2, [&hulls](Random& random) { return hulls[random.below(kinds)]; });
}

std::vector<ShapePair> random_cylinder_pairs(std::size_t count) {
  return pairs_of(count, 3, [](Random& random) {
    const double radius = random.uniform(0.2, 0.8);
    return Shape(Cylinder{radius, random.uniform(0.4, 1.6)});
  });
}

MeshPlacements torus_placements(std::size_t count) {
  MeshPlacements tori{torus_mesh(1.0, 0.25, 18, 37), torus_mesh(1.0, 0.25, 30, 54), {}};
  Random random(seed, 4);
  for (std::size_t i = 0; i < count; ++i) {
    const double distance = random.uniform(0.5, 3.0);
    const Vector3 position = distance * random.direction();
    tori.poses.push_back({position, random.orientation()});
  }
  return tori;
}

std::vector<MotionPair> random_flights(std::size_t count) {
  std::vector<MotionPair> pairs;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(seed, (std::uint64_t{5} << 32U) + i);
    const Vector3 away = random.uniform(2.5, 4.0) * random.direction();
    const auto fly = [&](const Vector3& from, const Vector3& velocity) {
      const Quaternion turned = random.orientation();
      const Vector3 spin = random.uniform(0.0, 0.7) * random.direction();
      return Motion::ballistic({}, 1.0, {from, turned}, {velocity, spin}, Vector3::Zero());
    };
    Motion first = fly(Vector3::Zero(), Vector3::Zero());
    Motion second = fly(away, -1.5 * away + random.direction());
    pairs.push_back({std::move(first), std::move(second)});
  }
  return pairs;
}

DriftingHulls::DriftingHulls(std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    Random random(seed, (std::uint64_t{6} << 32U) + i);
    shapes.emplace_back(random_hull(i % 64));
    const double x = random.uniform(0.0, 20.0);
    const double y = random.uniform(0.0, 20.0);
    poses.push_back({{x, y, random.uniform(0.0, 20.0)}, random.orientation()});
    const Vector3 velocity = 0.01 * random.direction();
    twists.push_back({velocity, 0.01 * random.direction()});
  }
}

void DriftingHulls::drift() {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i] = {poses[i].position + twists[i].linear,
                kairos::rotate(twists[i].angular, poses[i].orientation).normalized()};
  }
}

}  // namespace kairos::experiments
