#pragma once

#include "core/pose.hpp"
#include "core/shape.hpp"

#include <vector>

namespace kairos {
inline namespace core {

/// A convex part of a body, and where it is in its frame.
struct CompoundPart {
  Shape shape;
  Pose pose;
};

/// Parts about the body's origin and axes. Parts may overlap; what they share then weighs twice.
struct CompoundBody {
  std::vector<CompoundPart> parts;
  Vector3 half_extents = Vector3::Zero();    ///< of the box about the origin, m
  double radius = 0.0;                       ///< of the ball about the origin, m
  double width = 0.0;                        ///< least smallest extent of a part, m
  double volume = 0.0;                       ///< sum over the parts, m^3
  Vector3 moments = Vector3::Zero();         ///< density 1, principal, kg m^2
  Quaternion axes = Quaternion::Identity();  ///< the principal axes, in those of the body
};

/// A body, and where it was: a point x of the body was centre + x.
struct PlacedCompound {
  std::shared_ptr<const CompoundBody> body;
  Vector3 centre = Vector3::Zero();
};

/// About the centre of mass. Throws `std::invalid_argument` without parts, or for parts that are
/// not convex and bounded.
[[nodiscard]] PlacedCompound compound_body(std::vector<CompoundPart> parts);
/// The same, but parts stay where they are; the moments are those about the centre of mass.
[[nodiscard]] std::shared_ptr<const CompoundBody> compound_in_place(
    std::vector<CompoundPart> parts);
/// All lengths times `size`.
[[nodiscard]] std::shared_ptr<const CompoundBody> resized(const CompoundBody& body, double size);

}  // namespace core
}  // namespace kairos
