#pragma once

#include <string>
#include <vector>

namespace kairos::experiments {

struct Report {
  std::string path;                ///< of the first page
  std::vector<std::string> holes;  ///< what the paper quotes and was not made
};

/// Writes the pages of a report into a folder whose subfolders are figures of the thesis and
/// experiments (as `make_figure` and `run_experiment` leave them). `index.html` holds the findings;
/// then a page for each chapter of the thesis, its errata, each experiment, and each part of the
/// paper with its numbers filled in. A figure has caption, command and data, and, where the
/// viewer's page was built, the motion itself to look at. The pages need nothing from outside the
/// folder, and no scripts. Throws `InputError` where there is nothing to report, `RunError` where
/// it cannot be written.
Report write_report(const std::string& folder);

}  // namespace kairos::experiments
