#pragma once

namespace kairos {
inline namespace core {

/// What lies there is about to be asked for: the cache may fetch it meanwhile.
template <typename T>
void prefetch([[maybe_unused]] const T& what) {
#if defined(__GNUC__)
  __builtin_prefetch(&what);
#endif
}

}  // namespace core
}  // namespace kairos
