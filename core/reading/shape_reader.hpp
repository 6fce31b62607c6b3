#pragma once

#include "core/reading/table_reader.hpp"
#include "core/shape.hpp"

namespace kairos {
inline namespace core {

/// Reads `shape` and the keys of its size; `directory`: of relative files.
[[nodiscard]] Shape read_shape(const TableReader& table, const std::string& directory);

}  // namespace core
}  // namespace kairos
