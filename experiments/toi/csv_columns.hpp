#pragma once

#include "core/error.hpp"
#include "core/reading/csv.hpp"
#include "experiments/toi/row_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kairos::experiments {

/// The columns that the header of a file of queries names, and rows of as many fields. Const after
/// construction; shared by threads.
class CsvColumns {
 public:
  static constexpr std::size_t absent = static_cast<std::size_t>(-1);

  /// `header` is line `line` of the file; `file` is for messages. Throws `InputError`.
  CsvColumns(std::string_view header, std::int64_t line, std::string file)
      : file_(std::move(file)), line_(static_cast<int>(line)) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (header.starts_with(byte_order_mark)) {
      header.remove_prefix(byte_order_mark.size());
    }
    std::vector<std::string_view> fields;
    if (!split_fields(header, fields)) {
      throw InputError(file_, line_, "", "the header has a quote that does not end");
    }
    for (const std::string_view field : fields) {
      names_.emplace_back(unquoted(field));
    }
  }

  [[nodiscard]] const std::string& name(std::size_t column) const { return names_[column]; }
  /// Where a column is; `absent` if there is none. Throws `InputError` where there are two.
  [[nodiscard]] std::size_t find(const std::string& name) const {
    const auto first = std::find(names_.begin(), names_.end(), name);
    if (first == names_.end()) {
      return absent;
    }
    if (std::find(first + 1, names_.end(), name) != names_.end()) {
      throw InputError(file_, line_, name, "is the name of two columns; allowed: one");
    }
    return static_cast<std::size_t>(first - names_.begin());
  }
  /// The same for a column that must be there; `needed` lists what is, for the message.
  [[nodiscard]] std::size_t need(const std::string& name, std::string_view needed) const {
    const std::size_t column = find(name);
    if (column == absent) {
      throw InputError(file_, line_, name,
                       fmt::format("is missing from the header; needed: {}", needed));
    }
    return column;
  }

  /// Splits a row. Throws `BadField` where it has more or fewer fields than the header.
  void split(std::string_view row, std::vector<std::string_view>& fields) const {
    if (!split_fields(row, fields)) {
      throw BadField{"", "has a quote that does not end"};
    }
    if (fields.size() != names_.size()) {
      throw BadField{"", fmt::format("has {} fields; the header names {} columns", fields.size(),
                                     names_.size())};
    }
  }
  /// A field of a row that may be bad; empty if it has none.
  [[nodiscard]] static std::string_view field(std::string_view row, std::size_t column,
                                              std::vector<std::string_view>& fields) {
    return split_fields(row, fields) && column < fields.size() ? fields[column]
                                                               : std::string_view();
  }

 private:
  std::string file_;
  int line_;  ///< of the header
  std::vector<std::string> names_;
};

}  // namespace kairos::experiments
