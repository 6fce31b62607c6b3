#include "experiments/bench/bench_peers.hpp"

#ifdef KAIROS_PEER_FCL

#include "experiments/bench/fcl_motion.hpp"

#include <fcl/geometry/shape/box.h>
#include <fcl/math/bv/OBB.h>
#include <fcl/narrowphase/continuous_collision.h>

#include <limits>
#include <utility>

namespace kairos::experiments {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

Contest overlaps(const std::vector<BoxPair>& pairs) {
  const auto box = [](const Box& shape, const Pose& pose) {
    return fcl::OBBd(pose.orientation.toRotationMatrix(), pose.position, shape.half_extents);
  };
  std::vector<std::pair<fcl::OBBd, fcl::OBBd>> boxes;
  boxes.reserve(pairs.size());
  for (const BoxPair& pair : pairs) {
    boxes.emplace_back(box(pair.a, pair.start_a), box(pair.b, pair.start_b));
  }
  return [boxes = std::move(boxes)](std::size_t first, std::size_t last,
                                    std::vector<double>& answers) {
    for (std::size_t i = first; i < last; ++i) {
      answers[i] = boxes[i].first.overlap(boxes[i].second) ? 0.0 : never;
    }
  };
}

Contest impacts(const std::vector<BoxPair>& pairs, double tolerance) {
  const fcl::ContinuousCollisionRequestd request = advancement_request(tolerance);
  return [&pairs, request](std::size_t first, std::size_t last, std::vector<double>& answers) {
    const auto box = [](const Box& shape) {
      fcl::Boxd full(fcl::Vector3d(2.0 * shape.half_extents));
      full.computeLocalAABB();  // its bounds of motion read it
      return full;
    };
    for (std::size_t i = first; i < last; ++i) {
      const BoxPair& pair = pairs[i];
      const fcl::Boxd a = box(pair.a);
      const fcl::Boxd b = box(pair.b);
      fcl::ContinuousCollisionResultd result;
      const fcl::InterpMotion<double> motion_a =
          motion_between(transform(pair.start_a), transform(pair.end_a));
      const fcl::InterpMotion<double> motion_b =
          motion_between(transform(pair.start_b), transform(pair.end_b));
      fcl::continuousCollide(&a, &motion_a, &b, &motion_b, request, result);
      answers[i] = result.is_collide ? result.time_of_contact : never;
    }
  };
}

}  // namespace

std::vector<PeerQuery> fcl_peers() {
  return {{"FCL: OBB::overlap", overlaps, {}},
          {"FCL: conservative advancement, libccd", {}, impacts}};
}

}  // namespace kairos::experiments

#else

namespace kairos::experiments {

std::vector<PeerQuery> fcl_peers() { return {}; }

}  // namespace kairos::experiments

#endif
