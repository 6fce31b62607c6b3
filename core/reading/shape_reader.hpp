#pragma once

#include "core/reading/table_reader.hpp"
#include "core/shape.hpp"

#include <span>
#include <string_view>

namespace kairos {
inline namespace core {

/// `shape` and the keys of all sizes.
[[nodiscard]] std::span<const std::string_view> shape_keys();
/// Reads `shape` and the keys of its size; `directory`: of relative files. What moves freely turns
/// about its centre of mass: its mesh is put there. Others keep the origin of the file.
[[nodiscard]] Shape read_shape(const TableReader& table, const std::string& directory,
                               bool moves_freely);

}  // namespace core
}  // namespace kairos
