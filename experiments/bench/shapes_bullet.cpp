#include "experiments/bench/shape_peers.hpp"

#ifdef KAIROS_PEER_BULLET

#include "experiments/bench/bullet_types.hpp"

#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/NarrowPhaseCollision/btContinuousConvexCollision.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

namespace kairos::experiments {
namespace {

/// Its cylinders are about y, as ours are.
std::shared_ptr<btConvexShape> convex(const Shape& shape) {
  std::shared_ptr<btConvexShape> made;
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    made = std::make_shared<btCylinderShape>(
        vector({cylinder->radius, 0.5 * cylinder->length, cylinder->radius}));
  } else {
    auto hull = std::make_shared<btConvexHullShape>();
    for (const Vector3& v : std::get<Hull>(shape).core->vertices) {
      hull->addPoint(vector(v), false);
    }
    hull->recalcLocalAabb();
    made = std::move(hull);
  }
  made->setMargin(0);  // rounded corners would be late
  return made;
}

struct Shapes {
  std::vector<std::shared_ptr<btConvexShape>> a, b;
  explicit Shapes(const std::vector<ShapePair>& pairs) {
    for (const ShapePair& pair : pairs) {
      a.push_back(convex(pair.a));
      b.push_back(convex(pair.b));
    }
  }
};

Contest distances(const std::vector<ShapePair>& pairs) {
  return [&pairs, shapes = Shapes(pairs)](std::size_t first, std::size_t last,
                                          std::vector<double>& answers) {
    btVoronoiSimplexSolver simplex;
    btGjkEpaPenetrationDepthSolver penetration;
    for (std::size_t i = first; i < last; ++i) {
      btGjkPairDetector query(shapes.a[i].get(), shapes.b[i].get(), &simplex, &penetration);
      btGjkPairDetector::ClosestPointInput input;
      input.m_transformA = transform(pairs[i].start_a);
      input.m_transformB = transform(pairs[i].start_b);
      btPointCollector found;
      query.getClosestPoints(input, found, nullptr);
      answers[i] = found.m_hasResult ? std::max(0.0, static_cast<double>(found.m_distance)) : 0.0;
    }
  };
}

Contest impacts(const std::vector<ShapePair>& pairs, double /*tolerance*/) {
  return [&pairs, shapes = Shapes(pairs)](std::size_t first, std::size_t last,
                                          std::vector<double>& answers) {
    btVoronoiSimplexSolver simplex;
    btGjkEpaPenetrationDepthSolver penetration;
    for (std::size_t i = first; i < last; ++i) {
      const ShapePair& pair = pairs[i];
      btContinuousConvexCollision query(shapes.a[i].get(), shapes.b[i].get(), &simplex,
                                        &penetration);
      btConvexCast::CastResult result;
      answers[i] = query.calcTimeOfImpact(transform(pair.start_a), transform(pair.end_a),
                                          transform(pair.start_b), transform(pair.end_b), result)
                       ? static_cast<double>(result.m_fraction)
                       : std::numeric_limits<double>::infinity();
    }
  };
}

}  // namespace

std::vector<ShapePeer> bullet_shape_peers() { return {{"Bullet", distances, impacts, {}, {}, {}}}; }

}  // namespace kairos::experiments

#else

namespace kairos::experiments {

std::vector<ShapePeer> bullet_shape_peers() { return {}; }

}  // namespace kairos::experiments

#endif
