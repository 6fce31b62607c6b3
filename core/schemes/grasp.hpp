#pragma once

namespace kairos {
inline namespace core {

/// What a hand is doing with the body that it can hold (7.5). The worlds keep one for each grip of
/// the model; while it is not `open`, the held body has no contacts and feels no field.
enum class Grasp {
  open,
  holding,  ///< closed: the body is where the hand is, with the hand's velocity (our reading)
  leaving,  ///< let go of, and not yet clear of the hand
};

}  // namespace core
}  // namespace kairos
