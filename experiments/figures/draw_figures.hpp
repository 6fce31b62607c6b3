#pragma once

#include <string>

namespace kairos::experiments {

/// An interpreter that has matplotlib: `$KAIROS_PYTHON`, the one on PATH, then the system's. The
/// one on PATH may not have it. Empty if none has.
[[nodiscard]] std::string find_python();

/// Draws the figures of an experiment from the CSV files in `folder`, as SVG and PNG, and lists
/// them with their captions in `figures.csv`. `script`: a module of `experiments/figures`; empty:
/// `lines`, which draws any sweep. Returns what went wrong; empty if nothing did: results do not
/// depend on their pictures.
[[nodiscard]] std::string draw_figures(const std::string& script, const std::string& folder);

}  // namespace kairos::experiments
