#pragma once

#include "core/reading/table_reader.hpp"
#include "core/shape.hpp"

namespace kairos {
inline namespace core {

/// A shape as it was written, and how the axes that it was written in lie in those of the body: a
/// hull is stored in its principal axes.
struct WrittenShape {
  Shape shape;
  Quaternion axes = Quaternion::Identity();  ///< from the body's axes to those of the file
};

/// Reads `shape` and the keys of its size; `directory`: of relative files.
[[nodiscard]] WrittenShape read_shape(const TableReader& table, const std::string& directory);

}  // namespace core
}  // namespace kairos
