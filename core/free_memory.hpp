#pragma once

#include <cstddef>
#include <string>

namespace kairos {
inline namespace core {

/// What a scene and its model take for each body, bytes: some more than was measured of balls.
inline constexpr double bytes_in_model = 1536.0;
/// The same of a run beside that; `event-driven` takes most of all schemes.
inline constexpr double bytes_in_run = 4096.0;

/// Memory that this process may still take, bytes: what is free on the machine, within the control
/// group and within the limit of its address space, whichever is least. As Linux tells it; infinite
/// where nobody tells.
[[nodiscard]] double free_memory();

/// Why so many bodies of so many bytes each do not fit into that: the bytes, and how many bodies
/// would. Empty if they do.
[[nodiscard]] std::string why_no_room(std::size_t bodies, double bytes_a_body, double free);

}  // namespace core
}  // namespace kairos
