#pragma once

#include "core/reading/table_reader.hpp"
#include "core/shape.hpp"

#include <string>

namespace kairos {
inline namespace core {

/// The `part`s of a compound: convex shapes, each where it is. What moves freely has its centre of
/// mass at the origin; `directory`: of relative files.
[[nodiscard]] Shape read_compound(const TableReader& table, const std::string& directory,
                                  bool moves_freely);
/// `heights` over a grid of `spacing`, y up, as a surface about the middle of the grid.
[[nodiscard]] Shape read_height_field(const TableReader& table);

}  // namespace core
}  // namespace kairos
