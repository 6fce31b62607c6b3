#pragma once

#include "core/model.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace kairos::ccd {

using CellIndex = std::array<std::int64_t, 3>;

/// Multiples of the size of cells that costs least: a width that is too small is made as large as
/// it must be.
struct CellSize {
  double width = 1.0;   ///< > 0
  double margin = 1.0;  ///< > 0
};

/// How large cells are, from the bodies that a model starts with.
struct CellLayout {
  /// `tolerance` as in `NeighbourhoodFactory`.
  CellLayout(const Model& model, double tolerance, const CellSize& asked);

  double radius = 0.0;  ///< greatest bounding radius of bodies in cells, m
  double slack = 0.0;   ///< what detectors may leave between bodies that touch, errors included, m
  double margin = 0.0;  ///< how far a body goes beyond its cell before it crosses, m
  /// Of a cell: two bodies that touch are at most radii and slacks apart, and two that are not in
  /// neighbouring cells at least the width less two margins.
  Vector3 width = Vector3::Ones();
  Vector3 per_width = Vector3::Ones();  ///< its inverse
  double farthest = 0.0;                ///< coordinates beyond this resolve no margin, m
  /// Of cells along each axis: as many as bodies take up at the start, or as divide a period.
  std::array<std::int64_t, 3> counts{4, 4, 4};
  std::array<std::int64_t, 3> first{};  ///< the cell along each axis with which that begins
  bool fits = true;                     ///< whether periods have room for at least four cells each
};

/// Bodies by cell, on a torus: cells a whole number of turns apart are one.
///
/// A cell takes eight bytes, and two along each axis are a brick, a line of the cache: those around
/// a cell are in eight bricks.
class CellGrid {
 public:
  using Id = std::uint32_t;  ///< of a body

  /// `first`: so many cells from there on lie in a row.
  CellGrid(const std::array<std::int64_t, 3>& counts, const std::array<std::int64_t, 3>& first);

  [[nodiscard]] std::int64_t count(std::size_t axis) const { return count_[axis]; }

  void insert(const CellIndex& cell, BodyIndex i);
  void remove(const CellIndex& cell, BodyIndex i);

  /// Those are about to be asked for.
  void look_around(const CellIndex& cell) const;
  /// Bodies in the cell and its 26 neighbours, appended.
  void around(const CellIndex& cell, std::vector<Id>& out) const {
    block({cell[0] - 1, cell[1] - 1, cell[2] - 1}, {3, 3, 3}, out);
  }
  /// Of those around `now`, the ones that are not around `before`.
  void entered(const CellIndex& before, const CellIndex& now, std::vector<Id>& out) const;
  /// Notes that something that is in no cell reaches these cells, as far as they lie where bodies
  /// began; for good.
  void mark(const CellIndex& low, const CellIndex& high);
  /// Whether something may reach the cell.
  [[nodiscard]] bool may_be_reached(const CellIndex& cell) const {
    std::size_t there = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t at_home = cell[k] - first_[k];
      if (!(static_cast<std::uint64_t>(at_home) < static_cast<std::uint64_t>(count_[k]))) {
        return true;
      }
      there += along_[k][static_cast<std::size_t>(at_home)];
    }
    return reached_[there];
  }

  /// Bodies in all cells from `low` to `high`.
  void within(const CellIndex& low, const CellIndex& high, std::vector<Id>& out) const;

 private:
  /// Bits that no body has: of what is none, and of a link to a chain of further bodies.
  static constexpr Id no_body = Id{1} << 31U;
  static constexpr Id is_chain = Id{1} << 30U;
  static constexpr Id none = no_body;
  /// Most hold none or one.
  struct Cell {
    Id first = none;
    Id second = none;  ///< or the link to all but the first, where there are more than two
  };
  struct Link {
    Id body = none;
    Id next = none;  ///< as in a cell
  };
  static constexpr std::size_t to_brick = 8;  ///< cells

  [[nodiscard]] static bool is_link(Id x) { return (x & is_chain) != 0; }
  [[nodiscard]] Link& link(Id x) { return links_[x & ~(no_body | is_chain)]; }
  [[nodiscard]] const Link& link(Id x) const { return links_[x & ~(no_body | is_chain)]; }
  [[nodiscard]] Id make_link(Id body, Id next);
  /// Gives it back; returns what it held.
  Link take_link(Id x);

  /// Where cell c is along an axis of the torus.
  [[nodiscard]] std::int64_t turned(std::int64_t c, std::size_t axis) const {
    const std::int64_t from = c - first_[axis];
    if (static_cast<std::uint64_t>(from) < static_cast<std::uint64_t>(count_[axis])) {
      return from;  // most are where bodies began: a division takes long
    }
    const std::int64_t rest = from % count_[axis];
    return rest < 0 ? rest + count_[axis] : rest;
  }
  /// What that adds to the place of a cell, and after it what those that come next add.
  [[nodiscard]] const std::size_t* along(std::int64_t c, std::size_t axis) const {
    return &along_[axis][static_cast<std::size_t>(turned(c, axis))];
  }
  [[nodiscard]] std::size_t place(const CellIndex& cell) const {
    return *along(cell[0], 0) + *along(cell[1], 1) + *along(cell[2], 2);
  }
  [[nodiscard]] const Cell& at(std::size_t place) const { return cells_[begin_ + place]; }
  [[nodiscard]] Cell& at(std::size_t place) { return cells_[begin_ + place]; }
  template <typename See>
  void see_block(const CellIndex& low, const CellIndex& counts, const See& see) const;
  void block(const CellIndex& low, const CellIndex& counts, std::vector<Id>& out) const;
  void append(const Cell& cell, std::vector<Id>& out) const;
  void append_chain(Id link, std::vector<Id>& out) const;

  std::array<std::int64_t, 3> count_{};
  std::array<std::int64_t, 3> first_{};
  std::array<std::vector<std::size_t>, 3> along_;  ///< by cell, and of the first two once more
  std::vector<Cell> cells_;
  std::size_t begin_ = 0;      ///< of them, where the first brick is a line of the cache
  std::vector<bool> reached_;  ///< see `mark`
  std::vector<Link> links_;
  Id free_ = none;  ///< a link that nobody needs, and so on
};

}  // namespace kairos::ccd
