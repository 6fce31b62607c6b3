#pragma once

#include "ccd/core_witness.hpp"

namespace kairos::ccd {

/// Of two triangles, which have no volume that a polytope could be expanded in: the best of their
/// normals, of the products of their edges, of directions across an edge and of that of their
/// nearest points. `error`: of each coordinate of a corner, m. They are proven to overlap,
/// by no depth worth telling, where they cross whatever these errors are.
[[nodiscard]] CoreWitness triangle_witness(const CorePair& pair, double error);

}  // namespace kairos::ccd
