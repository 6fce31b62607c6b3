#include "experiments/rally/interval.hpp"

#include "core/energy_ledger.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::experiments {
namespace {

constexpr double normal = 1.959963984540054;  // 95 % of the normal distribution within +-normal

/// Wilson's interval of a share p of n draws, n not necessarily whole.
Interval wilson(double p, double n, double z) {
  const double scale = 1.0 / (1.0 + z * z / n);
  const double centre = scale * (p + 0.5 * z * z / n);
  const double half = scale * z * std::sqrt(p * (1.0 - p) / n + 0.25 * z * z / (n * n));
  // If all or none were counted, one end is known; the formula reaches it up to roundoff.
  return {p, p == 0.0 ? 0.0 : std::max(0.0, centre - half),
          p == 1.0 ? 1.0 : std::min(1.0, centre + half)};
}

Cluster sum_of(std::span<const Cluster> clusters) {
  Cluster sum;
  for (const Cluster& cluster : clusters) {
    sum.count += cluster.count;
    sum.of += cluster.of;
  }
  return sum;
}

double share(const Cluster& cluster) {
  return static_cast<double>(cluster.count) / static_cast<double>(cluster.of);
}

}  // namespace

double student(double degrees) {
  const double z = normal;
  const double n = degrees;
  const double z2 = z * z;
  return z + z * (z2 + 1.0) / (4.0 * n) + z * (5.0 * z2 * z2 + 16.0 * z2 + 3.0) / (96.0 * n * n) +
         z * (3.0 * z2 * z2 * z2 + 19.0 * z2 * z2 + 17.0 * z2 - 15.0) / (384.0 * n * n * n);
}

Interval share_interval(std::int64_t count, std::int64_t of) {
  return wilson(share({count, of}), static_cast<double>(of), normal);
}

double design_effect(std::span<const Cluster> clusters) {
  const Cluster all = sum_of(clusters);
  const double p = share(all);
  const auto n = static_cast<double>(all.of);
  const auto k = static_cast<double>(clusters.size());
  if (p == 0.0 || p == 1.0) {
    return 1.0;
  }
  CompensatedSum squares;  // of what each cluster counted more than its share of all
  for (const Cluster& cluster : clusters) {
    const double more = static_cast<double>(cluster.count) - p * static_cast<double>(cluster.of);
    squares.add(more * more);
  }
  return std::max(1.0, k / (k - 1.0) * squares.value() / (n * p * (1.0 - p)));
}

Interval share_interval(std::span<const Cluster> clusters, double otherwise) {
  const Cluster all = sum_of(clusters);
  const double p = share(all);
  const double effect = p == 0.0 || p == 1.0 ? otherwise : design_effect(clusters);
  return wilson(p, static_cast<double>(all.of) / effect,
                student(static_cast<double>(clusters.size()) - 1.0));
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
  if (values.size() < 2) {
    return {mean, mean, mean};
  }
  const double half = student(n - 1.0) * std::sqrt(squares.value() / (n - 1.0) / n);
  return {mean, mean - half, mean + half};
}

}  // namespace kairos::experiments
