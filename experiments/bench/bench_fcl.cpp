#include "experiments/bench/bench_peers.hpp"

#ifdef KAIROS_PEER_FCL

#include <fcl/geometry/shape/box.h>
#include <fcl/math/bv/OBB.h>
#include <fcl/math/motion/interp_motion.h>
#include <fcl/narrowphase/continuous_collision.h>
#include <fcl/narrowphase/continuous_collision_request.h>

#include <memory>

namespace kairos::experiments {
namespace {

fcl::Transform3d transform(const Pose& pose) {
  fcl::Transform3d t = fcl::Transform3d::Identity();
  t.linear() = pose.orientation.toRotationMatrix();
  t.translation() = pose.position;
  return t;
}

std::int64_t overlaps(const std::vector<BenchPair>& pairs) {
  std::int64_t count = 0;
  for (const BenchPair& pair : pairs) {
    const auto box = [](const Shape& shape, const Motion& motion) {
      const Pose pose = motion.pose(0.0);
      return fcl::OBBd(pose.orientation.toRotationMatrix(), pose.position,
                       std::get<Box>(shape).half_extents);
    };
    count += box(pair.a, pair.motion_a).overlap(box(pair.b, pair.motion_b)) ? 1 : 0;
  }
  return count;
}

/// FCL's conservative advancement, its poses at both ends of the window.
std::int64_t impacts(const std::vector<BenchPair>& pairs) {
  std::int64_t count = 0;
  fcl::ContinuousCollisionRequestd request;
  request.ccd_motion_type = fcl::CCDM_LINEAR;
  request.ccd_solver_type = fcl::CCDC_CONSERVATIVE_ADVANCEMENT;
  request.gjk_solver_type = fcl::GST_LIBCCD;
  for (const BenchPair& pair : pairs) {
    const auto box = [](const Shape& shape) {
      const Vector3 full = 2.0 * std::get<Box>(shape).half_extents;
      return std::make_shared<fcl::Boxd>(full.x(), full.y(), full.z());
    };
    const fcl::CollisionObjectd a(box(pair.a), transform(pair.motion_a.pose(0.0)));
    const fcl::CollisionObjectd b(box(pair.b), transform(pair.motion_b.pose(0.0)));
    fcl::ContinuousCollisionResultd result;
    fcl::continuousCollide(&a, transform(pair.motion_a.pose(1.0)), &b,
                           transform(pair.motion_b.pose(1.0)), request, result);
    count += result.is_collide ? 1 : 0;
  }
  return count;
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
