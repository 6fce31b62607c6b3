#pragma once

#include "core/event.hpp"

#include <string>

namespace kairos {
inline namespace core {

/// What an impact, as told, did against Newton's hypothesis v_n' = -e v_n at its contact: it acted
/// on a pair that parted, or left another relative normal velocity. Empty: nothing. `e`:
/// restitution of the pair. For laws that give a contact. Tolerance (roundoff): 64 eps of the
/// speeds that meet in the contact, and 1024 eps of those of rotation: lever arms are known to 512
/// eps.
[[nodiscard]] std::string broken_restitution(const Event& impact, double e);

}  // namespace core
}  // namespace kairos
