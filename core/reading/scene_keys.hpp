#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace kairos {
inline namespace core {

/// A key that a scene file may hold. The one list that the reader checks against, and that
/// scenes/README.md documents (a test compares them).
struct SceneKey {
  std::string_view
      table;  ///< "" (top level), "frame", "body", "body.drive", "many", "many.region", "force"
              ///< (any kind), "force.spring" (that kind), "exact"
  std::string_view key;
};

/// All keys but those that entities and exact solutions take (see their catalogues).
[[nodiscard]] std::span<const SceneKey> scene_keys();
/// Those of one table.
[[nodiscard]] std::vector<std::string_view> scene_keys_of(std::string_view table);

}  // namespace core
}  // namespace kairos
