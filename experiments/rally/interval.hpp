#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace kairos::experiments {

/// An estimate and the interval that holds the truth with 95 % confidence.
struct Interval {
  double estimate = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// What was counted in one group of draws that are not independent: the strokes of a rally.
struct Cluster {
  std::int64_t count = 0;
  std::int64_t of = 0;
};

/// Of a share, from counts of independent draws: Wilson's score interval [Wilson1927], which says
/// something where nothing was counted, too. `of` > 0.
[[nodiscard]] Interval share_interval(std::int64_t count, std::int64_t of);

/// By how much the variance of the share of all clusters exceeds that of as many independent draws
/// [Kish1965, ch. 5]; at least 1, which it also is where nothing or everything was counted and it
/// cannot be known. At least two clusters.
[[nodiscard]] double design_effect(std::span<const Cluster> clusters);

/// Of a share, from clusters: Wilson's interval with the draws divided by the design effect and the
/// quantile of Student's distribution with one degree of freedom less than clusters. Where nothing
/// or everything was counted, the effect is taken to be `otherwise`.
[[nodiscard]] Interval share_interval(std::span<const Cluster> clusters, double otherwise = 1.0);

/// Of a mean, from independent values: standard errors times the quantile of Student's
/// distribution to either side. At least one value.
[[nodiscard]] Interval mean_interval(const std::vector<double>& values);

/// 97.5 % quantile of Student's distribution with this many degrees of freedom, by its expansion
/// about the normal one [Abramowitz1964, 26.7.5]; it is 0.3 % low at 4 degrees of freedom, and
/// closer from there on.
[[nodiscard]] double student(double degrees);

}  // namespace kairos::experiments
