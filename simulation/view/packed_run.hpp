#pragma once

#include "simulation/output/json_writer.hpp"
#include "simulation/view/packed_arrays.hpp"
#include "simulation/view/view_run.hpp"

namespace kairos {
inline namespace simulation {

/// The numbers of a run, as studio/README.md lists them. Lines of the ledger that stay zero are
/// left out.
[[nodiscard]] PackedArrays packed(const ViewRun& run);

/// Members of the open object: names and texts of a run, and where each of its arrays lies.
void describe(JsonWriter& json, const ViewRun& run, const PackedArrays& arrays);

}  // namespace simulation
}  // namespace kairos
