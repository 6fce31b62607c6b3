#pragma once

#include <string_view>

namespace kairos::tests {

/// A ball falls 4.9 m to a floor, elastically: impacts at (2k - 1) s.
inline constexpr std::string_view drop_scene = R"(name = "drop"
summary = "a ball falls on a floor"
duration = 2.5
frame = "1/60"

[[body]]
name = "floor"
entity = "wall"
shape = "half-space"

[[body]]
name = "ball"
entity = "ball"
radius = 0.1
mass = 1.0
position = [0.0, 5.0, 0.0]
)";

}  // namespace kairos::tests
