#pragma once

#include "ccd/linear/linear_impact.hpp"
#include "experiments/toi/line_blocks.hpp"
#include "experiments/toi/row_stream.hpp"

#include <cstdint>
#include <optional>

namespace kairos::experiments {

/// What became of a file of queries.
struct VfeeTally {
  std::int64_t bad = 0;  ///< queries that were refused
  /// Of files that tell the truth themselves; 0 of others.
  std::int64_t told = 0, false_negatives = 0, false_positives = 0;
};

/// Answers a file of vertex-face and edge-edge queries on stdout as `answer_rows` does. `kind` is
/// that of files in the data set's format, which do not tell it; without it the name of their
/// folder must.
VfeeTally answer_vfee_queries(LineBlocks& queries, const RowStreamOptions& options,
                              std::optional<ccd::LinearKind> kind);

}  // namespace kairos::experiments
