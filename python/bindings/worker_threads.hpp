#pragma once

#include <cstddef>
#include <functional>

namespace kairos::python {

/// Calls `work(first, last)` for pieces that cover [0, count), on `threads` threads (0: one per
/// core; the caller's is one of them). Each piece writes only what belongs to it, so that results
/// do not depend on the number of threads. `work` must not throw; `look` is called by the caller
/// now and then, and may: the rest is then left out.
void in_pieces(std::size_t count, std::size_t threads,
               const std::function<void(std::size_t first, std::size_t last)>& work,
               const std::function<void()>& look);

}  // namespace kairos::python
