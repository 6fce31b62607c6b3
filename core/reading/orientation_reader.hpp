#pragma once

#include "core/reading/table_reader.hpp"

namespace kairos {
inline namespace core {

/// `orientation` or `axis_angle` of a table: body to world; the identity where neither is there.
[[nodiscard]] Quaternion read_orientation(const TableReader& table);
/// v made unit; as it was written where it is so to its roundings. `item`: whom to complain about.
[[nodiscard]] Vector3 read_direction(const Item& item, const Vector3& v);

}  // namespace core
}  // namespace kairos
