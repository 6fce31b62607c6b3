#pragma once

#include "experiments/report/report_entry.hpp"

#include <string>
#include <vector>

namespace kairos::experiments {

/// Writes the pages of `kairos view` that the report shows beside figures of motion, into
/// FOLDER/live: a shipped scene from impact to impact, beside the thesis' stepping. None is written
/// where the viewer's page was not built.
void write_live_views(const std::string& folder, const std::vector<ReportEntry>& entries);

/// That page beside the figures of an entry, closed and not loaded until somebody opens it; empty
/// where there is none.
[[nodiscard]] std::string live_html(const ReportEntry& entry);

}  // namespace kairos::experiments
