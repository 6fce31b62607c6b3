#pragma once

#include "core/scheme.hpp"

#include <memory>

namespace kairos {
inline namespace core {

/// `geometric`: the first cure (9.1.1.2.1, fig. 14). Once a frame every pair is tested with the
/// boxes around the first and the last position of both; where they overlap, the contact is located
/// inside the movement and handled there, in the order of creation. What the bodies do in the rest
/// of the frame, after that one contact, is not looked at: that is what is left to cure.
[[nodiscard]] std::unique_ptr<Scheme> make_geometric();

}  // namespace core
}  // namespace kairos
