#pragma once

namespace kairos::judge {

/// Judges answers that are known: right ones, by closed forms, must pass, and each of them spoilt
/// in every way that has a name must be caught. Prints what does not; returns how many do not.
[[nodiscard]] int self_check();

}  // namespace kairos::judge
