#pragma once

#include <string>

namespace kairos::experiments {

/// Writes `index.html` into a folder whose subfolders are experiments (as `run_experiment` leaves
/// them): what was asked, figures with captions, the tables behind them, the commands, seeds and
/// versions. The page needs nothing from outside the folder. Throws `InputError` where there is
/// no experiment, `RunError` where it cannot be written. Returns the path of the page.
std::string write_report(const std::string& folder);

}  // namespace kairos::experiments
