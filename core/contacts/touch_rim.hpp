#pragma once

#include "core/contacts/touch.hpp"
#include "core/shape.hpp"
#include "core/state.hpp"

#include <optional>
#include <vector>

namespace kairos {
inline namespace core {

/// Where a feature that something touches ends: it is touched while a point stays inside all of
/// these planes. Of a face that a ball or a corner is on: the planes through its edges; of an edge
/// that a ball is on: those through its ends, and those beyond which the ball is over a face again.
struct TouchRim {
  /// Inside: normal.x <= offset.
  struct Side {
    Vector3 normal = Vector3::Zero();  ///< unit, body frame
    double offset = 0.0;               ///< m
  };
  std::vector<Side> sides;  ///< none, and no radius: the feature has no end
  double radius = 0.0;      ///< of a disc about the body's y axis, m; 0: it is none
  double inner = 0.0;       ///< inside is no nearer to that axis than this, m
  bool of_a = false;        ///< the feature is that of a
  bool of_lines = false;    ///< the point is where they touch, otherwise the middle of the ball
  /// Of a rim that crosses something: inside, the normal leads away from the axis.
  bool of_normal = false;

  /// How far the point is beyond the rim, m; negative: inside.
  [[nodiscard]] double beyond(const Touch& touch, const BodyState& a, const BodyState& b) const;
};

/// The rims of both features of a touch; nullopt where it is not known where one ends. A corner
/// that is none (where two edges cross) has no rim.
[[nodiscard]] std::optional<std::vector<TouchRim>> rims_of(const Touch& touch, const Shape& a,
                                                           const Shape& b);

/// The planes through the edges of the face with this outward normal (body frame) of a box or hull;
/// nullopt where there is no such face.
[[nodiscard]] std::optional<std::vector<TouchRim::Side>> sides_of_face(const Shape& shape,
                                                                       const Vector3& outward);

/// How far x (body frame, m) is beyond the region of a feature, in which it is the nearest one;
/// negative: inside, infinite where that is not known.
[[nodiscard]] double beyond_region(const TouchFeature& feature, const Shape& shape,
                                   const Vector3& x);

}  // namespace core
}  // namespace kairos
