#pragma once

#include "tests/judge/contact.hpp"

#include <span>
#include <string_view>

namespace kairos::judge {

/// One class of hard queries.
struct Family {
  std::string_view name;
  std::string_view what;
  Query (*make)(Random& random);
  bool parting = false;  ///< asks when they part, not when they meet
  bool extreme = false;  ///< may be refused
};

/// In touch at the start, or close to it: families_touch.cpp.
[[nodiscard]] std::span<const Family> touching_families();
/// Half-spaces and balls: families_plane.cpp.
[[nodiscard]] std::span<const Family> plane_families();
/// Grazes, several roots, edges almost parallel, spins: families_graze.cpp.
[[nodiscard]] std::span<const Family> graze_families();
/// Far away, for long, of extreme size: families_scale.cpp.
[[nodiscard]] std::span<const Family> scale_families();
/// Lengths whose squares leave the range of a double: families_scale.cpp.
[[nodiscard]] std::span<const Family> extreme_families();
/// Overlapping at the start: families_parting.cpp.
[[nodiscard]] std::span<const Family> parting_families();
/// Motions as integrators make them: families_polynomial.cpp.
[[nodiscard]] std::span<const Family> polynomial_families();
/// A query of another class, seen another way: families_changed.cpp.
[[nodiscard]] std::span<const Family> changed_families();

/// Draws a query of any class whose queries stand on their own, have lengths in the range of daily
/// life, and motions that `kairos toi` can write.
[[nodiscard]] Query any_query(Random& random);

}  // namespace kairos::judge
