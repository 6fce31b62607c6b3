#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kairos {
inline namespace core {

/// A double from the whole of a text (decimal point, no spaces around); nullopt for anything else,
/// NaN, infinity and overflow included.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);
/// Without the white space around it.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// The text between the quotes, where a field is quoted; the trimmed field otherwise.
[[nodiscard]] std::string_view unquoted(std::string_view field);
/// Splits a row at the commas that no quotes enclose, into fields as they were written; false if a
/// quote does not end.
[[nodiscard]] bool split_fields(std::string_view row, std::vector<std::string_view>& fields);

/// A small CSV file of numbers with a header, kept whole in memory: a recording, frame times.
/// Blank lines and lines that start with # are skipped; fields may be quoted.
class CsvNumbers {
 public:
  /// Reads the named columns; others are ignored. Throws `InputError` with the line where a column
  /// or a field is missing, is no finite number, or a row has another length than the header.
  /// `first_line`: number of the first line of the text, for messages.
  CsvNumbers(const std::string& path, std::string_view text,
             std::span<const std::string_view> columns, int first_line = 1);

  [[nodiscard]] std::size_t size() const { return lines_.size(); }
  /// Line of the file in which row i was written.
  [[nodiscard]] int line(std::size_t i) const { return lines_[i]; }
  /// Field of row i in the order of `columns`.
  [[nodiscard]] double operator()(std::size_t i, std::size_t column) const {
    return fields_[i * width_ + column];
  }

 private:
  std::size_t width_;
  std::vector<double> fields_;
  std::vector<int> lines_;
};

}  // namespace core
}  // namespace kairos
