#pragma once

#include "core/pose.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace kairos {
inline namespace core {

/// A box along the axes of the world, m.
struct Region {
  Vector3 lowest = Vector3::Zero();
  Vector3 highest = Vector3::Zero();
};

/// How many balls of one radius (m) the lattice of `lattice_sites` holds at most within a region.
[[nodiscard]] std::size_t most_on_lattice(const Region& region, double radius);
/// Centres of `count` balls of one radius (m) that lie within a region and do not touch, m: sites
/// of the widest face-centred cubic lattice that has as many, spread over all of them. Empty if
/// even the narrowest has fewer (see `most_on_lattice`).
[[nodiscard]] std::vector<Vector3> lattice_sites(const Region& region, double radius,
                                                 std::size_t count);

/// Centres of balls at random, m.
struct RandomSites {
  std::vector<Vector3> centres;  ///< in the order of the radii; meaningless if not all are placed
  std::size_t placed = 0;        ///< how many found a place
};
/// Random sequential addition [Widom1966]: the greatest first, each is drawn uniformly within the
/// region until it touches none that is there. It ends where a ball finds no place in 20,000 draws:
/// equal balls jam at 0.384 of the volume. The same for the same seed: a draw takes z, y, x of
/// `Random(seed)`, in this order.
[[nodiscard]] RandomSites random_sites(const Region& region, std::span<const double> radii,
                                       std::uint64_t seed);

}  // namespace core
}  // namespace kairos
