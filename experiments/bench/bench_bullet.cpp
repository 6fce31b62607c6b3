#include "experiments/bench/bench_peers.hpp"

#ifdef KAIROS_PEER_BULLET

#include "experiments/bench/bullet_types.hpp"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/NarrowPhaseCollision/btContinuousConvexCollision.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <limits>

namespace kairos::experiments {
namespace {

Contest impacts(const std::vector<BoxPair>& pairs, double /*tolerance*/) {
  return [&pairs](std::size_t first, std::size_t last, std::vector<double>& answers) {
    btVoronoiSimplexSolver simplex;
    btGjkEpaPenetrationDepthSolver penetration;
    for (std::size_t i = first; i < last; ++i) {
      const BoxPair& pair = pairs[i];
      btBoxShape a(vector(pair.a.half_extents));
      btBoxShape b(vector(pair.b.half_extents));
      a.setMargin(0);  // rounded corners would be late
      b.setMargin(0);
      btContinuousConvexCollision query(&a, &b, &simplex, &penetration);
      btConvexCast::CastResult result;
      answers[i] = query.calcTimeOfImpact(transform(pair.start_a), transform(pair.end_a),
                                          transform(pair.start_b), transform(pair.end_b), result)
                       ? static_cast<double>(result.m_fraction)
                       : std::numeric_limits<double>::infinity();
    }
  };
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
