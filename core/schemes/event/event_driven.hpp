#pragma once

#include "core/scheme.hpp"

#include <memory>

namespace kairos {
inline namespace core {

/// `event-driven`: from impact to impact [Alder1959], [Lubachevsky1991]. Asynchronous: every body
/// has its own current motion; a queue holds what is due; an impact launches its two bodies again
/// and predicts only their pairs. Impacts act at the detector's contact-free time, so that bodies
/// never overlap. At rest, supported: a ball on one surface. Any other accumulation of impacts
/// stops the run with a reason.
[[nodiscard]] std::unique_ptr<Scheme> make_event_driven();

}  // namespace core
}  // namespace kairos
