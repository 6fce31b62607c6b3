#pragma once

#include "core/contacts/flat_modes.hpp"
#include "core/motion.hpp"

#include <optional>
#include <string>

namespace kairos {
inline namespace core {

/// A body that does not turn, on a plane that is driven and does not turn either.
struct DrivenTouch {
  BodyState body;
  Vector3 load = Vector3::Zero();    ///< acceleration without contact forces, m/s^2
  Vector3 normal = Vector3::Zero();  ///< from the plane to the body
  double friction = 0.0;
  double still = 0.0;     ///< m/s; what slides slower than this does not
  double duration = 0.0;  ///< s, that is looked at
};

/// How the body moves, and until when.
struct DrivenMode {
  std::string refusal;  ///< why that is not known; empty: it is
  Slip slip = Slip::none;
  bool parts = false;                  ///< the plane draws away from it: nothing else is told
  Motion motion;                       ///< of the body
  Vector3 velocity = Vector3::Zero();  ///< of it now, m/s
  double pressing = 0.0;               ///< now, m/s^2
  Vector3 pushes = Vector3::Zero();    ///< what the plane gives it now, m/s^2
  Vector3 leans = Vector3::Zero();     ///< largest that friction is, of what presses
  double until = 0.0;                  ///< when this ends, s; may be infinite
  /// Where it slides and what presses changes: x, work of friction by the mass, J/kg, and z, of the
  /// plane; otherwise none.
  std::optional<Polynomial<3>> worked{};
};

/// The body sticks as long as friction can give it the acceleration of the plane, slides against
/// mu N otherwise, and parts where the plane draws away faster than the load follows. All of these
/// end at roots of polynomials, since the motion of the plane, `under`, is one (from now on). The
/// motion of the plane along itself, the sliding and the pull must lie on one line.
[[nodiscard]] DrivenMode driven_mode(const DrivenTouch& touch, const Motion& under);

}  // namespace core
}  // namespace kairos
