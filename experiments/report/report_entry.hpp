#pragma once

#include <string>
#include <utility>
#include <vector>

namespace kairos::experiments {

/// A figure of the thesis, or an experiment, as its folder tells it.
struct ReportEntry {
  std::string folder;  ///< path
  std::string name;    ///< of the folder: prefix of links
  std::vector<std::pair<std::string, std::string>> manifest;
  std::vector<std::pair<std::string, std::string>> figures;  ///< name, caption
  bool of_thesis = false;  ///< it belongs to a chapter of the thesis, or is its errata

  /// A line of the manifest; empty if there is none.
  [[nodiscard]] std::string entry(const std::string& key) const;
  [[nodiscard]] std::vector<std::string> sweeps() const;
  /// A value as its texts quote it; empty if there is none.
  [[nodiscard]] std::string quoted(const std::string& value) const;
  /// Names of its tables and its spec, sorted.
  [[nodiscard]] std::vector<std::string> data_files() const;
};

/// Names of all that can be made: the thesis' figures, then the experiments, as the report orders
/// them.
[[nodiscard]] std::vector<std::string> reproducible_names();

/// All that was made in a folder: the thesis' figures in its order, the experiments in the order
/// of the library, a person's own after them.
[[nodiscard]] std::vector<ReportEntry> read_report_entries(const std::string& folder);

}  // namespace kairos::experiments
