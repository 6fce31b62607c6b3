#include "core/schemes/event/impact_cluster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Speeds that have shrunk by this factor are below what doubles resolve, by half as many digits
/// again.
constexpr double vanished = 1e-24;
/// How many impacts in a row, for each contact, may take no time: elastic ones hand on their
/// momentum and end.
constexpr std::int64_t timeless = 64;

/// When the gap g + u t + a t^2 / 2 closes, s; infinite if it does not.
double time_to_impact(const ClusterContact& c) {
  if (c.gap <= 0.0 && (c.rate < 0.0 || (c.rate == 0.0 && c.acceleration < 0.0))) {
    return 0.0;
  }
  const double discriminant = c.rate * c.rate - 2.0 * c.acceleration * c.gap;
  if (discriminant < 0.0) {
    return infinity;
  }
  const double root = std::sqrt(discriminant);
  if (c.rate < 0.0) {
    return 2.0 * c.gap / (root - c.rate);
  }
  return c.acceleration < 0.0 ? (c.rate + root) / -c.acceleration : infinity;
}

void advance(ImpactCluster& cluster, double dt) {
  for (ClusterContact& c : cluster.contacts) {
    c.gap = std::max(c.gap + (c.rate + 0.5 * c.acceleration * dt) * dt, 0.0);
    c.rate += c.acceleration * dt;
  }
}

/// Applies Newton's law at contact j, which changes the rates of the others.
void strike(ImpactCluster& cluster, std::size_t j) {
  const std::size_t n = cluster.contacts.size();
  ClusterContact& hit = cluster.contacts[j];
  const double rebound = -hit.restitution * hit.rate;
  const double impulse = (rebound - hit.rate) / cluster.coupling[j * n + j];
  for (std::size_t i = 0; i < n; ++i) {
    cluster.contacts[i].rate += cluster.coupling[i * n + j] * impulse;
  }
  hit.gap = 0.0;
  hit.rate = rebound;
}

}  // namespace

ClusterFate follow(ImpactCluster cluster, double horizon, std::int64_t most_impacts) {
  const auto n = static_cast<std::int64_t>(cluster.contacts.size());
  ClusterFate fate;
  double fastest = 0.0;      // impact so far
  std::int64_t weak = 0;     // impacts in a row that are negligible beside it
  std::int64_t at_once = 0;  // impacts in a row that take no time
  for (; fate.impacts < most_impacts; ++fate.impacts) {
    std::size_t next = 0;
    double dt = infinity;
    for (std::size_t i = 0; i < cluster.contacts.size(); ++i) {
      if (const double s = time_to_impact(cluster.contacts[i]); s < dt) {
        dt = s;
        next = i;
      }
    }
    if (!(fate.duration + dt <= horizon)) {
      fate.kind = ClusterFate::Kind::parts;
      return fate;
    }
    advance(cluster, dt);
    const double speed = -cluster.contacts[next].rate;
    fastest = std::max(fastest, speed);
    weak = speed <= vanished * fastest ? weak + 1 : 0;
    at_once = dt <= vanished * fate.duration ? at_once + 1 : 0;
    fate.duration += dt;
    if (weak > n || (at_once > timeless * n && fate.duration > 0.0)) {
      fate.kind = ClusterFate::Kind::accumulates;
      return fate;
    }
    strike(cluster, next);
  }
  return fate;
}

}  // namespace core
}  // namespace kairos
