#pragma once

#include "simulation/view/packed_arrays.hpp"

#include <array>
#include <string>
#include <string_view>

namespace kairos::studio {

/// What the page is told: names and texts as JSON, numbers as one block that the JSON describes.
struct Answer {
  std::string json;
  PackedArrays numbers;
  std::array<std::string, 3> tables;  ///< CSV, as `kairos run --out` writes: see `RunTables`
};

/// What the page asks for.
struct Request {
  std::string_view scene;     ///< text of a scene file
  std::string_view path;      ///< what messages call it; tracks lie beside it
  std::string_view settings;  ///< lines `option=value`
  /// Empty: as the scene says. Otherwise a line with the time (s) that has passed, and one for each
  /// body that is elsewhere by now: name, tab, position, quaternion (w, x, y, z), velocity and
  /// angular velocity, as numbers with spaces between them.
  std::string_view start;
  double seconds = 0.0;  ///< of computing, after which the run is stopped; 0: no limit
  bool tables = false;   ///< CSV instead of motions
};

/// The plug-ins, options, keys and entities that there are.
[[nodiscard]] Answer about();
/// Reads the scene and runs it. What is wrong with either is in `error`: file, line, key, reason.
[[nodiscard]] Answer run(const Request& request);

}  // namespace kairos::studio
