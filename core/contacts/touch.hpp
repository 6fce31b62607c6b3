#pragma once

#include "core/contact_manifold.hpp"
#include "core/contacts/contact_system.hpp"
#include "core/shape.hpp"
#include "core/state.hpp"

#include <optional>
#include <vector>

namespace kairos {
inline namespace core {

/// What of a body touches: it goes with the body.
struct TouchFeature {
  enum class Kind : char {
    ball,   ///< all within `radius` of a point; radius 0: a vertex
    plane,  ///< of a face
    line,   ///< of an edge; with a radius all within that of it: the side of a capsule
    rim,    ///< a circle, of this radius, about `at` and across `direction`
    cone,   ///< the side of a cone with its apex at `at`
  };
  Kind kind = Kind::ball;
  Vector3 at = Vector3::Zero();         ///< body frame, m
  Vector3 direction = Vector3::Zero();  ///< outward normal, along the line, or the axis of the
                                        ///< rim or the cone, to its apex; body frame, unit
  double radius = 0.0;                  ///< m
  /// Of a line or a rim at what is curved: where on it they touch is looked for from here; body
  /// frame, m.
  Vector3 near = Vector3::Zero();
  double sine = 0.0;  ///< of half the angle of a cone

  /// Whether it touches others of this kind where both cross.
  [[nodiscard]] bool crosses() const {
    return kind == Kind::line || kind == Kind::rim || kind == Kind::cone;
  }
};

/// Two features that touch at one point: a ball and a plane, a line, a rim, a cone or a ball, a rim
/// and a plane, or two lines, rims or cones that cross, not both of them cones.
struct Touch {
  std::size_t a = 0;  ///< places in the group
  std::size_t b = 0;
  TouchFeature on_a;
  TouchFeature on_b;
  Vector3 normal = Vector3::Zero();  ///< from a to b where it was found: the side of what crosses
  double friction = 0.0;             ///< Coulomb's
  double gap = 0.0;                  ///< at which it is held, m
  std::size_t pair = 0;              ///< of the group
  std::size_t point = 0;             ///< of the manifold of the pair
  double rest_speed = 0.0;           ///< m/s; what slides slower than this may be taken to stick
  bool rough = false;                ///< its friction stands for an infinite one
  /// Velocity of the surface of b beside that of a, world frame, m/s: of belts. Along the surface,
  /// which is a face of what the belt is on, and never moves.
  Vector3 belt = Vector3::Zero();
  /// Features may be those of pieces of the bodies, in frames of their own: where these are.
  bool of_pieces = false;
  Pose piece_a{};
  Pose piece_b{};
  std::size_t watched = 0;  ///< of the group's `TurningPair`s
};

/// A touch at two states. Rates and accelerations are of b along a.
struct TouchNow {
  Vector3 normal = Vector3::Zero();   ///< unit, from a to b, world frame
  Vector3 point_a = Vector3::Zero();  ///< of the surface of a, world frame, m
  Vector3 point_b = Vector3::Zero();
  double gap = 0.0;                    ///< m
  Vector3 velocity = Vector3::Zero();  ///< where they touch, m/s
  double normal_bias = 0.0;        ///< second derivative of the gap without accelerations, m/s^2
  Vector3 bias = Vector3::Zero();  ///< derivative of `velocity` without accelerations, m/s^2

  /// The velocity along the surface, m/s.
  [[nodiscard]] Vector3 slip() const { return velocity - normal * normal.dot(velocity); }
};

/// Where and how fast two features touch, to second order of their motion: with accelerations
/// (dv, dw) of both bodies the gap has the second derivative n.(dv_b + dw_b x r_b - dv_a - dw_a x
/// r_a) + `normal_bias`, r from the origins to the points; and so has the velocity its derivative
/// with `bias`.
[[nodiscard]] TouchNow look_at(const Touch& touch, const BodyState& a, const BodyState& b);

/// Where a feature is nearest to the point x; all in its frame.
[[nodiscard]] TouchNow look_at(const TouchFeature& feature, const Vector3& x);

/// The sine of the angle at which lines, rims or cones cross; 1 of other touches.
[[nodiscard]] double crossing_sine(const Touch& touch, const BodyState& a, const BodyState& b);

/// Corners of a shape, each a ball; a half-space has none. nullopt: the shape is round in a way
/// that has no corners.
[[nodiscard]] std::optional<std::vector<TouchFeature>> corners_of(const Shape& shape);

/// What of a shape is above a plane if all of the shape is: `corners_of`, or the rims of a cylinder
/// and the rim and the apex of a cone. nullopt: of a mesh or a compound that is not known.
[[nodiscard]] std::optional<std::vector<TouchFeature>> extremes_of(const Shape& shape);

/// How far the lowest point of a corner or a rim at `at` with this axis is above the plane through
/// q with normal n, m; all in one frame.
[[nodiscard]] double height_over(const TouchFeature& extreme, const Vector3& at,
                                 const Vector3& axis, const Vector3& n, const Vector3& q);

/// The faces of a box or of a hull without rounding, and of what is round the flat ones, each a
/// plane; empty for others.
[[nodiscard]] std::vector<TouchFeature> faces_of(const Shape& shape);

/// The edges of a box or of a hull without rounding, each a line; the round side of a capsule or a
/// cylinder; empty for others.
[[nodiscard]] std::vector<TouchFeature> edges_of(const Shape& shape);

/// The face of a shape that looks `outward`, unit, near a point of the surface (body frame): its
/// own normal, on the plane that supports the shape, whatever the roundoff of both.
[[nodiscard]] TouchFeature face_feature(const Shape& shape, const Vector3& x,
                                        const Vector3& outward);

/// The features of two bodies that touch at a point of their manifold. Two vertices, or a vertex
/// and an edge, have no normal of their own: of polytopes the place is held at the plane that
/// separates them. nullopt where there are none of those that a `Touch` knows.
[[nodiscard]] std::optional<Touch> touch_at(const ContactManifold& manifold, std::size_t point,
                                            const Shape& shape_a, const Pose& a,
                                            const Shape& shape_b, const Pose& b);

}  // namespace core
}  // namespace kairos
