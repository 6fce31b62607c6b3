#include "core/nearest_name.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace kairos {
inline namespace core {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string_view nearest_name(std::string_view wanted, std::span<const std::string_view> names) {
  // Longer words than any name of ours are not typing errors, and would cost quadratic time.
  if (wanted.size() > 64) {
    return {};
  }
  std::string_view best;
  std::size_t least = std::max<std::size_t>(1, wanted.size() / 3) + 1;
  for (const std::string_view name : names) {
    const std::size_t distance = edit_distance(wanted, name);
    if (distance < least) {
      least = distance;
      best = name;
    }
  }
  return best;
}

std::string listed(std::span<const std::string_view> names) {
  std::string text;
  for (const std::string_view name : names) {
    text += (text.empty() ? "" : ", ") + std::string(name);
  }
  return text;
}

std::string suggestion(std::string_view wanted, std::span<const std::string_view> names) {
  const std::string_view nearest = nearest_name(wanted, names);
  const std::string guess =
      nearest.empty() ? std::string() : "did you mean \"" + std::string(nearest) + "\"? ";
  return guess + "allowed: " + listed(names);
}

}  // namespace core
}  // namespace kairos
