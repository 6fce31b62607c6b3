#pragma once

#include "core/state.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kairos {
inline namespace core {

struct Body;

/// The thesis' physics types (5.4.1): what one entity may know of another in a collision.
enum class PhysicsType { wall, ball, conveyor, agpad, ttbat, none };

/// Who moves an entity.
enum class Mobility {
  fixed,   ///< nobody
  driven,  ///< a `Drive`: a tracker, an analytic motion
  free,    ///< forces and impacts
};

/// What an entity says of itself in a collision (6.3). Mass -1 stands for infinite, as in the
/// thesis.
struct Momentum {
  double mass = -1.0;                  ///< kg
  Vector3 velocity = Vector3::Zero();  ///< m/s
};

/// 7.4: how far something that was hit is moved out of the way, in two readings, s.
struct Nudge {
  double along_change = 0.0;    ///< times scale (v' - v): 13.7 takes the difference first
  double along_velocity = 0.0;  ///< times scale v': the prose of 7.4

  /// Whether it changes nothing.
  [[nodiscard]] bool none() const { return along_change == 0.0 && along_velocity == 0.0; }
};

/// What an entity is given in a collision (6.4): the other's momentum, and a normal if the other
/// is a surface or both are round (13.5).
struct Gift {
  PhysicsType from = PhysicsType::none;
  Momentum momentum;
  std::optional<Vector3> normal;  ///< unit, world frame
  Nudge nudge = {};
};

/// What the velocity estimator of a tracked entity remembers from frame to frame (7.2, 13.8).
struct TrackerMemory {
  bool primed = false;
  Vector3 accepted_position = Vector3::Zero();
  Vector3 velocity = Vector3::Zero();
};

/// The thesis' taxonomy (ch. 5, 6): what a thing gives and takes in a contact. The loops never
/// learn its name; a new entity is one file and one line in `entities/catalogue.cpp`.
/// Immutable; one instance per body, holding that body's entity parameters.
class Entity {
 public:
  virtual ~Entity() = default;
  /// As scene files say it.
  [[nodiscard]] virtual std::string_view kind() const = 0;
  /// The thesis' word for it.
  [[nodiscard]] virtual PhysicsType physics_type() const = 0;
  /// What moves it: nothing, a drive, or forces and impacts.
  [[nodiscard]] virtual Mobility mobility() const = 0;
  /// A surface that reflects what hits it (13.5: `stationary()`).
  [[nodiscard]] virtual bool stationary() const { return false; }
  /// Things pass through it; it acts by force while they overlap.
  [[nodiscard]] virtual bool is_field() const { return false; }
  /// Whether its orientation can change by impacts and torques (a ball without friction: no).
  [[nodiscard]] virtual bool rotates() const { return false; }

  /// 6.3 GetMomentum.
  [[nodiscard]] virtual Momentum get_momentum(const Body& self, const BodyState& state) const = 0;
  /// 6.5 GetPhysForce: the force it applies to what touches it, in the unit of G: N where gravity
  /// is the thesis' force, N per kg of the receiver where it is an acceleration.
  [[nodiscard]] virtual Vector3 get_force(const Body& self, const BodyState& state) const;
  /// 6.4 GiveMomentum: changes its own velocity (and position, 7.4).
  virtual void give_momentum(const Body& self, BodyState& state, const Gift& gift) const;
  /// 6.6 GivePhysForce: adds to the net force on it, N.
  virtual void give_force(Vector3& net_force, const Vector3& force) const;
  /// 4.3 Dynamics: the direction and scale of the gravity it feels, times G: (0, -1, 0) for most.
  [[nodiscard]] virtual Vector3 gravity_direction() const { return {0.0, -1.0, 0.0}; }
  /// The nudge that this entity causes in a ball it hits (7.4).
  [[nodiscard]] virtual Nudge nudge() const { return {}; }
  /// Its closed fist holds the body that the scene names in `holds` (7.5).
  [[nodiscard]] virtual bool is_hand() const { return false; }
  /// Share of a hand's velocity that what it lets go of keeps.
  [[nodiscard]] virtual double release_share() const { return 1.0; }
  /// Velocity at which its surface runs along itself (a conveyor's belt), world frame, m/s. It
  /// takes friction to carry anything: a law that knows none (`newton`) takes no notice of it.
  [[nodiscard]] virtual Vector3 surface_velocity(const Body& self, const BodyState& state) const;
  /// Velocity that collisions see of a driven entity in the frame-based schemes; the default is
  /// the true one, the bat estimates it from positions (13.8). `interval`: the last frame, s.
  [[nodiscard]] virtual Vector3 tracked_velocity(TrackerMemory& memory, const BodyState& truth,
                                                 double interval) const;
};

/// A numeric parameter that an entity takes in a scene file.
struct EntityKey {
  std::string_view key;
  std::string_view unit;
  double default_value = 0.0;
  double lowest = 0.0;
  double highest = 0.0;
  std::string_view meaning;
};

/// What the catalogue knows of an entity: enough to read it from a scene and to document it.
struct EntityType {
  std::string_view kind;
  std::string_view summary;
  std::string_view source;  ///< section of the thesis, or "ours"
  Mobility mobility = Mobility::fixed;
  std::vector<EntityKey> keys;
  /// Values in the order of `keys`.
  std::function<std::shared_ptr<const Entity>(std::span<const double> values)> make;
};

/// All entities, in the order in which they are documented.
[[nodiscard]] std::span<const EntityType> entity_catalogue();
/// nullptr if there is none of that kind.
[[nodiscard]] const EntityType* find_entity(std::string_view kind);

}  // namespace core
}  // namespace kairos
