#pragma once

#include "experiments/meshes/mesh_query.hpp"
#include "experiments/toi/line_blocks.hpp"

#include <cstdint>
#include <optional>

namespace kairos::experiments {

struct MeshStreamOptions {
  MeshOptions meshes;
  RowStreamOptions rows;
  bool all = false;                 ///< a line for every pair of triangles
  std::optional<double> tolerance;  ///< m; of distances
};

/// Answers a file of poses on stdout as `answer_rows` does: do the meshes touch?
std::int64_t answer_collide_queries(LineBlocks& queries, const MeshStreamOptions& options);
/// The same: how far are they apart, or are they within a tolerance?
std::int64_t answer_distance_queries(LineBlocks& queries, const MeshStreamOptions& options);

}  // namespace kairos::experiments
