#pragma once

#include <string>
#include <vector>

namespace kairos::experiments {

/// Names of the shipped experiments, in the order of the report.
[[nodiscard]] std::vector<std::string> shipped_experiments();
/// The spec that a person means: the name of a shipped experiment, or a path. Throws `InputError`.
[[nodiscard]] std::string find_experiment(const std::string& path_or_name);
/// Folder of the scripts that draw figures; empty if there is none.
[[nodiscard]] std::string figure_folder();
/// Folder of the report's style sheet; empty if there is none.
[[nodiscard]] std::string report_folder();
/// Folder of the paper and its bibliography; empty if there is none.
[[nodiscard]] std::string paper_folder();

}  // namespace kairos::experiments
