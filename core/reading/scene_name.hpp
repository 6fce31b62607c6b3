#pragma once

#include "core/reading/table_reader.hpp"

#include <map>
#include <string>

namespace kairos {
inline namespace core {

/// The name in `item`: 1 to 64 letters, digits, `_`, `-` and inner spaces. Throws `InputError`.
[[nodiscard]] const std::string& read_name(const Item& item);
/// Path of an element of `array` in messages and overrides: `body.ball`, or `body[2]` where it has
/// no name.
[[nodiscard]] std::string element_path(std::string_view array, const Value& element,
                                       std::size_t index);

/// Names of an array so far, with their lines.
class UniqueNames {
 public:
  /// Adds the name in `item`, of the `what` (a "body") that is written at `line`. Throws
  /// `InputError` if it is there already.
  void add(const Item& item, std::string_view what, int line);

 private:
  std::map<std::string, int> lines_;
};

}  // namespace core
}  // namespace kairos
