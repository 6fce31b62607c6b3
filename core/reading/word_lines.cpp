#include "core/reading/word_lines.hpp"

#include "core/error.hpp"
#include "core/reading/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace kairos {
inline namespace core {

bool WordLines::next() {
  while (!rest_.empty()) {
    const std::size_t end = rest_.find('\n');
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++line_;
    split(line.substr(0, line.find('#')));
    if (!words_.empty()) {
      return true;
    }
  }
  return false;
}

void WordLines::need(const std::string& what) {
  if (!next()) {
    ++line_;
    fail(fmt::format("the file ends before {} (is it truncated?)", what));
  }
}

double WordLines::number(std::size_t i, const Range& range) const {
  const std::optional<double> x = parse_number(word(i));
  if (!x || !range.contains(*x)) {
    fail(fmt::format("\"{}\" is not allowed here; allowed: {}", word(i), range.text()));
  }
  return *x;
}

std::size_t WordLines::whole(std::size_t i, double highest, const std::string& what) const {
  const std::optional<double> x = parse_number(word(i));
  if (!x || *x < 0.0 || *x > highest || *x != std::floor(*x)) {
    fail(fmt::format("\"{}\" is no {}; allowed: a whole number from 0 to {}", word(i), what,
                     highest));
  }
  return static_cast<std::size_t>(*x);
}

void WordLines::fail(const std::string& reason) const {
  throw InputError(path_, line_, "", reason);
}

void WordLines::split(std::string_view line) {
  words_.clear();
  constexpr std::string_view space = " \t\r";
  for (std::size_t at = line.find_first_not_of(space); at != std::string_view::npos;
       at = line.find_first_not_of(space, at)) {
    const std::size_t end = std::min(line.find_first_of(space, at), line.size());
    words_.push_back(line.substr(at, end - at));
    at = end;
  }
}

}  // namespace core
}  // namespace kairos
