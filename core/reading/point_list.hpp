#pragma once

#include "core/pose.hpp"

#include <optional>
#include <string_view>
#include <vector>

namespace kairos {
inline namespace core {

/// Points in a cell of a table: three numbers each, between spaces and semicolons.
///
/// @param read  called with each word, gives its number, and throws where it is none
/// @returns nothing where the last point is not whole
template <typename ReadNumber>
[[nodiscard]] std::optional<std::vector<Vector3>> read_point_list(std::string_view text,
                                                                  const ReadNumber& read) {
  std::vector<Vector3> points;
  int coordinate = 0;
  while (!text.empty()) {
    const std::size_t end = text.find_first_of(" ;");
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (word.empty()) {
      continue;
    }
    if (coordinate == 0) {
      points.emplace_back();
    }
    points.back()[coordinate] = read(word);
    coordinate = (coordinate + 1) % 3;
  }
  if (coordinate != 0) {
    return std::nullopt;
  }
  return points;
}

}  // namespace core
}  // namespace kairos
