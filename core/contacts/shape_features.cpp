// What of a shape may touch something, wherever that is.
#include "core/contacts/shape_features.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

using Kind = TouchFeature::Kind;

Corners box_corners(const Box& box) {
  Corners c;
  for (std::size_t k = 0; k < 8; ++k) {
    c.vertices.emplace_back(
        Vector3((k & 1U) != 0 ? 1.0 : -1.0, (k & 2U) != 0 ? 1.0 : -1.0, (k & 4U) != 0 ? 1.0 : -1.0)
            .cwiseProduct(box.half_extents));
    for (const std::size_t bit : {1U, 2U, 4U}) {
      if ((k & bit) == 0) {
        c.edges.push_back({k, k | bit});
      }
    }
  }
  c.size = box.half_extents.norm();
  return c;
}

Corners hull_corners(const Hull& hull) {
  Corners c;
  c.vertices = hull.core->vertices;
  for (const auto& edge : hull.core->edges) {
    c.edges.push_back({edge[0], edge[1]});
  }
  c.rounding = hull.rounding;
  c.size = hull.core->radius;
  return c;
}

}  // namespace

std::optional<Corners> polytope_corners(const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) {
    return box_corners(*box);
  }
  if (const auto* hull = std::get_if<Hull>(&shape)) {
    return hull_corners(*hull);
  }
  return std::nullopt;
}

std::optional<double> radius_of_side(const Shape& shape) {
  if (const auto* capsule = std::get_if<Capsule>(&shape); capsule && capsule->length > 0.0) {
    return capsule->radius;
  }
  const auto* cylinder = std::get_if<Cylinder>(&shape);
  return cylinder != nullptr ? std::optional(cylinder->radius) : std::nullopt;
}

std::vector<TouchFeature> rims_of_shape(const Shape& shape) {
  std::vector<TouchFeature> rims;
  const auto add = [&](double y, double radius) {
    rims.push_back({Kind::rim, y * Vector3::UnitY(), Vector3::UnitY(), radius});
  };
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    add(-0.5 * cylinder->length, cylinder->radius);
    add(0.5 * cylinder->length, cylinder->radius);
  } else if (const auto* cone = std::get_if<Cone>(&shape)) {
    add(-0.25 * cone->height, cone->radius);
  }
  return rims;
}

TouchFeature disc_of(const TouchFeature& rim) {
  return {Kind::plane, rim.at, std::copysign(1.0, rim.at.y()) * Vector3::UnitY(), 0.0};
}

std::optional<std::vector<TouchFeature>> corners_of(const Shape& shape) {
  std::vector<TouchFeature> corners;
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    corners.push_back({Kind::ball, Vector3::Zero(), Vector3::Zero(), sphere->radius});
  } else if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    for (const double end : {-0.5, 0.5}) {
      corners.push_back(
          {Kind::ball, Vector3::UnitY() * end * capsule->length, Vector3::Zero(), capsule->radius});
    }
  } else if (const auto c = polytope_corners(shape)) {
    for (const Vector3& vertex : c->vertices) {
      corners.push_back({Kind::ball, vertex, Vector3::Zero(), c->rounding});
    }
  } else if (!std::holds_alternative<HalfSpace>(shape)) {
    return std::nullopt;
  }
  return corners;
}

std::optional<std::vector<TouchFeature>> extremes_of(const Shape& shape) {
  std::vector<TouchFeature> rims = rims_of_shape(shape);
  if (rims.empty()) {
    return corners_of(shape);
  }
  if (const auto* cone = std::get_if<Cone>(&shape)) {
    rims.push_back({Kind::ball, 0.75 * cone->height * Vector3::UnitY(), Vector3::Zero(), 0.0});
  }
  return rims;
}

double height_over(const TouchFeature& extreme, const Vector3& at, const Vector3& axis,
                   const Vector3& n, const Vector3& q) {
  const double middle = n.dot(at - q);
  return middle - (extreme.kind == Kind::rim ? extreme.radius * (n - axis * axis.dot(n)).norm()
                                             : extreme.radius);
}

std::vector<TouchFeature> faces_of(const Shape& shape) {
  std::vector<TouchFeature> faces;
  for (const TouchFeature& rim : rims_of_shape(shape)) {
    faces.push_back(disc_of(rim));
  }
  if (const auto* box = std::get_if<Box>(&shape)) {
    for (int k = 0; k < 3; ++k) {
      for (const double side : {-1.0, 1.0}) {
        const Vector3 out = side * Vector3::Unit(k);
        faces.push_back({Kind::plane, out * box->half_extents[k], out, 0.0});
      }
    }
  } else if (const auto* hull = std::get_if<Hull>(&shape);
             hull != nullptr && !(hull->rounding > 0.0)) {
    const Polytope& p = *hull->core;
    for (std::size_t f = 0; f < p.faces.size(); ++f) {
      faces.push_back({Kind::plane, p.vertices[p.faces[f][0]], p.normals[f], 0.0});
    }
  }
  return faces;
}

std::vector<TouchFeature> edges_of(const Shape& shape) {
  std::vector<TouchFeature> edges;
  if (const auto radius = radius_of_side(shape)) {
    edges.push_back({Kind::line, Vector3::Zero(), Vector3::UnitY(), *radius});
  }
  if (const auto c = polytope_corners(shape); c && !(c->rounding > 0.0)) {
    for (const auto& [i, j] : c->edges) {
      const Vector3& at = c->vertices[i];
      edges.push_back({Kind::line, at, (c->vertices[j] - at).normalized(), 0.0});
    }
  }
  return edges;
}

TouchFeature face_feature(const Shape& shape, const Vector3& x, const Vector3& outward) {
  TouchFeature face{Kind::plane, x, outward, 0.0};
  if (std::holds_alternative<Box>(shape)) {
    Eigen::Index axis = 0;
    outward.cwiseAbs().maxCoeff(&axis);
    face.direction = (outward[axis] < 0.0 ? -1.0 : 1.0) * Vector3::Unit(axis);
  } else if (const auto* hull = std::get_if<Hull>(&shape)) {
    double nearest = -1.0;
    for (const Vector3& n : hull->core->normals) {
      if (n.dot(outward) > nearest) {
        nearest = n.dot(outward);
        face.direction = n;
      }
    }
  }
  for (const TouchFeature& rim : rims_of_shape(shape)) {
    if (rim.at.y() * outward.y() > 0.0) {
      return disc_of(rim);
    }
  }
  if (const auto c = polytope_corners(shape)) {
    double support = -std::numeric_limits<double>::infinity();
    for (const Vector3& vertex : c->vertices) {
      support = std::max(support, face.direction.dot(vertex));
    }
    face.at += face.direction * (support + c->rounding - face.direction.dot(x));
  }
  return face;
}

}  // namespace core
}  // namespace kairos
