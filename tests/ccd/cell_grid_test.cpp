#include "ccd/cell_grid.hpp"

#include "core/random.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

using namespace kairos;
using ccd::CellGrid;
using ccd::CellIndex;

namespace {

/// Whether two cells are at most so far apart along each axis, on the torus.
bool within(const CellIndex& a, const CellIndex& b, std::int64_t far,
            const std::array<std::int64_t, 3>& counts) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t apart = ((a[k] - b[k]) % counts[k] + counts[k]) % counts[k];
    if (std::min(apart, counts[k] - apart) > far) {
      return false;
    }
  }
  return true;
}

}  // namespace

// Few cells with many bodies, so that most hold more than their two places and chains grow, shrink
// and give back their links; odd and even numbers of cells, and cells turns away from home.
TEST_CASE("a grid of cells tells who is around, however many share a cell", "[cells]") {
  constexpr std::uint64_t seed = 5;
  INFO("seed " << seed);
  Random random(seed);
  for (const std::array<std::int64_t, 3>& counts :
       {std::array<std::int64_t, 3>{4, 5, 7}, {6, 4, 9}, {5, 5, 4}}) {
    const std::array<std::int64_t, 3> first{-2, 3, 0};
    CellGrid grid(counts, first);
    std::vector<CellIndex> cells;
    const auto anywhere = [&] {
      const bool crowds = random.uniform() < 0.3;
      CellIndex cell{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int64_t turns = static_cast<std::int64_t>(random.uniform(0.0, 3.0)) - 1;
        const double n = crowds ? 2.0 : static_cast<double>(counts[k]);
        cell[k] = first[k] + static_cast<std::int64_t>(random.uniform(0.0, n)) + turns * counts[k];
      }
      return cell;
    };
    const auto told_as = [&](std::vector<CellGrid::Id> told, const auto& is_told) {
      std::vector<CellGrid::Id> expected;
      for (CellGrid::Id j = 0; j < cells.size(); ++j) {
        if (is_told(cells[j])) {
          expected.push_back(j);
        }
      }
      std::sort(told.begin(), told.end());
      CHECK(told == expected);
    };
    for (CellGrid::Id i = 0; i < 300; ++i) {
      cells.push_back(anywhere());
      grid.insert(cells[i], i);
    }
    for (int k = 0; k < 4000; ++k) {
      const auto i = static_cast<CellGrid::Id>(random.uniform(0.0, 300.0));
      grid.remove(cells[i], i);
      cells[i] = anywhere();
      grid.insert(cells[i], i);
      if (k % 20 != 0) {
        continue;
      }
      const CellIndex at = anywhere();
      std::vector<CellGrid::Id> told;
      grid.around(at, told);
      told_as(told, [&](const CellIndex& cell) { return within(cell, at, 1, counts); });
      CellIndex next = at;
      next[static_cast<std::size_t>(k / 20 % 3)] += k / 60 % 2 == 0 ? 1 : -1;
      told.clear();
      grid.entered(at, next, told);
      told_as(told, [&](const CellIndex& cell) {
        return within(cell, next, 1, counts) && !within(cell, at, 1, counts);
      });
    }
  }
}
