#include "core/placement.hpp"

#include "core/exponential.hpp"
#include "core/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace kairos {
inline namespace core {
namespace {

constexpr double apart = 1.0 + 1e-9;  // neighbours are so many diameters apart: they do not touch
constexpr int most_draws = 20'000;
constexpr int halvings = 200;

/// What is left of a region for the centres of balls; negative where there is no room.
Vector3 room(const Region& region, double radius) {
  return region.highest - region.lowest - Vector3::Constant(2.0 * radius);
}

/// Where sums that were rounded may have left the region, the nearest centre within it.
Vector3 within(const Region& region, double radius, const Vector3& centre) {
  const Vector3 margin = Vector3::Constant(radius);
  return centre.cwiseMax(region.lowest + margin).cwiseMin(region.highest - margin);
}

/// Sites of a face-centred cubic lattice whose cubes have the side 2 s: of the points s (i, j, k)
/// those with an even sum. Neighbours are s sqrt(2) apart.
struct Lattice {
  std::array<std::size_t, 3> points{};

  [[nodiscard]] double sites() const {
    const double product = static_cast<double>(points[0]) * static_cast<double>(points[1]) *
                           static_cast<double>(points[2]);
    return std::ceil(0.5 * product);
  }
};

Lattice lattice(const Vector3& size, double s) {
  // No scene may ask for more bodies than that.
  constexpr double most = 1e7;
  Lattice result;
  for (std::size_t k = 0; k < 3; ++k) {
    const double steps = std::floor(size[static_cast<Eigen::Index>(k)] / s);
    result.points[k] = static_cast<std::size_t>(std::min(steps, most)) + 1;
  }
  return result;
}

double narrowest(double radius) { return 2.0 * radius * apart / std::sqrt(2.0); }

/// Balls that were placed, by cells at least as wide as the greatest of them.
class Cells {
 public:
  Cells(const Region& region, double greatest_radius, std::size_t count)
      : lowest_(region.lowest), next_(count, none) {
    const Vector3 size = region.highest - region.lowest;
    const double share = cube_root(size.prod() / static_cast<double>(count));
    width_ = std::max(2.0 * greatest_radius, share);
    std::size_t cells = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const double along = std::floor(size[static_cast<Eigen::Index>(k)] / width_);
      cells_[k] = static_cast<long>(std::min(along, 1024.0)) + 1;
      cells *= static_cast<std::size_t>(cells_[k]);
    }
    first_.assign(cells, none);
  }

  void add(std::size_t i, const Vector3& centre) {
    std::size_t& first = first_[index(cell(centre))];
    next_[i] = first;
    first = i;
  }

  /// Calls visit(i) for whatever could touch a ball of at most the greatest radius at `centre`,
  /// until it says false.
  template <typename Visit>
  [[nodiscard]] bool all_near(const Vector3& centre, const Visit& visit) const {
    const auto [x, y, z] = cell(centre);
    for (long i = std::max(x - 1, 0L); i <= std::min(x + 1, cells_[0] - 1); ++i) {
      for (long j = std::max(y - 1, 0L); j <= std::min(y + 1, cells_[1] - 1); ++j) {
        for (long k = std::max(z - 1, 0L); k <= std::min(z + 1, cells_[2] - 1); ++k) {
          for (std::size_t b = first_[index({i, j, k})]; b != none; b = next_[b]) {
            if (!visit(b)) {
              return false;
            }
          }
        }
      }
    }
    return true;
  }

 private:
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

  [[nodiscard]] std::array<long, 3> cell(const Vector3& centre) const {
    std::array<long, 3> result{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      const auto along = static_cast<long>((centre[axis] - lowest_[axis]) / width_);
      result[k] = std::clamp(along, 0L, cells_[k] - 1);
    }
    return result;
  }
  [[nodiscard]] std::size_t index(const std::array<long, 3>& c) const {
    return static_cast<std::size_t>((c[0] * cells_[1] + c[1]) * cells_[2] + c[2]);
  }

  Vector3 lowest_;
  double width_ = 1.0;
  std::array<long, 3> cells_{};
  std::vector<std::size_t> first_;
  std::vector<std::size_t> next_;
};

}  // namespace

std::size_t most_on_lattice(const Region& region, double radius) {
  const Vector3 size = room(region, radius);
  return (size.array() < 0.0).any()
             ? 0
             : static_cast<std::size_t>(std::min(lattice(size, narrowest(radius)).sites(), 1e15));
}

std::vector<Vector3> lattice_sites(const Region& region, double radius, std::size_t count) {
  if (count == 0 || most_on_lattice(region, radius) < count) {
    return {};
  }
  const Vector3 size = room(region, radius);
  const auto enough = static_cast<double>(count);
  double low = narrowest(radius);  // this side has enough sites
  double high = 2.0 * std::max(size.maxCoeff(), low);
  for (int i = 0; i < halvings && low < high; ++i) {
    const double middle = low + 0.5 * (high - low);
    (lattice(size, middle).sites() >= enough ? low : high) = middle;
    if (middle == low && middle == high) {
      break;
    }
  }
  const Lattice widest = lattice(size, low);
  const auto& [nx, ny, nz] = widest.points;
  Vector3 corner = region.lowest + Vector3::Constant(radius);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    corner[axis] += 0.5 * (size[axis] - low * static_cast<double>(widest.points[k] - 1));
  }
  const auto sites = static_cast<std::size_t>(widest.sites());
  std::vector<Vector3> centres;
  centres.reserve(count);
  std::size_t site = 0;
  for (std::size_t i = 0; i < nx; ++i) {
    for (std::size_t j = 0; j < ny; ++j) {
      for (std::size_t k = (i + j) % 2; k < nz; k += 2, ++site) {
        // The m-th body is on site m sites / count, rounded down.
        if (centres.size() < count && site >= centres.size() * sites / count) {
          const Vector3 steps(static_cast<double>(i), static_cast<double>(j),
                              static_cast<double>(k));
          centres.push_back(within(region, radius, corner + low * steps));
        }
      }
    }
  }
  return centres;
}

RandomSites random_sites(const Region& region, std::span<const double> radii, std::uint64_t seed) {
  RandomSites sites;
  sites.centres.assign(radii.size(), Vector3::Zero());
  if (radii.empty()) {
    return sites;
  }
  std::vector<std::size_t> order(radii.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return radii[a] > radii[b]; });
  Cells cells(region, radii[order.front()], radii.size());
  Random random(seed);
  for (const std::size_t i : order) {
    const Vector3 size = room(region, radii[i]);
    bool found = false;
    for (int draw = 0; draw < most_draws && !found && (size.array() >= 0.0).all(); ++draw) {
      // One draw a statement: compilers differ in which argument they make first.
      const double z = random.uniform();
      const double y = random.uniform();
      const double x = random.uniform();
      const Vector3 part(x, y, z);
      const Vector3 centre = within(
          region, radii[i], region.lowest + Vector3::Constant(radii[i]) + size.cwiseProduct(part));
      found = cells.all_near(centre, [&](std::size_t b) {
        const double reach = (radii[i] + radii[b]) * apart;
        return (sites.centres[b] - centre).squaredNorm() > reach * reach;
      });
      if (found) {
        sites.centres[i] = centre;
        cells.add(i, centre);
      }
    }
    if (!found) {
      return sites;
    }
    ++sites.placed;
  }
  return sites;
}

}  // namespace core
}  // namespace kairos
