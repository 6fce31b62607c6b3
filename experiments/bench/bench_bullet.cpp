#include "experiments/bench/bench_peers.hpp"

#ifdef KAIROS_PEER_BULLET

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/NarrowPhaseCollision/btContinuousConvexCollision.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

namespace kairos::experiments {
namespace {

btVector3 vector(const Vector3& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

btTransform transform(const Pose& pose) {
  const Quaternion& q = pose.orientation;
  return btTransform(btQuaternion(static_cast<btScalar>(q.x()), static_cast<btScalar>(q.y()),
                                  static_cast<btScalar>(q.z()), static_cast<btScalar>(q.w())),
                     vector(pose.position));
}

std::int64_t impacts(const std::vector<BenchPair>& pairs) {
  std::int64_t count = 0;
  btVoronoiSimplexSolver simplex;
  btGjkEpaPenetrationDepthSolver penetration;
  for (const BenchPair& pair : pairs) {
    const btBoxShape a(vector(std::get<Box>(pair.a).half_extents));
    const btBoxShape b(vector(std::get<Box>(pair.b).half_extents));
    btContinuousConvexCollision query(&a, &b, &simplex, &penetration);
    btConvexCast::CastResult result;
    count += query.calcTimeOfImpact(
                 transform(pair.motion_a.pose(0.0)), transform(pair.motion_a.pose(1.0)),
                 transform(pair.motion_b.pose(0.0)), transform(pair.motion_b.pose(1.0)), result)
                 ? 1
                 : 0;
  }
  return count;
}

}  // namespace

std::vector<PeerQuery> bullet_peers() {
  return {{"Bullet: ContinuousConvexCollision", {}, impacts}};
}

}  // namespace kairos::experiments

#else

namespace kairos::experiments {

std::vector<PeerQuery> bullet_peers() { return {}; }

}  // namespace kairos::experiments

#endif
