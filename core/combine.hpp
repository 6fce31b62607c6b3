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
/// As scene files say it.
[[nodiscard]] constexpr std::string_view to_string(Combine how) {
  return combine_names[static_cast<int>(how)];
}

/// The pair's value, of two that are >= 0 and may be infinite. Symmetric. 0 of one is 0 of the
/// pair, whatever the other: what is smooth slides on what is rough.
[[nodiscard]] double combine(Combine how, double x_a, double x_b);

}  // namespace core
}  // namespace kairos
