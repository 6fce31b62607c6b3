#pragma once

#include "experiments/bench/shape_peers.hpp"

#include <cstdint>
#include <vector>

namespace kairos::experiments {

// What `bench shapes` asks about; functions of their arguments alone.

/// Thirty corners on an ellipsoid with half axes of 0.4 to 1 m.
[[nodiscard]] Hull random_hull(std::uint64_t number);
/// Hulls that fly past or into each other within 1 s, turning by up to 0.7 rad each; apart at the
/// start.
[[nodiscard]] std::vector<ShapePair> random_hull_pairs(std::size_t count);
/// Cylinders that do, some of which overlap at the start.
[[nodiscard]] std::vector<ShapePair> random_cylinder_pairs(std::size_t count);
/// Tori of 1,332 and 3,240 triangles.
[[nodiscard]] MeshPlacements torus_placements(std::size_t count);

/// How two bodies of about 1 m move within 1 s.
struct MotionPair {
  Motion a, b;
};
/// Bodies that turn by up to 0.7 rad, the second flying at the first from 2.5 to 4 m away.
[[nodiscard]] std::vector<MotionPair> random_flights(std::size_t count);

/// Hulls in a box of 20 m, each moving and turning by 1 % of its size a frame.
struct DriftingHulls {
  explicit DriftingHulls(std::size_t count);
  void drift();  ///< to the next frame

  std::vector<Shape> shapes;
  std::vector<Pose> poses;
  std::vector<Twist> twists;  ///< per frame
};

}  // namespace kairos::experiments
