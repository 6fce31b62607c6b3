#pragma once

#include "core/pose.hpp"
#include "experiments/output/table.hpp"

#include <map>
#include <string>

namespace kairos::experiments {

/// Fields of a table that was written, by column name, with complaints that name file and line.
class TableRows {
 public:
  /// Throws `InputError` where the file is not a table.
  explicit TableRows(const std::string& path);

  [[nodiscard]] std::size_t size() const { return table_.rows.size(); }
  [[nodiscard]] bool has(const std::string& column) const { return columns_.contains(column); }
  [[nodiscard]] std::string text(std::size_t row, const std::string& column) const;
  [[nodiscard]] double number(std::size_t row, const std::string& column) const;
  [[nodiscard]] Vector3 vector(std::size_t row, const std::string& x, const std::string& y,
                               const std::string& z) const;
  [[noreturn]] void fail(std::size_t row, const std::string& column,
                         const std::string& reason) const;

 private:
  std::string path_;
  Table table_;
  std::map<std::string, std::size_t> columns_;
};

}  // namespace kairos::experiments
