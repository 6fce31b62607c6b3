#include "core/combine.hpp"

#include <algorithm>
#include <cmath>

namespace kairos {
inline namespace core {

double combine(Combine how, double x_a, double x_b) {
  if (x_a == 0.0 || x_b == 0.0) {
    return 0.0;
  }
  switch (how) {
    case Combine::product:
      return x_a * x_b;
    case Combine::geometric_mean:
      return x_a == x_b ? x_a : std::sqrt(x_a) * std::sqrt(x_b);
    case Combine::minimum:
      break;
  }
  return std::min(x_a, x_b);
}

}  // namespace core
}  // namespace kairos
