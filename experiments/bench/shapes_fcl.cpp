#include "experiments/bench/shape_peers.hpp"

#ifdef KAIROS_PEER_FCL

#include "core/rotation_between.hpp"
#include "experiments/bench/fcl_motion.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/continuous_collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

namespace kairos::experiments {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

using Geometry = std::shared_ptr<const fcl::CollisionGeometryd>;

std::shared_ptr<fcl::CollisionGeometryd> convex(const Polytope& polytope) {
  auto faces = std::make_shared<std::vector<int>>();
  for (std::size_t f = 0; f < polytope.faces.size(); ++f) {
    const auto corners = polytope.faces[f];
    faces->push_back(static_cast<int>(corners.size()));
    faces->insert(faces->end(), corners.begin(), corners.end());
  }
  return std::make_shared<fcl::Convexd>(std::make_shared<const std::vector<fcl::Vector3d>>(
                                            polytope.vertices.begin(), polytope.vertices.end()),
                                        static_cast<int>(polytope.faces.size()), faces);
}

/// Its cylinders are about z.
Geometry geometry(const Shape& shape) {
  std::shared_ptr<fcl::CollisionGeometryd> made;
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    made = std::make_shared<fcl::Cylinderd>(cylinder->radius, cylinder->length);
  } else {
    made = convex(*std::get<Hull>(shape).core);
  }
  made->computeLocalAABB();  // bounds of motion read it
  return made;
}

fcl::Transform3d place(const Shape& shape, const Pose& pose) {
  fcl::Transform3d placed = transform(pose);
  if (std::holds_alternative<Cylinder>(shape)) {
    placed.rotate(rotation_between(Vector3::UnitZ(), Vector3::UnitY()));
  }
  return placed;
}

struct Geometries {
  std::vector<Geometry> a, b;
  explicit Geometries(const std::vector<ShapePair>& pairs) {
    for (const ShapePair& pair : pairs) {
      a.push_back(geometry(pair.a));
      b.push_back(geometry(pair.b));
    }
  }
};

Contest distances(const std::vector<ShapePair>& pairs) {
  return [&pairs, shapes = Geometries(pairs)](std::size_t first, std::size_t last,
                                              std::vector<double>& answers) {
    const fcl::DistanceRequestd request(true);
    for (std::size_t i = first; i < last; ++i) {
      fcl::DistanceResultd result;
      const double d =
          fcl::distance(shapes.a[i].get(), place(pairs[i].a, pairs[i].start_a), shapes.b[i].get(),
                        place(pairs[i].b, pairs[i].start_b), request, result);
      answers[i] = std::max(0.0, d);
    }
  };
}

Contest impacts(const std::vector<ShapePair>& pairs, double tolerance) {
  const fcl::ContinuousCollisionRequestd request = advancement_request(tolerance);
  return [&pairs, request, shapes = Geometries(pairs)](std::size_t first, std::size_t last,
                                                       std::vector<double>& answers) {
    for (std::size_t i = first; i < last; ++i) {
      const ShapePair& pair = pairs[i];
      const fcl::InterpMotion<double> motion_a =
          motion_between(place(pair.a, pair.start_a), place(pair.a, pair.end_a));
      const fcl::InterpMotion<double> motion_b =
          motion_between(place(pair.b, pair.start_b), place(pair.b, pair.end_b));
      fcl::ContinuousCollisionResultd result;
      fcl::continuousCollide(shapes.a[i].get(), &motion_a, shapes.b[i].get(), &motion_b, request,
                             result);
      answers[i] = result.is_collide ? result.time_of_contact : never;
    }
  };
}

using Model = fcl::BVHModel<fcl::OBBRSSd>;

std::shared_ptr<const Model> model(const MeshData& mesh) {
  const std::vector<fcl::Vector3d> vertices(mesh.vertices.begin(), mesh.vertices.end());
  std::vector<fcl::Triangle> triangles;
  for (const Triangle& t : mesh.triangles) {
    triangles.emplace_back(t[0], t[1], t[2]);
  }
  auto made = std::make_shared<Model>();
  made->beginModel();
  made->addSubModel(vertices, triangles);
  made->endModel();
  return made;
}

/// `most`: contacts to look for.
Contest contacts(const MeshPlacements& meshes, std::size_t most, bool count) {
  return [&meshes, most, count, a = model(meshes.a), b = model(meshes.b)](
             std::size_t first, std::size_t last, std::vector<double>& answers) {
    const fcl::CollisionRequestd request(most);
    for (std::size_t i = first; i < last; ++i) {
      fcl::CollisionResultd result;
      const std::size_t found = fcl::collide(a.get(), fcl::Transform3d::Identity(), b.get(),
                                             transform(meshes.poses[i]), request, result);
      answers[i] = count ? static_cast<double>(found) : found > 0 ? 0.0 : never;
    }
  };
}

Contest first_contact(const MeshPlacements& meshes) { return contacts(meshes, 1, false); }
Contest all_contacts(const MeshPlacements& meshes) {
  return contacts(meshes, std::size_t{1} << 24, true);
}

Contest mesh_distances(const MeshPlacements& meshes) {
  return [&meshes, a = model(meshes.a), b = model(meshes.b)](std::size_t first, std::size_t last,
                                                             std::vector<double>& answers) {
    const fcl::DistanceRequestd request(true);
    for (std::size_t i = first; i < last; ++i) {
      fcl::DistanceResultd result;
      answers[i] = std::max(0.0, fcl::distance(a.get(), fcl::Transform3d::Identity(), b.get(),
                                               transform(meshes.poses[i]), request, result));
    }
  };
}

}  // namespace

std::vector<ShapePeer> fcl_shape_peers() {
  return {{"FCL", distances, impacts, first_contact, all_contacts, mesh_distances}};
}

}  // namespace kairos::experiments

#else

namespace kairos::experiments {

std::vector<ShapePeer> fcl_shape_peers() { return {}; }

}  // namespace kairos::experiments

#endif
