#pragma once

#include "core/contacts/contact_sweeps.hpp"
#include "core/contacts/turning_forces.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kairos {
inline namespace core {

/// How bodies that turn while they touch go on from an instant.
struct TurningMode {
  std::string refusal;                  ///< why that is not known; empty: it is
  std::vector<FrictionChoice> choices;  ///< by touch; directions are those of sliding
  TurningForces::Solution forces;
  std::vector<Twist> velocities;  ///< by body, with nothing left of what is held
  std::vector<char> struck;       ///< by touch: an impulse stopped it at the start; empty: none
  double driven = 0.0;            ///< work of what is driven in that, J
  bool flies = false;             ///< nothing is held
  bool implicit = false;          ///< forces are those of a step, see `implicit_mode`
  bool keeps_all = false;         ///< what is not held goes on with what is, too
  /// By touch: velocities at the end of an implicit step as its forces were found for, m/s.
  std::vector<Vector3> foreseen;
  bool gives = false;     ///< forces of an implicit step give energy at its start
  double nothing = 0.0;   ///< work of contacts that is none in an implicit step, J
  bool searched = false;  ///< what is likely did not verify: changes of it were tried
  int solves = 0;
};

/// Proposes what each touch does (opens, sticks, slides) and accepts what was verified: first that
/// all go on as they move, then what projected Gauss-Seidel finds likely, then what forces tell
/// that were looked for at all touches at once, of as few of them as carry the load, then what
/// differs from the first two in one touch or two. All touches are at rest along their normals.
/// `still`: what slides slower than this, m/s, is taken to stick or to begin to slide. `halvings`:
/// the most changes that are tried are halved so many times.
[[nodiscard]] TurningMode turning_mode(const TurningState& state, double still, int halvings = 0);

/// What bodies do that nothing moves and that move all the same, while such impulses press on them,
/// J.
[[nodiscard]] double carrying_work(const TurningState& state, std::span<const SweptTouch> touches,
                                   std::span<const Vector3> impulses);

/// Velocities with nothing left along the normals of what is held, nor where it sticks: nearest, as
/// the kinetic energy measures.
struct HeldVelocities {
  std::vector<Twist> of;  ///< by body
  double driven = 0.0;    ///< work of what is driven in that, J
};
[[nodiscard]] HeldVelocities held_velocities(const TurningState& state,
                                             const std::vector<TouchNow>& now,
                                             const std::vector<FrictionChoice>& choices);

/// An impact without rebound.
struct Parting {
  std::vector<Twist> velocities;  ///< by body
  std::vector<char> struck;       ///< by touch: it took an impulse
  double driven = 0.0;            ///< work of what is driven in that, J
};
/// Velocities with which nothing approaches along the normals of the touches, nearest, as the
/// kinetic energy measures; nothing where none are known.
[[nodiscard]] std::optional<Parting> parting(const TurningState& state);

/// Moves the bodies, nearest as their masses measure, so that the gaps of the touches for which
/// `moves` holds are what they are to be; first order in what they are off by.
void put_at_gaps(TurningState& state, const std::vector<char>& moves);

/// Along a normal from a to b, at a point, a gap is to grow by this much at least, m.
struct Clearance {
  std::size_t a = 0;
  std::size_t b = 0;
  Vector3 point = Vector3::Zero();
  Vector3 normal = Vector3::Zero();
  double missing = 0.0;
};

/// The same, so that no gap is less than it is to be, nor along others; false, and nothing is
/// moved, where it is not known how.
[[nodiscard]] bool put_clear(TurningState& state, std::span<const Clearance> others);

}  // namespace core
}  // namespace kairos
