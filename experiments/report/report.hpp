#pragma once

#include <string>
#include <vector>

namespace kairos::experiments {

struct Report {
  std::string path;                ///< of the page
  std::vector<std::string> holes;  ///< what the paper quotes and was not made
};

/// Writes `index.html` into a folder whose subfolders are figures of the thesis and experiments (as
/// `make_figure` and `run_experiment` leave them): the thesis chapter by chapter, its errata, the
/// experiments, and the paper with its numbers filled in; each figure with caption, command and
/// data. The page needs nothing from outside the folder. Throws `InputError` where there is
/// nothing to report, `RunError` where it cannot be written.
Report write_report(const std::string& folder);

}  // namespace kairos::experiments
