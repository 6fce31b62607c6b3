#pragma once

#include "ccd/pair_motion.hpp"

namespace kairos::ccd {

/// What the direction of a separation is fixed to while time goes on.
enum class WitnessFrame {
  world,  ///< a direction that stays
  a,      ///< a direction that turns with a (a face of a)
  b,      ///< a direction that turns with b (a face of b, a half-space)
  edges,  ///< the cross product of an edge of a and an edge of b, which both turn
  hulls,  ///< a direction that stays, the bodies replaced by hulls that do not turn with them
};

/// The direction along which two bodies are apart at one instant: the frozen witness.
struct Witness {
  WitnessFrame frame = WitnessFrame::world;
  Vector3 n = Vector3::UnitX();  ///< unit, from a to b, world frame
  double gap = 0.0;              ///< separation along it, off by `Kinematics::error` at most, m
  int axis = none;               ///< two boxes only: which of the 15 it is
  double sign = 1.0;             ///< two boxes only: as in `AxisSeparation`
  double sine = 1.0;             ///< of edges: of the angle between them
  /// Of edges: their directions, world frame, such that n is along their cross product.
  Vector3 along_a = Vector3::UnitX();
  Vector3 along_b = Vector3::UnitX();

  /// Two cores only: they are proven to overlap by so much, 0 if nothing is proven; the distance of
  /// two of their points, and these, from the origin of a, world axes, m.
  double depth = 0.0;
  double upper = 0.0;
  Vector3 on_a = Vector3::Zero();
  Vector3 on_b = Vector3::Zero();

  static constexpr int none = -1;
  [[nodiscard]] int edge_a() const { return (axis - 6) / 3; }
  [[nodiscard]] int edge_b() const { return (axis - 6) % 3; }
};

/// Which witness a pair of shapes needs.
enum class PairKind {
  sphere_sphere,
  sphere_box,
  sphere_plane,
  box_box,
  box_plane,
  cores,       ///< at least one is a capsule, a cylinder, a cone or a hull
  core_plane,  ///< such a one and a half-space
};
[[nodiscard]] constexpr bool against_plane(PairKind kind) {
  return kind == PairKind::sphere_plane || kind == PairKind::box_plane ||
         kind == PairKind::core_plane;
}
[[nodiscard]] PairKind pair_kind(const Shape& a, const Shape& b);

/// The witness of greatest separation; shapes in the order of their rank.
[[nodiscard]] Witness find_witness(PairKind kind, const PairMotion& motion, const Kinematics& k);
/// The witness of the balls around the shapes (`gap` is negative infinity if there is none).
[[nodiscard]] Witness between_balls(PairKind kind, const PairMotion& motion, const Kinematics& k);
/// The witness of the hulls of all that the bodies pass while they spin: of a body that turns at a
/// constant rate, the convex hull of its turning about that axis through its origin (eq. 8). `gap`
/// is negative infinity where a body turns otherwise. `along`: a direction to begin with.
[[nodiscard]] Witness between_hulls(PairKind kind, const PairMotion& motion, const Kinematics& k,
                                    const Witness& along);
/// The direction between the nearest points of these hulls, for boxes and spheres: dearer than the
/// directions that `between_hulls` tries, and the best there is. 0 if there is none.
[[nodiscard]] Vector3 between_spun_boxes(PairKind kind, const PairMotion& motion,
                                         const Kinematics& k);
/// A time up to which the balls around two bodies (the ball and a plane that does not turn) are
/// proven apart, whatever turns; 0 if they are not apart now, or if there are none. Costs no bound
/// of a rotation.
[[nodiscard]] double clear_of_balls(PairKind kind, const PairMotion& motion);
/// Is the overlap of the shapes at this instant proven?
[[nodiscard]] bool proven_overlap(PairKind kind, const PairMotion& motion, const Kinematics& k,
                                  const Witness& witness);

/// First positive root of f + b h + c h^2, f > 0; infinity if there is none. Where a bound is
/// infinite or the arithmetic overflows nothing is known: 0.
[[nodiscard]] double first_root(double f, double b, double c);

}  // namespace kairos::ccd
