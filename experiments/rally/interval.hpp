#pragma once

#include <cstdint>
#include <vector>

namespace kairos::experiments {

/// An estimate and the interval that holds the truth with 95 % confidence.
struct Interval {
  double estimate = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// Of a share, from counts: Wilson's score interval [Wilson1927], which says something where
/// nothing was counted, too. `of` > 0.
[[nodiscard]] Interval share_interval(std::int64_t count, std::int64_t of);

/// Of a mean, from independent values: 1.96 standard errors to either side. At least one value.
[[nodiscard]] Interval mean_interval(const std::vector<double>& values);

}  // namespace kairos::experiments
