// Clusters of bodies that nearly touch: which of them collapse, and when, against theory.

#include "core/schemes/event/impact_cluster.hpp"

#include "tests/catch.hpp"

#include <cmath>

using namespace kairos;

namespace {

using Kind = ClusterFate::Kind;

/// Balls of mass 1 on a line, from left to right; gap k is between ball k and ball k + 1.
ImpactCluster line(const std::vector<double>& gaps, const std::vector<double>& velocities,
                   double e) {
  ImpactCluster cluster;
  const std::size_t n = gaps.size();
  for (std::size_t k = 0; k < n; ++k) {
    cluster.contacts.push_back({gaps[k], velocities[k + 1] - velocities[k], 0.0, e});
    for (std::size_t j = 0; j < n; ++j) {
      cluster.coupling.push_back(j == k ? 2.0 : (j + 1 == k || k + 1 == j ? -1.0 : 0.0));
    }
  }
  return cluster;
}

}  // namespace

TEST_CASE("cluster: a bouncing ball comes to rest at the Zeno time", "[impacts][cluster]") {
  for (const double e : {0.0, 0.1, 0.5, 0.9, 0.99}) {
    CAPTURE(e);
    const double g = 9.8;
    const double h = 1.0;
    const ClusterFate fate = follow({{{h, 0.0, -g, e}}, {1.0}}, 1e9, 200'000);
    CHECK(fate.kind == Kind::accumulates);
    // The fall, and hops that are a geometric series: T (1 + e) / (1 - e).
    const double exact = std::sqrt(2.0 * h / g) * (1.0 + e) / (1.0 - e);
    CHECK(std::abs(fate.duration / exact - 1.0) <= 1e-12);  // roundoff of up to 5,500 impacts
  }
}

TEST_CASE("cluster: a ball that is not pressed leaves, an elastic one never comes to rest",
          "[impacts][cluster]") {
  CHECK(follow({{{1e-3, -1.0, 0.0, 0.5}}, {1.0}}, 1e9, 200'000).kind == Kind::parts);
  CHECK(follow({{{1e-3, -1.0, -9.8, 1.0}}, {1.0}}, 1e3, 200'000).kind == Kind::parts);
  CHECK(follow({{{1e-3, -1.0, -9.8, 1.0}}, {1.0}}, 1e9, 200'000).kind == Kind::undecided);
}

TEST_CASE("cluster: three balls on a line collapse below e = 7 - 4 sqrt(3), and not above",
          "[impacts][cluster]") {
  // [McNamara1992]: the outer two come in, the middle one goes to and fro between them.
  const double critical = 7.0 - 4.0 * std::sqrt(3.0);
  for (const double e : {0.01, 0.05, critical - 1e-3}) {
    CAPTURE(e);
    CHECK(follow(line({1.0, 1e-3}, {1.0, 0.0, -1.0}, e), 1e9, 200'000).kind == Kind::accumulates);
  }
  for (const double e : {critical + 1e-3, 0.1, 0.5, 1.0}) {
    CAPTURE(e);
    CHECK(follow(line({1.0, 1e-3}, {1.0, 0.0, -1.0}, e), 1e9, 200'000).kind == Kind::parts);
  }
}

TEST_CASE("cluster: n balls collapse that fewer could not", "[impacts][cluster]") {
  // n balls against each other, as n/2 against a wall: about e < 1 - 2 ln(2 n) / n  [Bernu1990].
  const auto collapses = [](std::size_t n, double e) {
    std::vector<double> velocities;
    for (std::size_t k = 0; k < n; ++k) {
      velocities.push_back(1.0 - 2.0 * static_cast<double>(k) / static_cast<double>(n - 1));
    }
    return follow(line(std::vector<double>(n - 1, 1e-3), velocities, e), 1e9, 200'000).kind ==
           Kind::accumulates;
  };
  CHECK(collapses(4, 0.15));
  CHECK_FALSE(collapses(3, 0.15));
  CHECK(collapses(16, 0.5));
  CHECK_FALSE(collapses(4, 0.5));
}

TEST_CASE("cluster: a finite sequence is finite, however long", "[impacts][cluster]") {
  // A wall, a ball of 1 kg, one of 100^k kg that comes in: floor(pi 10^k) impacts [Galperin2003].
  double mass = 1.0;
  for (const int digits : {3, 31, 314, 3141, 31415}) {
    CAPTURE(digits);
    const ImpactCluster blocks{{{1.0, 0.0, 0.0, 1.0}, {1.0, -1.0, 0.0, 1.0}},
                               {1.0, -1.0, -1.0, 1.0 + 1.0 / mass}};
    const ClusterFate fate = follow(blocks, 1e9, 200'000);
    CHECK(fate.kind == Kind::parts);
    CHECK(fate.impacts == digits);
    mass *= 100.0;
  }
}
