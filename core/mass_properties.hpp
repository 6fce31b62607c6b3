#pragma once

#include "core/mesh_data.hpp"

#include <span>

namespace kairos {
inline namespace core {

/// A homogeneous solid of density 1 kg/m^3; multiply by a density, or by mass over volume.
struct MassProperties {
  double volume = 0.0;                       ///< m^3
  Vector3 centre = Vector3::Zero();          ///< of mass, frame of the vertices, m
  Matrix3 inertia = Matrix3::Zero();         ///< about the centre, axes of the vertices, kg m^2
  Vector3 moments = Vector3::Zero();         ///< principal, ascending, kg m^2
  Quaternion axes = Quaternion::Identity();  ///< from principal axes to those of the vertices
};

/// Of the solid inside a closed triangle mesh, convex or not: exact integrals over the signed
/// tetrahedra from a point inside to every triangle [Mirtich1996b], [Eberly2002]. Their roundoff is
/// relative to the mesh's own size, wherever it lies.
///
/// Throws `InputError` where there is no inside: a corner that does not exist, an edge without
/// exactly one triangle on either side, triangles turned inside out, no volume, moments that no
/// solid has (a surface that crosses itself), numbers that are not finite.
[[nodiscard]] MassProperties mass_properties(std::span<const Vector3> vertices,
                                             std::span<const Triangle> triangles);

/// Whether the axes of an inertia are principal up to the roundoff of its integrals: off-diagonal
/// entries are at most 1e-12 of the trace. Such axes are kept as given.
[[nodiscard]] bool is_principal(const Matrix3& inertia);

}  // namespace core
}  // namespace kairos
