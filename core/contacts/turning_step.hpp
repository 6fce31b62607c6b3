#pragma once

#include "core/contacts/touch_rim.hpp"
#include "core/contacts/turning_mode.hpp"
#include "core/event.hpp"
#include "core/force.hpp"
#include "core/stepper.hpp"

#include <memory>
#include <string>
#include <vector>

namespace kairos {
inline namespace core {

/// Two bodies of a group that touch, as their separation is watched: some plane, of a face that
/// they touch with or through a touch, has all corners of one on one side and of the other on the
/// other. That proves that they do not overlap, whatever the forces are.
struct TurningPair {
  std::size_t a = 0;  ///< places in the group
  std::size_t b = 0;
  std::vector<TouchFeature> corners_a;
  std::vector<TouchFeature> corners_b;
  std::vector<TouchFeature>
      planes_a;  ///< of faces of a in touch, with the corners of b beyond them
  std::vector<TouchFeature> planes_b;
  double nearest = 0.0;  ///< what comes nearer than this strikes, m; held gaps are no smaller
  const Shape* shape_a = nullptr;  ///< whose other planes may separate them; not owned
  const Shape* shape_b = nullptr;
  /// Along which a detector found them apart, from a to b, world, unit; zero: unknown.
  Vector3 apart = Vector3::Zero();
  /// Where both have parts, a pair of these: features are in their frames.
  bool of_pieces = false;
  Pose piece_a{};
  Pose piece_b{};
  double apart_by = 0.0;    ///< how far apart pieces are at least, m
  std::size_t of = 0;       ///< as `Touch::pair` counts
  std::size_t index_a = 0;  ///< which of the pieces of a
  std::size_t index_b = 0;
};

/// Pieces of two bodies that nothing watches: as far apart as this at least, m.
struct Unwatched {
  std::size_t a = 0;
  std::size_t b = 0;
  double distance = 0.0;
};

/// A body of a group that is driven.
struct GroupDriver {
  std::size_t place = 0;
  Motion motion;
};

/// A group of bodies that turn while they touch, and what moves them.
struct TurningGroup {
  TurningState start;
  std::vector<BodyIndex> bodies;        ///< by place
  std::vector<BodyInertia> inertia;     ///< by place; mass <= 0: it stays where it is
  std::vector<Vector3> constant_force;  ///< by place, N
  /// By place: forces that depend on the state or on time, of the body alone; not owned.
  std::vector<std::vector<const Force*>> forces;
  std::vector<GroupMechanism> mechanisms;            ///< what hangs together by joints
  std::vector<GroupDriver> drivers;                  ///< what is driven
  std::vector<TurningPair> pairs;                    ///< as `Touch::watched` counts
  std::vector<std::shared_ptr<const Shape>> pieces;  ///< that pairs refer to
  std::vector<Unwatched> unwatched;
  /// Touches that are others as seen from a piece beside: of those with the same pair and point.
  std::vector<Touch> shared;
  std::vector<std::vector<TouchRim>> rims;  ///< by touch
};

/// Why a step of a group ended where it did.
enum class TurningEnd {
  step,    ///< nothing happened
  forces,  ///< a force would leave its cone, or what slides stops
  rim,     ///< a touch comes to the rim of the face that it is on
  strike,  ///< another corner of a pair comes down
};

/// A step of a group of bodies that turn while they touch.
struct TurningStep {
  std::string refusal;    ///< why there is none; empty: there is
  double duration = 0.0;  ///< s
  double stepped = 0.0;   ///< s; how long it was before it was cut off where something ends
  bool halved = false;    ///< what was asked for was too long
  TurningEnd end = TurningEnd::step;
  std::size_t pair = 0;           ///< that strikes
  std::vector<Motion> motions;    ///< by place; of free bodies only
  std::vector<BodyState> states;  ///< by place, at the end
  /// By touch: what it does. As in the mode, but what is to stick at the end of an implicit step
  /// slides where the step was cut off before it stops.
  std::vector<FrictionChoice> choices;
  std::vector<Polynomial<3>> worked;  ///< by place: x, work of contact forces on the body, J
  /// By pair: x, work of friction that slides, J, <= 0; y, what belts do, J; z, what is driven, J.
  std::vector<Polynomial<3>> rubbed;
  /// By place: x, what the contact forces of the touches of which it is the first free body gave
  /// that is no friction: truncation, J.
  std::vector<Polynomial<3>> leaked;
  /// By place: x, what the joints of the mechanism of which it is the first body take from what
  /// drives them, because contact forces act, J.
  std::vector<Polynomial<3>> driven;
  /// By touch: velocities that the integrated motions of an implicit step end with, m/s, turned
  /// with the normals back to its start.
  std::vector<Vector3> reached;
  std::int64_t evaluations = 0;
};

/// Of a motion, at an instant within it: of its origin, m/s^2, and rad/s^2.
[[nodiscard]] Twist accelerations_of(const Motion& motion, Instant t);

/// The group at another instant, in other states, of its free bodies.
[[nodiscard]] TurningState turning_state(const TurningGroup& group, Instant t,
                                         std::span<const BodyState> free_states);

/// What slides slower than this, m/s, may be what has just stopped: a step that ends there ends a
/// little after. Taken to slide on, it would stop again at once, and so without end.
[[nodiscard]] double turning_rest(const TurningGroup& group);

/// Goes on for at most `longest`, s, in the mode that was found: the stepper solves the
/// index-reduced equations, contact forces being the last force of the island; what it is off the
/// gaps is taken out at the end of the step, positions first and then velocities, and its motions
/// are bent to that. The step is shortened until no held gap is off by more than a small part of
/// what it is. What ends the mode is looked for along these motions: corners that come down between
/// bounds of their accelerations, forces and rims at 16 points and then by bisection. In an
/// implicit mode contact forces are those of the mode, what is told keeps the gaps, and the step is
/// refused where it does not; no forces end it.
[[nodiscard]] TurningStep turning_step(const TurningGroup& group, const TurningMode& mode,
                                       Stepper& stepper, Instant t, double longest);

}  // namespace core
}  // namespace kairos
