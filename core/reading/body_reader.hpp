#pragma once

#include "core/reading/table_reader.hpp"
#include "core/scene.hpp"

#include <string>

namespace kairos {
inline namespace core {

/// What the top level of a scene file says for all of its bodies.
struct BodyDefaults {
  double G = 9.8;
  Bounds bounds = Bounds::shape;
  double friction = 0.0;
  std::string directory;  ///< of the scene file: tracks are relative to it
};

inline constexpr std::string_view bounds_names[] = {"shape", "obb", "hull"};

/// Coulomb's coefficient: a number >= 0, or infinite. Throws `InputError`.
[[nodiscard]] double read_friction(const Item& item);

/// Reads one `[[body]]`. Throws `InputError`.
[[nodiscard]] Body read_body(const Item& item, const BodyDefaults& defaults);

}  // namespace core
}  // namespace kairos
