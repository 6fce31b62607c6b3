#pragma once

#include "core/combine.hpp"
#include "core/drive.hpp"
#include "core/entity.hpp"
#include "core/force.hpp"
#include "core/frame_times.hpp"
#include "core/joint.hpp"
#include "core/periodic_box.hpp"
#include "core/shape.hpp"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kairos {
inline namespace core {

/// What a body collides as: itself, the box around it, or its convex hull.
enum class Bounds { shape, obb, hull };
/// As scene files say it.
[[nodiscard]] std::string_view to_string(Bounds bounds);
/// What the number G of a body is: an acceleration (m/s^2), or the thesis' force (N).
enum class GravityMode { acceleration, force };
/// 5.4.1: whether a collision takes the line of centres as its normal.
enum class CollisionType { square, round };

/// One thing of a scene, as written.
struct Body {
  std::string name;
  std::shared_ptr<const Entity> entity;
  Shape shape;
  Bounds bounds = Bounds::shape;
  double mass = -1.0;                                ///< kg; -1: infinite
  Vector3 inertia = Vector3::Zero();                 ///< principal moments, kg m^2
  Quaternion inertia_axes = Quaternion::Identity();  ///< the principal axes, in body axes
  BodyState initial;                                 ///< at t = 0
  double restitution = 1.0;  ///< of a pair: see `Scene::restitution_combine`
  double friction = 0.0;     ///< Coulomb's, >= 0 or infinite (rough); of a pair: see
                             ///< `Scene::friction_combine`
  double G = 9.8;            ///< m/s^2 or N, see `GravityMode`
  CollisionType collision_type = CollisionType::square;
  Vector3 normal_B = Vector3::UnitY();  ///< of the reflecting face (5.5), body frame, unit
  double scale = 1.0;                   ///< the model's scale (7.4)
  std::shared_ptr<const Drive> drive;   ///< driven bodies only
  std::string holds;                    ///< name of what its closed fist holds; hands only
  int line = 0;                         ///< where it was written

  /// What it collides as: its shape, the box around it, or its convex hull (of meshes; other shapes
  /// are themselves). Throws `std::invalid_argument` for a flat mesh, which has none.
  [[nodiscard]] Shape collision_shape() const;
  /// The normal of its reflecting face in the world.
  [[nodiscard]] Vector3 normal(const Pose& pose) const { return pose.orientation * normal_B; }
};

/// A state- or time-dependent force and the bodies it acts on.
struct SceneForce {
  std::shared_ptr<const Force> force;
  std::vector<BodyIndex> bodies;  ///< in the order in which `Force::add` sees them
};

/// The known answer of a scene, by name, with its parameters (see scenes/README.md).
struct ExactSolution {
  std::string solution;
  std::map<std::string, double> parameters;
};

/// What a person wrote: bodies, materials, force fields; SI units; y is up.
struct Scene {
  std::string name;
  std::string summary;
  std::string path;        ///< of the file; empty if made in code
  double duration = 10.0;  ///< s
  FrameTimes frames;
  GravityMode gravity = GravityMode::acceleration;
  Combine restitution_combine = Combine::product;
  Combine friction_combine = Combine::geometric_mean;
  std::vector<Body> bodies;  ///< in the order of creation
  std::vector<SceneForce> forces;
  std::vector<Joint> joints;
  std::optional<PeriodicBox> periodic;  ///< repeated without end; none: space is open
  std::optional<ExactSolution> exact;

  /// Restitution of a pair of its bodies, from 0 to 1.
  [[nodiscard]] double restitution(const Body& a, const Body& b) const {
    return combine(restitution_combine, a.restitution, b.restitution);
  }
  /// Coulomb's coefficient of friction of a pair, >= 0 or infinite.
  [[nodiscard]] double friction(const Body& a, const Body& b) const {
    return combine(friction_combine, a.friction, b.friction);
  }
};

}  // namespace core
}  // namespace kairos
