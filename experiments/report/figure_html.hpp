#pragma once

#include "experiments/report/report_entry.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace kairos::experiments {

/// What a drawing is called on the page: the thesis' number ("Figure 13", "9.1.2 b"), or E and a
/// running number for experiments.
[[nodiscard]] std::string figure_label(const std::vector<ReportEntry>& entries,
                                       const ReportEntry& entry, std::size_t drawing);

/// One drawing of an entry: the picture, its label and caption, the command that makes it, and
/// links to its data.
[[nodiscard]] std::string figure_html(const ReportEntry& entry, std::size_t drawing,
                                      const std::string& label);

/// A link to it, with its caption, where a text speaks of a figure that stands elsewhere.
[[nodiscard]] std::string figure_reference(const ReportEntry& entry, std::size_t drawing,
                                           const std::string& label);

}  // namespace kairos::experiments
