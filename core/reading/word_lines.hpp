#pragma once

#include "core/reading/table_reader.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace kairos {
inline namespace core {

/// The lines of a text that say something, as words; what follows a # is skipped. Every complaint
/// is an `InputError` with file and line.
class WordLines {
 public:
  /// Both must outlive this.
  WordLines(std::string_view text, const std::string& path) : rest_(text), path_(path) {}

  /// Goes on to the next line with words; false at the end of the file.
  bool next();
  /// The next line, which must be there; `what` says of what, for the message.
  void need(const std::string& what);
  [[nodiscard]] const std::vector<std::string_view>& words() const { return words_; }
  void drop_first() { words_.erase(words_.begin()); }
  [[nodiscard]] int line() const { return line_; }

  /// Word i as a number within a range.
  [[nodiscard]] double number(std::size_t i, const Range& range) const;
  /// Word i as a whole number from 0 to `highest`; `what` it is, for the message.
  [[nodiscard]] std::size_t whole(std::size_t i, double highest, const std::string& what) const;
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  void split(std::string_view line);
  [[nodiscard]] std::string_view word(std::size_t i) const {
    return i < words_.size() ? words_[i] : std::string_view("nothing");
  }

  std::string_view rest_;
  const std::string& path_;
  int line_ = 0;
  std::vector<std::string_view> words_;
};

}  // namespace core
}  // namespace kairos
