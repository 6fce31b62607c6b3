#pragma once

#include "ccd/cell_grid.hpp"
#include "core/model.hpp"
#include "core/neighbourhood.hpp"

#include <memory>

namespace kairos::ccd {

/// `cells`: space is divided into cubes that no two bodies can touch across [Lubachevsky1991].
///
/// What moves freely and is of about the usual size is in the cell of its origin; it crosses when
/// it has gone some way beyond that cell (so that it does not go to and fro), and is then told of
/// one layer of cells. Cells are a torus: space is open, and those of far regions coincide, which
/// costs queries and loses no pair. All else (half-spaces, fixed and driven bodies, bodies more
/// than three times as large as most, coordinates too far for doubles, motions that are known only
/// roughly) is in a tree of swept boxes, and is near every cell that its box reaches.
///
/// Memory: some 80 bytes a body of a gas, at most 350, allocated at the start.
[[nodiscard]] std::unique_ptr<Neighbourhood> make_cells(const Model& model, double tolerance);

/// Cells of another size than the one that costs least. No result depends on it.
[[nodiscard]] NeighbourhoodFactory cells_of(const CellSize& size);

}  // namespace kairos::ccd
