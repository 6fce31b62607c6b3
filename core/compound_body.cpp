#include "core/compound_body.hpp"

#include "core/mass_properties.hpp"
#include "core/solid_size.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

void check(const std::vector<CompoundPart>& parts) {
  if (parts.empty()) {
    throw std::invalid_argument("a compound needs a part");
  }
  const int last = shape_rank(Hull{});
  for (const CompoundPart& part : parts) {
    if (shape_rank(part.shape) > last) {
      throw std::invalid_argument("a part of a compound must be convex and bounded");
    }
  }
}

struct Weighed {
  double volume = 0.0;
  Vector3 centre = Vector3::Zero();
  Matrix3 inertia = Matrix3::Zero();  ///< about the centre
};

/// Steiner's theorem over the parts, density 1.
Weighed weigh(const std::vector<CompoundPart>& parts) {
  Weighed sum;
  for (const CompoundPart& part : parts) {
    const double volume = solid_volume(part.shape);
    sum.volume += volume;
    sum.centre += volume * part.pose.position;
  }
  sum.centre /= sum.volume;
  for (const CompoundPart& part : parts) {
    const double volume = solid_volume(part.shape);
    const Vector3 r = part.pose.position - sum.centre;
    const Vector3 own = solid_inertia(part.shape, volume);
    const Matrix3 R = (part.pose.orientation * solid_axes(part.shape)).toRotationMatrix();
    sum.inertia += R * own.asDiagonal() * R.transpose() +
                   volume * (r.squaredNorm() * Matrix3::Identity() - r * r.transpose());
  }
  return sum;
}

void add_sizes(CompoundBody& body) {
  constexpr double u = 0.5 * std::numeric_limits<double>::epsilon();
  body.width = std::numeric_limits<double>::infinity();
  for (const CompoundPart& part : body.parts) {
    const Matrix3 R = part.pose.orientation.toRotationMatrix();
    const Vector3& p = part.pose.position;
    const Vector3 half = p.cwiseAbs() + R.cwiseAbs() * bounding_box(part.shape).half_extents;
    body.half_extents = body.half_extents.cwiseMax(Vector3(half * (1.0 + 32.0 * u)));
    body.radius =
        std::max(body.radius, (p.norm() + bounding_radius(part.shape)) * (1.0 + 16.0 * u));
    body.width = std::min(body.width, smallest_extent(part.shape));
  }
}

}  // namespace

PlacedCompound compound_body(std::vector<CompoundPart> parts) {
  check(parts);
  PlacedCompound placed;
  placed.centre = weigh(parts).centre;
  for (CompoundPart& part : parts) {
    part.pose.position -= placed.centre;
  }
  placed.body = compound_in_place(std::move(parts));
  return placed;
}

std::shared_ptr<const CompoundBody> compound_in_place(std::vector<CompoundPart> parts) {
  check(parts);
  const Weighed mass = weigh(parts);
  const Matrix3& I = mass.inertia;
  auto body = std::make_shared<CompoundBody>();
  body->volume = mass.volume;
  if (is_principal(I)) {
    body->moments = I.diagonal();
  } else {
    const Eigen::SelfAdjointEigenSolver<Matrix3> solver(I);
    Matrix3 axes = solver.eigenvectors();
    if (axes.determinant() < 0.0) {
      axes.col(2) = -axes.col(2);
    }
    body->axes = Quaternion(axes).normalized();
    body->moments = solver.eigenvalues();
  }
  body->parts = std::move(parts);
  add_sizes(*body);
  return body;
}

std::shared_ptr<const CompoundBody> resized(const CompoundBody& body, double size) {
  auto larger = std::make_shared<CompoundBody>(body);
  for (CompoundPart& part : larger->parts) {
    part.shape = resized(part.shape, size);
    part.pose.position *= size;
  }
  larger->half_extents *= size;
  larger->radius *= size;
  larger->width *= size;
  larger->volume *= (size * size * size);
  larger->moments *= (size * size * size * size * size);
  return larger;
}

}  // namespace core
}  // namespace kairos
