#pragma once

#include "experiments/report/markdown.hpp"
#include "experiments/report/report_entry.hpp"

#include <string>
#include <vector>

namespace kairos::experiments {

/// The replication paper with its numbers, tables and figures filled in from what was made.
struct Paper {
  MarkdownPage page;  ///< empty if there is no paper
  std::string title;
  std::string references;          ///< HTML list of what it cites
  std::vector<std::string> holes;  ///< what it asks for and was not made
};

/// Fills `paper/replication.md`:
///   {{value:ENTRY.NAME}}          a value of an entry, as its texts quote it
///   {{cell:ENTRY/TABLE|COLUMN|key=value|...}}  one cell of a table, in four digits
///   {{figure:ENTRY}}, {{figure:ENTRY/NAME}}    its drawings, or one, with captions
///   {{table:ENTRY/TABLE}}         a table
///   [@Key]                        a reference
/// What was not made is said in its place, and listed.
[[nodiscard]] Paper fill_paper(const std::vector<ReportEntry>& entries);

}  // namespace kairos::experiments
