#pragma once

#include "core/reading/table_reader.hpp"

namespace kairos {
inline namespace core {

/// The numbers that a scene may hold. Physical limits, far outside of what experiments ask for and
/// far inside of what squares and products of doubles can hold: NaN and infinity never arise.
namespace limits {

inline constexpr Range position{.lowest = -1e12, .highest = 1e12, .unit = "m"};
inline constexpr Range extent{.lowest = 1e-15, .highest = 1e12, .unit = "m"};
inline constexpr Range velocity{.lowest = -1e12, .highest = 1e12, .unit = "m/s"};
inline constexpr Range angular_velocity{.lowest = -1e12, .highest = 1e12, .unit = "rad/s"};
inline constexpr Range mass{.lowest = 1e-30, .highest = 1e30, .unit = "kg"};
inline constexpr Range inertia{.lowest = 0.0, .highest = 1e60, .above = true, .unit = "kg m^2"};
inline constexpr Range G{.lowest = 0.0, .highest = 1e12, .unit = "m/s^2 or N"};
inline constexpr Range restitution{.lowest = 0.0, .highest = 1.0};
/// Infinite is allowed too: "inf", a rough surface.
inline constexpr Range friction{.lowest = 0.0, .highest = 1e6};
inline constexpr Range scale{.lowest = 0.0, .highest = 1e6, .above = true};
inline constexpr Range density{.lowest = 0.0, .highest = 1e12, .unit = "kg/m^3"};
inline constexpr Range coefficient{.lowest = 0.0, .highest = 1e6};
inline constexpr Range area{.lowest = 0.0, .highest = 1e25, .unit = "m^2"};
inline constexpr Range volume{.lowest = 0.0, .highest = 1e37, .unit = "m^3"};
inline constexpr Range length{.lowest = 0.0, .highest = 1e12, .unit = "m"};
inline constexpr Range stiffness{.lowest = 0.0, .highest = 1e30, .unit = "N/m"};
inline constexpr Range damping{.lowest = 0.0, .highest = 1e30, .unit = "kg/s"};
inline constexpr Range rotational_damping{.lowest = 0.0, .highest = 1e30, .unit = "kg m^2/s"};
inline constexpr Range component{.lowest = -1e12, .highest = 1e12};
inline constexpr Range angle{.lowest = -1e6, .highest = 1e6, .unit = "rad"};
inline constexpr Range frequency{.lowest = 0.0, .highest = 1e9, .above = true, .unit = "Hz"};
/// Half a turn to either side: a bat that swings farther comes round the other way.
inline constexpr Range swing{.lowest = -3.2, .highest = 3.2, .unit = "rad"};

/// How far from 1 the norm of a quaternion may be: what seven printed digits lose.
inline constexpr double quaternion_norm = 1e-6;

}  // namespace limits
}  // namespace core
}  // namespace kairos
