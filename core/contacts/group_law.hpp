#pragma once

#include "core/contacts/contact_system.hpp"

#include <Eigen/Core>

#include <vector>

namespace kairos {
inline namespace core {

/// What an impact law may also offer: the impact of several bodies in touch, at once. An
/// `ImpactLaw` that is also a `GroupLaw` is asked where several bodies are in touch.
class GroupLaw {
 public:
  virtual ~GroupLaw() = default;
  /// Whether an impact includes all bodies in touch. If not, it includes those that lasting contact
  /// holds together; bodies that merely touch are struck pair by pair.
  [[nodiscard]] virtual bool takes_what_touches() const = 0;
  /// Changes the velocities, one per body of the system, so that no row approaches any more. Rows
  /// approach or rest when it is asked; `restitution`, one per row. Returns the impulses, N s, of
  /// the rows, >= 0; empty where none were found.
  [[nodiscard]] virtual Eigen::VectorXd strike(const ContactSystem& system,
                                               const Eigen::VectorXd& restitution,
                                               std::vector<Twist>& v) const = 0;
};

}  // namespace core
}  // namespace kairos
