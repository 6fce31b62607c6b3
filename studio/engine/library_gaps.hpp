#pragma once

// What C++20 has and the standard library of an older Emscripten has not yet. Read before the few
// sources that use it; does nothing where the library has it.
#include <bit>
#include <cstddef>
#include <cstring>
#include <memory>
#include <type_traits>
#include <version>

namespace std {

#ifndef __cpp_lib_bit_cast
template <typename To, typename From>
[[nodiscard]] To bit_cast(const From& from) noexcept {
  static_assert(sizeof(To) == sizeof(From) && is_trivially_copyable_v<To> &&
                is_trivially_copyable_v<From>);
  To to;
  memcpy(&to, &from, sizeof(To));
  return to;
}
#endif

#if !defined(__cpp_lib_smart_ptr_for_overwrite)
template <typename T>
[[nodiscard]] unique_ptr<T> make_unique_for_overwrite(size_t count) {
  return unique_ptr<T>(new remove_extent_t<T>[count]);
}
#endif

}  // namespace std
