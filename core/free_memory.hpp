#pragma once

#include <cstddef>
#include <string>

namespace kairos {
inline namespace core {

/// Memory of a scene and its model per body, bytes: a little more than was measured with balls.
inline constexpr double bytes_in_model = 1024.0;
/// Memory of a run of `event-driven` per ball beside that: a test holds both to what is taken.
inline constexpr double bytes_in_run = 1024.0;
/// The same of what is no ball on a parabola, and has a motion and a stepper of its own.
inline constexpr double bytes_of_own_motion = 4096.0;
/// The same per body of any other scheme: `substepped` takes most.
inline constexpr double bytes_in_frames = 5120.0;

/// Memory that this process may still take, bytes: what is free on the machine, within the control
/// group and within the limit of its address space, whichever is least. Read from Linux; infinite
/// on other systems.
[[nodiscard]] double free_memory();

/// Why so many bodies of so many bytes each do not fit into that memory: a text that names the
/// bytes and how many bodies would fit. Empty if they fit.
[[nodiscard]] std::string why_no_room(std::size_t bodies, double bytes_a_body, double free);

}  // namespace core
}  // namespace kairos
