#pragma once

namespace kairos::judge {

/// Motions with known answers, made by hand and not by any engine: the right ones must pass, and
/// each of them spoilt in many ways must be caught. Prints what failed; the number of failures.
[[nodiscard]] int self_check();

}  // namespace kairos::judge
