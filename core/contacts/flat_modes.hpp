#pragma once

#include "core/contact_manifold.hpp"
#include "core/contacts/contact_system.hpp"
#include "core/event.hpp"

#include <string>
#include <vector>

namespace kairos {
inline namespace core {

/// Two bodies of a group that touch.
struct GroupPatch {
  std::size_t a = 0;  ///< places in the group
  std::size_t b = 0;
  ContactManifold manifold;
  double rest_speed =
      0.0;  ///< m/s; slower than this along the normal, they are at rest to each other
  double friction = 0.0;            ///< Coulomb's; may be infinite
  Vector3 drift = Vector3::Zero();  ///< of the surface of b along that of a, beside their motion
                                    ///< (belts), m/s
  double still_speed = 0.0;  ///< m/s; what goes no faster along a curved surface stays where it is
};

/// What two surfaces in touch do along each other.
enum class Slip : char {
  none,    ///< they are not held together, or nothing rubs
  sticks,  ///< friction holds them; a ball rolls
  begins,  ///< they begin to slide
  slides,
};
constexpr Slip last_of(Slip) { return Slip::slides; }

/// Bodies in touch at one instant, with what would move them if they were not.
struct ContactGroup {
  std::vector<GroupBody> bodies;
  std::vector<Twist> velocities;
  std::vector<Twist> loads;    ///< accelerations without contact forces
  std::vector<double> radius;  ///< how far a body reaches from its origin, m
  std::vector<char> round;     ///< a sphere: it may turn while it touches
  std::vector<GroupPatch> patches;
  double instant = 0.0;  ///< s; what happens within it happens at once
};

/// How a group moves while its contact forces and loads stay constant: bodies move on parabolas and
/// do not turn, or a body turns steadily about the normal of its only patch.
struct FlatMode {
  std::string refusal;            ///< why it does not go on like that; empty: it does
  std::vector<Twist> velocities;  ///< with nothing left along the normals that are kept
  std::vector<Twist> accelerations;
  std::vector<char> kept;         ///< by patch: stays in touch
  std::vector<char> struck;       ///< by patch: an impulse stopped it; empty: none
  std::vector<double> pressing;   ///< by patch: normal force, N
  std::vector<double> rate;       ///< by patch: fastest point along the normal before, m/s, >= 0
  std::vector<Slip> slip;         ///< by patch, where there is friction; otherwise empty
  std::vector<Vector3> force;     ///< by patch, where there is friction: on b, N
  std::vector<double> slip_ends;  ///< by patch, where there is friction: when it stops sliding, s
  bool curved = false;            ///< refused for what slides on no line, and for nothing else
  bool turns = false;             ///< bodies turn while they touch: see `TurningMode`
  Grade grade = Grade::exact;     ///< how it was found
  double driven = 0.0;            ///< work of what joints hang on in what is taken out, J
  int solves = 0;
};

struct FlatModeOptions {
  bool unloaded = false;  ///< a group in which nothing presses is kept as well
  bool unite = false;     ///< what is at rest to each other stays so, pressed or not: the end of a
                          ///< collapse
};

/// Proposes which patches press and which part (complementarity of accelerations, no friction) and
/// verifies that signs are right, no body turns that must not, and normals stay. Velocities along
/// the kept normals are projected out in the metric of the kinetic energy.
[[nodiscard]] FlatMode flat_mode(const ContactGroup& group, const FlatModeOptions& options);

}  // namespace core
}  // namespace kairos
