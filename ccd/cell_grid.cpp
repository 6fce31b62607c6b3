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
  // The more margin, the fewer cross: a body that turns back soon does not.
  margin = std::max(margin, 0.5 * width.minCoeff() - radius - slack);
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
    : count_(counts), first_(first) {
  std::size_t all = to_brick;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto n = static_cast<std::size_t>(counts[k]);
    for (std::size_t c = 0; c < n + 2; ++c) {
      along_[k].push_back((c % n) / 2 * all + ((c % n) % 2 << k));
    }
    all *= (n + 1) / 2;
  }
  cells_ = scattered<Cell>(all + to_brick);
  reached_.resize(all);
  constexpr std::size_t line = to_brick * sizeof(Cell);
  const auto beyond = reinterpret_cast<std::uintptr_t>(cells_.data()) % line / sizeof(Cell);
  begin_ = (to_brick - beyond) % to_brick;
}

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
        reached_[place({first_[0] + x, first_[1] + y, first_[2] + z})] = true;
      }
    }
  }
}

CellGrid::Id CellGrid::make_link(Id body, Id next) {
  Id fresh = free_;
  if (fresh == none) {
    fresh = static_cast<Id>(links_.size()) | no_body | is_chain;
    links_.emplace_back();
  } else {
    free_ = link(fresh).next;
  }
  link(fresh) = {body, next};
  return fresh;
}

CellGrid::Link CellGrid::take_link(Id x) {
  const Link held = link(x);
  link(x).next = free_;
  free_ = x;
  return held;
}

void CellGrid::insert(const CellIndex& cell, BodyIndex i) {
  const auto body = static_cast<Id>(i);
  Cell& of = at(place(cell));
  if (of.first == none) {
    of.first = body;
  } else if (of.second == none) {
    of.second = body;
  } else {
    const Id rest = is_link(of.second) ? of.second : make_link(of.second, none);
    of.second = make_link(body, rest);
  }
}

void CellGrid::remove(const CellIndex& cell, BodyIndex i) {
  Cell& of = at(place(cell));
  if (!is_link(of.second)) {
    of.first = of.first == i ? of.second : of.first;
    of.second = none;
    return;
  }
  Id* found = &of.second;
  if (of.first == i) {
    of.first = link(*found).body;
  } else {
    while (link(*found).body != i) {
      found = &link(*found).next;
    }
  }
  *found = take_link(*found).next;
  if (link(of.second).next == none) {  // one is left beside the first
    of.second = take_link(of.second).body;
  }
}

void CellGrid::append(const Cell& cell, std::vector<Id>& out) const {
  for (const Id x : {cell.first, cell.second}) {
    if (is_link(x)) {
      append_chain(x, out);
    } else if (x != none) {
      out.push_back(x);
    }
  }
}

void CellGrid::append_chain(Id link_to, std::vector<Id>& out) const {
  for (; link_to != none; link_to = link(link_to).next) {
    out.push_back(link(link_to).body);
  }
}

void CellGrid::look_around(const CellIndex& cell) const {
  const std::size_t* const x = along(cell[0] - 1, 0);
  const std::size_t* const y = along(cell[1] - 1, 1);
  const std::size_t* const z = along(cell[2] - 1, 2);
  for (const std::size_t layer : {z[0], z[2]}) {
    for (const std::size_t row : {layer + y[0], layer + y[2]}) {
      prefetch(at(row + x[0]));
      prefetch(at(row + x[2]));
    }
  }
}

/// Shows so many cells along each axis, one to three, the lowest of which is `low`.
template <typename See>
void CellGrid::see_block(const CellIndex& low, const CellIndex& counts, const See& see) const {
  const std::size_t* const x = along(low[0], 0);
  const std::size_t* const y = along(low[1], 1);
  const std::size_t* const z = along(low[2], 2);
  const auto see_rows = [&](const auto& see_row) {
    const Cell* const all = cells_.data() + begin_;
    const std::size_t* const end_y = y + counts[1];
    const std::size_t* const end_z = z + counts[2];
    for (const std::size_t* of_z = z; of_z != end_z; ++of_z) {
      const Cell* const layer = all + *of_z;
      for (const std::size_t* of_y = y; of_y != end_y; ++of_y) {
        see_row(layer + *of_y);
      }
    }
  };
  const std::size_t first = x[0];
  const std::size_t second = x[1];
  if (counts[0] == 1) {
    see_rows([&](const Cell* row) { see(row[first]); });
  } else if (counts[0] == 2) {
    see_rows([&](const Cell* row) {
      see(row[first]);
      see(row[second]);
    });
  } else {
    see_rows([&, third = x[2]](const Cell* row) {
      see(row[first]);
      see(row[second]);
      see(row[third]);
    });
  }
}

void CellGrid::block(const CellIndex& low, const CellIndex& counts, std::vector<Id>& out) const {
  constexpr std::size_t most_cells = 27;
  std::array<Id, 2 * most_cells> found;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  std::size_t count = 0;
  Id all = 0;
  see_block(low, counts, [&found, &count, &all](const Cell& of) {
    // Both are copied, though most cells have none or one: this saves a branch.
    std::memcpy(&found[count], &of, sizeof of);
    count += 2 - (of.first >> 31U) - (of.second >> 31U);
    all |= of.second;
  });
  out.insert(out.end(), found.data(), found.data() + count);
  if ((all & is_chain) != 0) {
    see_block(low, counts, [this, &out](const Cell& of) {
      if (is_link(of.second)) {
        append_chain(of.second, out);
      }
    });
  }
}

void CellGrid::entered(const CellIndex& before, const CellIndex& now, std::vector<Id>& out) const {
  std::array<std::int64_t, 3> steps{};
  std::int64_t farthest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    steps[k] = now[k] - before[k];
    farthest = std::max(farthest, std::abs(steps[k]));
  }
  if (farthest <= 1) {  // a layer for each axis, most often one
    CellIndex low{now[0] - 1, now[1] - 1, now[2] - 1};
    CellIndex counts{3, 3, 3};
    for (std::size_t k = 0; k < 3; ++k) {
      if (steps[k] == 0) {
        continue;
      }
      const std::int64_t rest = steps[k] > 0 ? low[k] : low[k] + 1;
      low[k] = now[k] + steps[k];
      counts[k] = 1;
      block(low, counts, out);
      low[k] = rest;
      counts[k] = 2;
    }
    return;
  }
  const auto known = [&](std::size_t k, std::int64_t c) { return std::abs(c - before[k]) <= 1; };
  for (std::int64_t z = now[2] - 1; z <= now[2] + 1; ++z) {
    for (std::int64_t y = now[1] - 1; y <= now[1] + 1; ++y) {
      for (std::int64_t x = now[0] - 1; x <= now[0] + 1; ++x) {
        if (!(known(0, x) && known(1, y) && known(2, z))) {
          append(at(place({x, y, z})), out);
        }
      }
    }
  }
}

void CellGrid::within(const CellIndex& low, const CellIndex& high, std::vector<Id>& out) const {
  for (std::int64_t z = low[2]; z <= high[2]; ++z) {
    for (std::int64_t y = low[1]; y <= high[1]; ++y) {
      for (std::int64_t x = low[0]; x <= high[0]; ++x) {
        append(at(place({x, y, z})), out);
      }
    }
  }
}

}  // namespace kairos::ccd
