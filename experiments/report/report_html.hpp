#pragma once

#include "experiments/report/report_entry.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments {

/// Text as HTML: markup characters escaped.
[[nodiscard]] std::string html(std::string_view text);

/// Four digits for reading, of what is a number; the linked CSV has them all.
[[nodiscard]] std::string readable(const std::string& cell);

/// A table as it is, numbers in four digits.
[[nodiscard]] std::string csv_table_html(const std::string& path);

/// The errata: one row per measured number, statements beside them once.
[[nodiscard]] std::string errata_html(const ReportEntry& entry);

/// The summary of a sweep as an HTML table: methods and axes, then each metric as its median with
/// quartiles, or its value if there are no repeats. Empty where the table has more than `most`
/// rows.
[[nodiscard]] std::string summary_html(const std::string& folder, const std::string& sweep,
                                       std::size_t most);

/// Methods as rows, sweeps (scenes) side by side: penetration and energy error of each.
[[nodiscard]] std::string overview_html(const std::string& folder,
                                        const std::vector<std::string>& sweeps);

}  // namespace kairos::experiments
