// Many bodies without overlap: where balls of given radii are put in a region.
#include "core/placement.hpp"

#include "core/random.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <numbers>

using namespace kairos;

namespace {

const Region cube{{-1.0, 2.0, 0.0}, {1.0, 4.0, 2.0}};

/// Every ball within the region, and no two in touch; all pairs.
void check_apart(const Region& region, const std::vector<Vector3>& centres,
                 const std::vector<double>& radii) {
  for (std::size_t i = 0; i < centres.size(); ++i) {
    // Not even by a rounding: a small ball near the origin would start inside a wall.
    const Vector3 margin = Vector3::Constant(radii[i]);
    REQUIRE((centres[i].array() >= (region.lowest + margin).array()).all());
    REQUIRE((centres[i].array() <= (region.highest - margin).array()).all());
    for (std::size_t k = 0; k < i; ++k) {
      REQUIRE((centres[i] - centres[k]).norm() > radii[i] + radii[k]);
    }
  }
}

double fraction(const Region& region, std::size_t count, double radius) {
  return static_cast<double>(count) * 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3) /
         (region.highest - region.lowest).prod();
}

}  // namespace

TEST_CASE("placement: a lattice holds balls apart, up to the count that it names",
          "[core][placement]") {
  Random random(1);
  INFO("seed 1");
  for (int trial = 0; trial < 60; ++trial) {
    Region region;
    region.lowest = {random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5)};
    const Vector3 size(random.log_uniform(0.3, 3), random.log_uniform(0.3, 3),
                       random.log_uniform(0.3, 3));
    region.highest = region.lowest + size;
    const double radius = random.log_uniform(0.05, 0.4);
    const std::size_t most = most_on_lattice(region, radius);
    CAPTURE(trial, most, radius, size);
    CHECK(lattice_sites(region, radius, most + 1).empty());
    for (const std::size_t count : {std::size_t{1}, most / 2, most}) {
      if (count >= 1 && count <= most) {
        const std::vector<Vector3> sites = lattice_sites(region, radius, count);
        REQUIRE(sites.size() == count);
        check_apart(region, sites, std::vector<double>(count, radius));
      }
    }
  }
}

TEST_CASE("placement: a lattice fills what the closest packing fills, but for its walls",
          "[core][placement]") {
  // pi / sqrt(18) = 0.74; of a cube of 40 diameters a layer of half a diameter is lost all round.
  const double radius = 1.0 / 40.0;
  const double filled = fraction(cube, most_on_lattice(cube, radius), radius);
  CHECK(filled > 0.68);
  CHECK(filled < 0.7405);
}

TEST_CASE("placement: random balls are apart, the same for a seed, and jam where theory says",
          "[core][placement]") {
  std::vector<double> radii(600, 0.06);
  for (std::size_t i = 0; i < radii.size(); i += 3) {
    radii[i] = 0.08;
  }
  const RandomSites sites = random_sites(cube, radii, 7);
  REQUIRE(sites.placed == radii.size());
  check_apart(cube, sites.centres, radii);
  CHECK(random_sites(cube, radii, 7).centres == sites.centres);
  CHECK(random_sites(cube, radii, 8).centres != sites.centres);
  // The first draw of the first ball: by any compiler, so that one scene is one scene.
  Random random(7);
  Vector3 first;
  for (int axis = 2; axis >= 0; --axis) {
    const double size = cube.highest[axis] - cube.lowest[axis] - 2.0 * radii[0];
    first[axis] = cube.lowest[axis] + radii[0] + size * random.uniform();
  }
  CHECK(sites.centres[0] == first);
  // They fill the region evenly: of 600 in either half, 300 with a deviation below 12.
  const auto low = std::count_if(sites.centres.begin(), sites.centres.end(),
                                 [](const Vector3& c) { return c.x() < 0.0; });
  CHECK(std::abs(static_cast<double>(low) - 300.0) < 60.0);
  // Equal balls jam at 0.384 of the volume; walls and 20,000 draws each leave it lower.
  const double radius = 0.08;
  const RandomSites full = random_sites(cube, std::vector<double>(2000, radius), 1);
  CHECK(full.placed < 2000);
  CHECK(fraction(cube, full.placed, radius) > 0.27);
  CHECK(fraction(cube, full.placed, radius) < 0.39);
}
