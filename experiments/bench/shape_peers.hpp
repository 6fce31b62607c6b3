#pragma once

#include "core/mesh_data.hpp"
#include "experiments/bench/bench_peers.hpp"
#include "experiments/bench/chunk_race.hpp"

#include <functional>
#include <string>
#include <vector>

namespace kairos::experiments {

/// Two shapes and how they move in a window of 1 s, with the poses at its end that others want.
struct ShapePair {
  Shape a, b;
  Pose start_a, start_b;
  Pose end_a, end_b;
  Twist twist_a, twist_b;
};

/// Two meshes, the second in many placements against the first.
struct MeshPlacements {
  MeshData a, b;
  std::vector<Pose> poses;
};

/// What others answer about hulls, cylinders and meshes: libraries that were found when kairos was
/// built, as in `PeerQuery`. A function is empty where the library has no such query.
struct ShapePeer {
  std::string name;
  /// At the start, m; 0: they overlap.
  std::function<Contest(const std::vector<ShapePair>&)> distances;
  /// `tolerance`: of the time, as a fraction of the window.
  std::function<Contest(const std::vector<ShapePair>&, double tolerance)> impacts;
  /// 0: they touch; infinity: they do not.
  std::function<Contest(const MeshPlacements&)> first_contact;
  /// How many pairs of triangles touch.
  std::function<Contest(const MeshPlacements&)> all_contacts;
  /// m; 0: they touch.
  std::function<Contest(const MeshPlacements&)> mesh_distances;
};

/// FCL, if it was found.
[[nodiscard]] std::vector<ShapePeer> fcl_shape_peers();
/// Bullet, if it was found.
[[nodiscard]] std::vector<ShapePeer> bullet_shape_peers();

/// Our racer and those peers that have such a query.
template <typename Subject, typename... More>
std::vector<Racer> beside_peers(const Racer& ours,
                                std::function<Contest(const Subject&, More...)> ShapePeer::*query,
                                const Subject& subject, More... more) {
  std::vector<Racer> racers{ours};
  for (const auto& peers : {fcl_shape_peers(), bullet_shape_peers()}) {
    for (const ShapePeer& peer : peers) {
      if (peer.*query) {
        racers.push_back({peer.name, (peer.*query)(subject, more...)});
      }
    }
  }
  return racers;
}

}  // namespace kairos::experiments
