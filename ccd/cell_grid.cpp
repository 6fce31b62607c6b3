#include "ccd/cell_grid.hpp"

#include "core/exponential.hpp"
#include "core/large_pages.hpp"
#include "core/prefetch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace kairos::ccd {
namespace {

/// Bodies this many times as large as most others are not in cells.
constexpr double unusual = 3.0;
/// Bodies to a cell at which looking through cells costs as much as crossing them.
constexpr double bodies_to_a_cell = 0.36;

}  // namespace

CellLayout::CellLayout(const Model& model, double tolerance, const CellSize& asked) {
  std::vector<double> radii;
  Vector3 low = Vector3::Zero();
  Vector3 high = Vector3::Zero();
  const auto is_usual = [&](BodyIndex i) {
    const double r = model.is_free(i) ? bounding_radius(model.shape(i)) : 0.0;
    return std::isfinite(r) && r > 0.0 ? r : 0.0;
  };
  for (BodyIndex i = 0; i < model.size(); ++i) {
    if (const double r = is_usual(i); r > 0.0) {
      radii.push_back(r);
    }
  }
  if (radii.empty()) {
    return;
  }
  std::sort(radii.begin(), radii.end());
  const double most = unusual * radii[radii.size() / 2];
  radius = *(std::upper_bound(radii.begin(), radii.end(), most) - 1);
  double n = 0.0;
  for (BodyIndex i = 0; i < model.size(); ++i) {
    const double r = is_usual(i);
    if (r > 0.0 && r <= radius) {
      const Vector3& p = model.body(i).initial.pose.position;
      low = n == 0.0 ? p : Vector3(low.cwiseMin(p));
      high = n == 0.0 ? p : Vector3(high.cwiseMax(p));
      n += 1.0;
    }
  }
  // A detector leaves a gap of its tolerance at most; no impact law acts across twice that.
  slack = 1e-3 * radius + 4.0 * tolerance;
  margin = asked.margin * radius / 16.0;
  const double least = 2.0 * (radius + slack + margin);
  Vector3 size = (high - low).cwiseMax(least);
  const Vector3 period =
      model.scene().periodic ? model.scene().periodic->period() : Vector3(Vector3::Zero());
  for (int k = 0; k < 3; ++k) {
    size[k] = period[k] > 0.0 ? period[k] : size[k];
  }
  const double usual = std::max(least, asked.width * cube_root(size.prod() * bodies_to_a_cell / n));
  width.setConstant(usual);
  farthest = std::min(0x1p36 * margin, 0x1p29 * usual);  // cells are counted in 32 bits
  // No more cells than the number of bodies calls for: along the longest axis they then coincide.
  double all = 1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    if (period[axis] > 0.0) {
      const double along = std::floor(period[axis] / usual);
      fits = fits && along >= 4.0;
      counts[k] = static_cast<std::int64_t>(std::clamp(along, 1.0, 0x1p20));
      width[axis] = period[axis] / static_cast<double>(counts[k]);
    } else {
      const double needed = size[axis] / usual + 3.0;
      counts[k] = static_cast<std::int64_t>(std::ceil(std::clamp(needed, 4.0, 0x1p20)));
      constexpr double countable = 0x1p30;
      const double begins = std::floor(low[axis] / usual) - 1.0;
      first[k] = std::abs(begins) < countable ? static_cast<std::int64_t>(begins) : 0;
    }
    all *= static_cast<double>(counts[k]);
  }
  per_width = width.cwiseInverse();
  while (all > 16.0 * n + 64.0) {
    std::size_t longest = 3;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool open = period[static_cast<Eigen::Index>(k)] == 0.0;
      const bool divides = open && counts[k] > 4;
      longest = divides && (longest == 3 || counts[k] > counts[longest]) ? k : longest;
    }
    if (longest == 3) {
      break;  // periods have as many cells as bodies call for, the rest as few as may be
    }
    all /= static_cast<double>(counts[longest]);
    counts[longest] = std::max<std::int64_t>(counts[longest] / 2, 4);
    all *= static_cast<double>(counts[longest]);
  }
}

CellGrid::CellGrid(const std::array<std::int64_t, 3>& counts,
                   const std::array<std::int64_t, 3>& first)
    : count_(counts),
      first_(first),
      cells_(scattered<Cell>(static_cast<std::size_t>(counts[0] * counts[1] * counts[2]))) {}

void CellGrid::mark(const CellIndex& low, const CellIndex& high) {
  CellIndex from{};
  CellIndex to{};
  for (std::size_t k = 0; k < 3; ++k) {
    from[k] = std::max<std::int64_t>(low[k] - first_[k], 0);
    to[k] = std::min(high[k] - first_[k], count_[k] - 1);
  }
  for (std::int64_t z = from[2]; z <= to[2]; ++z) {
    for (std::int64_t y = from[1]; y <= to[1]; ++y) {
      for (std::int64_t x = from[0]; x <= to[0]; ++x) {
        cells_[at(x, y, z)].reached = 1;
      }
    }
  }
}

void CellGrid::insert(const CellIndex& cell, BodyIndex i) {
  Cell* at = &cells_[place(cell[0], cell[1], cell[2])];
  if (at->count == room) {
    at = &with_room(*at);
  }
  at->bodies[at->count++] = static_cast<Id>(i);
}

/// The first of a chain of cells that has room.
CellGrid::Cell& CellGrid::with_room(Cell& first) {
  Id link = none;
  for (Id next = first.next; next != none; next = chained_[next].next) {
    link = next;
    if (chained_[next].count < room) {
      return chained_[next];
    }
  }
  Id fresh = free_;
  if (fresh == none) {
    fresh = static_cast<Id>(chained_.size());
    chained_.emplace_back();
  } else {
    free_ = chained_[fresh].next;
    chained_[fresh] = {};
  }
  (link == none ? first : chained_[link]).next = fresh;
  return chained_[fresh];
}

/// The last of the chain takes its place.
void CellGrid::remove(const CellIndex& cell, BodyIndex i) {
  Cell* last = &cells_[place(cell[0], cell[1], cell[2])];
  Cell* before = nullptr;
  Id* found = nullptr;
  while (true) {
    for (std::uint32_t k = 0; k < last->count; ++k) {
      if (last->bodies[k] == i) {
        found = &last->bodies[k];
      }
    }
    if (last->next == none) {
      break;
    }
    before = last;
    last = &chained_[last->next];
  }
  *found = last->bodies[--last->count];
  if (last->count == 0 && before != nullptr) {
    const Id empty = before->next;
    before->next = none;
    last->next = free_;
    free_ = empty;
  }
}

/// Appends the bodies of a cell and of those chained to it.
void CellGrid::append_chain(const Cell* cell, std::vector<Id>& out) const {
  while (true) {
    out.insert(out.end(), cell->bodies.begin(), cell->bodies.begin() + cell->count);
    if (cell->next == none) {
      return;
    }
    cell = &chained_[cell->next];
  }
}

void CellGrid::look_around(const CellIndex& cell) const {
  const std::int64_t x = turned(cell[0] - 1, 0);
  std::int64_t z = turned(cell[2] - 1, 2);
  for (int dz = 0; dz < 3; ++dz, z = next(z, 2)) {
    std::int64_t y = turned(cell[1] - 1, 1);
    for (int dy = 0; dy < 3; ++dy, y = next(y, 1)) {
      const std::size_t first = at(x, y, z);
      prefetch(cells_[first]);
      prefetch(cells_[std::min(first + 2, cells_.size() - 1)]);
    }
  }
}

void CellGrid::around(const CellIndex& cell, std::vector<Id>& out) const {
  block(cell, {1, 1, 1}, out);
}

/// Bodies in the cells at most one along each axis from a cell: `wide` is 0 or 1.
void CellGrid::block(const CellIndex& cell, const CellIndex& wide, std::vector<Id>& out) const {
  constexpr std::size_t most_cells = 27;
  CellIndex first{};
  for (std::size_t k = 0; k < 3; ++k) {
    first[k] = turned(cell[k] - wide[k], k);
  }
  const std::size_t before = out.size();
  out.resize(before + (most_cells + 1) * room);
  Id* end = out.data() + before;
  Id chains = none;
  const auto take = [&end, &chains](const Cell& of) {
    // Both places are copied, though most cells have none or one: this saves a branch.
    std::memcpy(end, of.bodies.data(), sizeof of.bodies);
    end += of.count;
    chains &= of.next;
  };
  const auto turns_along = [&](std::size_t axis) {
    return first[axis] + 2 * wide[axis] >= count_[axis];
  };
  const bool turns = turns_along(0);
  if (!turns && !turns_along(1) && !turns_along(2)) {  // most blocks lie as their cells do
    const Cell* layer = &cells_[at(first[0], first[1], first[2])];
    const std::int64_t to_next_layer = count_[0] * count_[1];
    for (std::int64_t dz = -wide[2]; dz <= wide[2]; ++dz, layer += to_next_layer) {
      const Cell* row = layer;
      for (std::int64_t dy = -wide[1]; dy <= wide[1]; ++dy, row += count_[0]) {
        take(row[0]);
        if (wide[0] != 0) {
          take(row[1]);
          take(row[2]);
        }
      }
    }
    out.resize(static_cast<std::size_t>(end - out.data()));
    if (chains != none) {
      append_chains(first, wide, out);
    }
    return;
  }
  std::int64_t z = first[2];
  for (std::int64_t dz = -wide[2]; dz <= wide[2]; ++dz, z = next(z, 2)) {
    std::int64_t y = first[1];
    for (std::int64_t dy = -wide[1]; dy <= wide[1]; ++dy, y = next(y, 1)) {
      const Cell* const row = &cells_[at(0, y, z)];
      if (wide[0] == 0) {
        take(row[first[0]]);
      } else if (!turns) {
        const Cell* const from = row + first[0];
        take(from[0]);
        take(from[1]);
        take(from[2]);
      } else {
        std::int64_t x = first[0];
        for (int dx = 0; dx < 3; ++dx, x = next(x, 0)) {
          take(row[x]);
        }
      }
    }
  }
  out.resize(static_cast<std::size_t>(end - out.data()));
  if (chains != none) {
    append_chains(first, wide, out);
  }
}

/// Appends the bodies for which the cells of a block have no room.
void CellGrid::append_chains(const CellIndex& first, const CellIndex& wide,
                             std::vector<Id>& out) const {
  for (std::int64_t dz = 0; dz <= 2 * wide[2]; ++dz) {
    for (std::int64_t dy = 0; dy <= 2 * wide[1]; ++dy) {
      for (std::int64_t dx = 0; dx <= 2 * wide[0]; ++dx) {
        const Cell& cell = cells_[at(beyond(first[0] + dx, 0), beyond(first[1] + dy, 1),
                                     beyond(first[2] + dz, 2))];
        if (cell.next != none) {
          append_chain(&chained_[cell.next], out);
        }
      }
    }
  }
}

void CellGrid::entered(const CellIndex& before, const CellIndex& now, std::vector<Id>& out) const {
  // Most often a body moves one cell on along one axis: to a layer of nine.
  std::size_t axis = 3;
  std::int64_t steps = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    steps += std::abs(now[k] - before[k]);
    axis = now[k] != before[k] ? k : axis;
  }
  if (steps == 1) {
    CellIndex layer = now;
    CellIndex wide{1, 1, 1};
    layer[axis] += now[axis] - before[axis];
    wide[axis] = 0;
    return block(layer, wide, out);
  }
  const auto known = [&](std::size_t k, std::int64_t c) { return std::abs(c - before[k]) <= 1; };
  for (std::int64_t z = now[2] - 1; z <= now[2] + 1; ++z) {
    for (std::int64_t y = now[1] - 1; y <= now[1] + 1; ++y) {
      for (std::int64_t x = now[0] - 1; x <= now[0] + 1; ++x) {
        if (!(known(0, x) && known(1, y) && known(2, z))) {
          append_chain(&cells_[place(x, y, z)], out);
        }
      }
    }
  }
}

void CellGrid::within(const CellIndex& low, const CellIndex& high, std::vector<Id>& out) const {
  for (std::int64_t z = low[2]; z <= high[2]; ++z) {
    for (std::int64_t y = low[1]; y <= high[1]; ++y) {
      for (std::int64_t x = low[0]; x <= high[0]; ++x) {
        append_chain(&cells_[place(x, y, z)], out);
      }
    }
  }
}

}  // namespace kairos::ccd
