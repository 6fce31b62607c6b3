#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

namespace kairos::experiments {

/// Whole lines of a file, many at a time, in constant memory whatever its length.
class LineBlocks {
 public:
  /// Opens a file; `-` is stdin. Throws `InputError`.
  explicit LineBlocks(const std::string& path);
  LineBlocks(const LineBlocks&) = delete;
  LineBlocks& operator=(const LineBlocks&) = delete;
  ~LineBlocks();

  /// The next lines, each with its line break (the last one may have none), and the number of the
  /// first; false at the end. Throws `InputError` where the file cannot be read further, or where a
  /// line is longer than 16 MiB.
  bool next(std::string& block, std::int64_t& first_line);

  /// What messages call it.
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  bool fill(std::string& block);

  std::string name_;
  std::FILE* file_;
  std::string rest_;  ///< the beginning of a line whose end is still to come
  std::int64_t line_ = 1;
};

}  // namespace kairos::experiments
