#pragma once

#include "core/shape.hpp"
#include "simulation/output/json_writer.hpp"

#include <string_view>

namespace kairos {
inline namespace simulation {

/// A member with x, y, z.
void add_vector(JsonWriter& json, std::string_view key, const Vector3& v);

/// A member that says all that a page needs to draw the shape, body frame, m: its kind; half
/// extents of the box around the origin that contains it, or a half-space's normal, as x, y, z; of
/// a capsule, cylinder or cone its radius and its length along y; of a hull its rounding and the
/// vertices before it; the vertices and triangles of a mesh; the parts of a compound. What the page
/// has no drawing of is drawn as its box.
void add_shape(JsonWriter& json, std::string_view key, const Shape& shape);

}  // namespace simulation
}  // namespace kairos
