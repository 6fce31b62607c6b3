#pragma once

#include <cstddef>
#include <vector>

namespace kairos {
inline namespace core {

/// Asks the system for large pages under this memory, before it is written to: where an array of
/// many megabytes is looked up here and there, finding small ones takes as long as reading them.
/// What cannot be had is done without.
void prefer_large_pages(void* begin, std::size_t bytes);

/// So many elements as they are made by default, looked up here and there.
template <typename T>
[[nodiscard]] std::vector<T> scattered(std::size_t n) {
  std::vector<T> elements;
  elements.reserve(n);
  prefer_large_pages(elements.data(), n * sizeof(T));
  elements.resize(n);
  return elements;
}

}  // namespace core
}  // namespace kairos
