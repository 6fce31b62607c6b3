#pragma once

#include "core/event.hpp"

#include <string>

namespace kairos {
inline namespace core {

/// How an impact breaks Newton's hypothesis v_n' = -e v_n at its contact, as a text: it acted on a
/// pair that parted, or left another relative normal velocity. Empty: it does not. `e`: restitution
/// of the pair. For laws that give a contact. Tolerance (roundoff): 64 eps of the speeds that meet
/// in the contact, and 1024 eps of those of rotation: lever arms are known to 512 eps; and
/// `handed_on`, m/s: what other impacts of the same instant round in this one.
[[nodiscard]] std::string broken_restitution(const Event& impact, double e, double handed_on = 0.0);

}  // namespace core
}  // namespace kairos
