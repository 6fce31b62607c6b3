#pragma once

#include "core/stepper.hpp"

#include <optional>

namespace kairos {
inline namespace core {

/// A stepper that says so by being one: at constant forces, of bodies that do not turn, a step
/// lasts as long as it is asked to, for ever if need be; and after `restart` nothing depends on
/// what was before. Bodies that fall freely can share one.
class MemorylessStepper : public Stepper {
 public:
  /// `restart` and a step without end of one body, without its motion: the acceleration of the
  /// parabola that `dense_output` would tell from where the body is; nothing: it has to be asked.
  [[nodiscard]] virtual std::optional<Vector3> fall(const Vector3& /*force*/, double /*mass*/) {
    return std::nullopt;
  }
};

}  // namespace core
}  // namespace kairos
