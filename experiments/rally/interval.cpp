#include "experiments/rally/interval.hpp"

#include "core/energy_ledger.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::experiments {
namespace {

constexpr double z = 1.959963984540054;  // of the normal distribution: 95 % within +-z

}  // namespace

Interval share_interval(std::int64_t count, std::int64_t of) {
  const auto n = static_cast<double>(of);
  const double p = static_cast<double>(count) / n;
  const double scale = 1.0 / (1.0 + z * z / n);
  const double centre = scale * (p + 0.5 * z * z / n);
  const double half = scale * z * std::sqrt(p * (1.0 - p) / n + 0.25 * z * z / (n * n));
  // Where all or nothing was counted, one end is known; the formula reaches it up to roundoff.
  return {p, count == 0 ? 0.0 : std::max(0.0, centre - half),
          count == of ? 1.0 : std::min(1.0, centre + half)};
}

Interval mean_interval(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  CompensatedSum sum;
  for (const double x : values) {
    sum.add(x);
  }
  const double mean = sum.value() / n;
  CompensatedSum squares;
  for (const double x : values) {
    squares.add((x - mean) * (x - mean));
  }
  const double error = n > 1.0 ? std::sqrt(squares.value() / (n - 1.0) / n) : 0.0;
  return {mean, mean - z * error, mean + z * error};
}

}  // namespace kairos::experiments
