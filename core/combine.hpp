#pragma once

#include <string_view>

namespace kairos {
inline namespace core {

/// How a property of a pair (restitution, friction) comes from those of its two bodies.
enum class Combine {
  product,         ///< x_a x_b
  geometric_mean,  ///< sqrt(x_a x_b)
  minimum,         ///< min(x_a, x_b)
};
inline constexpr std::string_view combine_names[] = {"product", "geometric-mean", "minimum"};
/// The word for it in scene files.
[[nodiscard]] constexpr std::string_view to_string(Combine how) {
  return combine_names[static_cast<int>(how)];
}

/// The value of a pair from those of its bodies, >= 0 and possibly infinite. Symmetric. If one is 0
/// the pair's is 0, whatever the other: a smooth body slides on a rough one.
[[nodiscard]] double combine(Combine how, double x_a, double x_b);

}  // namespace core
}  // namespace kairos
