#pragma once

#include "ccd/mesh/mesh_pair.hpp"

namespace kairos::ccd {

/// Is a vertex of the second mesh inside the first one, a solid on whose surface it is not? Exact:
/// how often the surface goes round the point, by the triangles that a segment from it to a point
/// outside crosses. `exact` counts what only whole numbers could decide.
[[nodiscard]] bool vertex_in_solid(const MeshPair& pair, std::uint32_t vertex_b,
                                   std::int64_t& exact);

}  // namespace kairos::ccd
