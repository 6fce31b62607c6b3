#pragma once

namespace kairos::experiments {

/// User time of the processor that this program has taken so far, all threads, s.
[[nodiscard]] double processor_seconds();

}  // namespace kairos::experiments
