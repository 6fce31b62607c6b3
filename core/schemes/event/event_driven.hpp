#pragma once

#include "core/scheme.hpp"

#include <memory>

namespace kairos {
inline namespace core {

/// `event-driven`: from impact to impact [Alder1959], [Lubachevsky1991]. Asynchronous: every body
/// has its own current motion; a queue holds what is due; an impact launches its two bodies again
/// and predicts only their pairs. Impacts act at the detector's contact-free time, so that bodies
/// never overlap, and across no gap beyond tolerance. At rest, supported: a ball on one surface.
/// Any other accumulation of impacts, or contact that lasts, stops the run with a reason; so does
/// more work at one instant, or in one frame, than is allowed: no run is endless.
[[nodiscard]] std::unique_ptr<Scheme> make_event_driven();

}  // namespace core
}  // namespace kairos
