#pragma once

#include <string>
#include <vector>

namespace kairos::experiments {

/// An interpreter that has matplotlib: `$KAIROS_PYTHON`, the one on PATH, then the system's. The
/// one on PATH may not have it. Empty if none has.
[[nodiscard]] std::string find_python();

/// Draws the figures of an experiment from the CSV files in `folder`, as SVG and PNG, and lists
/// them with their captions in `figures.csv`. `script`: a module of `experiments/figures`; empty:
/// `lines`, which draws any sweep. Returns what went wrong; empty if nothing did: results do not
/// depend on their pictures.
[[nodiscard]] std::string draw_figures(const std::string& script, const std::string& folder);

/// Draws runs over time, beside each other (`run_plot`): folders that `kairos run --out` wrote, and
/// the picture, a file .png, .svg or .pdf. `bodies`: with commas; empty: those that move. Returns
/// what went wrong; empty if nothing did.
[[nodiscard]] std::string draw_runs(const std::vector<std::string>& runs, const std::string& bodies,
                                    const std::string& picture);

}  // namespace kairos::experiments
