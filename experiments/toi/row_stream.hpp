#pragma once

#include "experiments/toi/line_blocks.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace kairos::experiments {

/// What is wrong with a row, to be named with its line.
struct BadField {
  std::string_view column;
  std::string reason;
  std::size_t row = 0;  ///< of a query of several rows
};

/// Answers queries, one after the other; every thread has its own.
class RowAnswerer {
 public:
  virtual ~RowAnswerer() = default;
  /// The answer, with its line break; valid until the next call. `line`: of the first row. Throws
  /// `BadField`.
  virtual std::string_view answer(std::span<const std::string_view> rows, std::int64_t line) = 0;
  /// The same for rows that are bad, so that they keep their place among the answers.
  virtual std::string_view invalid(std::span<const std::string_view> rows, std::int64_t line) = 0;
};

/// A file of queries, as its first line tells.
struct RowFormat {
  std::string answer_header;       ///< the first line of the answers, with its line break
  std::size_t rows_per_query = 1;  ///< lines that are not blank
  bool first_line_is_a_row = false;
  std::function<std::unique_ptr<RowAnswerer>()> make_answerer;
};

struct RowStreamOptions {
  bool keep_going = false;  ///< answer bad rows as invalid instead of stopping
  std::size_t threads = 0;  ///< 0: one per core
};

/// Answers a file of queries on stdout, query by query and in order, in constant memory, on several
/// threads; the answers do not depend on their number. Bad rows are named on stderr with their
/// line. Returns how many queries were bad; without `keep_going` the first one throws `InputError`
/// after the answers before it are written. `read_format` gets the first line that is not blank,
/// and its number.
std::int64_t answer_rows(
    LineBlocks& queries, const RowStreamOptions& options,
    const std::function<RowFormat(std::string_view line, std::int64_t number)>& read_format);

}  // namespace kairos::experiments
