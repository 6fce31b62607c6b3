#pragma once

#include "core/pose.hpp"
#include "core/shape.hpp"

#include <vector>

namespace kairos {
inline namespace core {

/// A convex piece of a shape, and where it is in the body's frame.
struct ShapePiece {
  Shape shape;  ///< of which `touch_at` and others know features
  Shape asked;  ///< the same, as detectors take it
  Pose pose;
};

/// What of a shape another may touch that is within `within`, m, of `near` (body frame). The parts
/// of a compound; the triangles of a mesh, as flat hulls; of a mesh that touches a half-space its
/// outline, vertices alone; otherwise the shape itself. Refers to the shape, which has to outlive
/// it.
[[nodiscard]] std::vector<ShapePiece> pieces_of(const Shape& shape, bool over_plane,
                                                const Vector3& near, double within);

/// Where a piece of a body is in the world.
[[nodiscard]] inline Pose in_world(const Pose& body, const Pose& piece) {
  return {body.to_world(piece.position), body.orientation * piece.orientation};
}

/// Whether a shape has pieces: a mesh or a compound.
[[nodiscard]] bool has_pieces(const Shape& shape);

}  // namespace core
}  // namespace kairos
