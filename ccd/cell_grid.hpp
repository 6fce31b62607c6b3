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
  void around(const CellIndex& cell, std::vector<Id>& out) const;
  /// Of those around `now`, the ones that are not around `before`.
  void entered(const CellIndex& before, const CellIndex& now, std::vector<Id>& out) const;
  /// Notes that something that is in no cell reaches these cells, as far as they lie where bodies
  /// began; for good.
  void mark(const CellIndex& low, const CellIndex& high);
  /// Whether something may reach the cell.
  [[nodiscard]] bool may_be_reached(const CellIndex& cell) const {
    std::array<std::int64_t, 3> at_home{};
    for (std::size_t k = 0; k < 3; ++k) {
      at_home[k] = cell[k] - first_[k];
      if (!(static_cast<std::uint64_t>(at_home[k]) < static_cast<std::uint64_t>(count_[k]))) {
        return true;
      }
    }
    return cells_[at(at_home[0], at_home[1], at_home[2])].reached != 0;
  }

  /// Bodies in all cells from `low` to `high`.
  void within(const CellIndex& low, const CellIndex& high, std::vector<Id>& out) const;

 private:
  static constexpr Id none = ~Id{0};
  static constexpr std::uint32_t room = 2;
  /// Small, for most hold none or one. What finds no room is in a chain of further ones.
  struct Cell {
    Id next = none;
    std::uint16_t count = 0;
    std::uint16_t reached = 0;  ///< see `mark`
    std::array<Id, room> bodies{};
  };

  /// Where cell c is along an axis of the torus.
  [[nodiscard]] std::int64_t turned(std::int64_t c, std::size_t axis) const {
    const std::int64_t from = c - first_[axis];
    if (static_cast<std::uint64_t>(from) < static_cast<std::uint64_t>(count_[axis])) {
      return from;  // most are where bodies began: a division takes long
    }
    const std::int64_t rest = from % count_[axis];
    return rest < 0 ? rest + count_[axis] : rest;
  }
  /// The cell after that, along an axis of the torus.
  [[nodiscard]] std::int64_t next(std::int64_t turned, std::size_t axis) const {
    return turned + 1 == count_[axis] ? 0 : turned + 1;
  }
  /// The same of one that is less than a turn beyond the last.
  [[nodiscard]] std::int64_t beyond(std::int64_t turned, std::size_t axis) const {
    return turned < count_[axis] ? turned : turned - count_[axis];
  }
  [[nodiscard]] std::size_t at(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return static_cast<std::size_t>((z * count_[1] + y) * count_[0] + x);
  }
  [[nodiscard]] std::size_t place(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return at(turned(x, 0), turned(y, 1), turned(z, 2));
  }
  Cell& with_room(Cell& first);
  void block(const CellIndex& cell, const CellIndex& wide, std::vector<Id>& out) const;
  void append_chains(const CellIndex& first, const CellIndex& wide, std::vector<Id>& out) const;
  void append_chain(const Cell* cell, std::vector<Id>& out) const;

  std::array<std::int64_t, 3> count_{};
  std::array<std::int64_t, 3> first_{};
  std::vector<Cell> cells_;
  std::vector<Cell> chained_;
  Id free_ = none;
};

}  // namespace kairos::ccd
