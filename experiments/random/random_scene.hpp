#pragma once

#include "core/pose.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace kairos::experiments {

/// A body of a random scene, before it is text.
struct RandomBody {
  std::string name;
  std::string entity;  ///< wall, ball, body, balloon, anti-gravity-pad
  std::string shape;   ///< sphere, box, half-space; see `shapes_scene`
  double radius = 0.0;
  Vector3 half_extents = Vector3::Zero();
  Vector3 normal = Vector3::UnitY();  ///< of a half-space
  double mass = 1.0;
  Vector3 position = Vector3::Zero();
  Vector3 velocity = Vector3::Zero();
  Vector3 turned = Vector3::Zero();  ///< rotation vector at the start, rad
  Vector3 spin = Vector3::Zero();    ///< rad/s
  double restitution = 1.0;
  double friction = 0.0;            ///< inf: rough
  Vector3 swing = Vector3::Zero();  ///< amplitude of a driven body, m; zero: nothing drives it
  double frequency = 0.0;           ///< Hz
  double phase = 0.0;

  double length = 0.0;              ///< of a capsule or a cylinder; the height of a cone
  std::vector<Vector3> points;      ///< of a hull
  double rounding = 0.0;            ///< of a hull
  std::string file;                 ///< of a mesh
  double unit = 1.0;                ///< of a mesh, m
  std::vector<double> heights;      ///< of a height field, three rows of three
  double spacing = 0.0;             ///< of a height field
  std::vector<RandomBody> parts{};  ///< of a compound: shape, size, position, turned
  double gyration = 0.0;            ///< its three moments over the mass, m^2; 0: the solid's

  [[nodiscard]] bool moves() const {
    return entity == "ball" || entity == "body" || entity == "balloon";
  }
  /// Of a ball around its place that it does not leave but by moving freely, m.
  [[nodiscard]] double reach() const;
};

/// Whether a body is clear of another, wherever both are turned, and of all places up to `way` (m)
/// beside it.
[[nodiscard]] bool apart(const RandomBody& b, const RandomBody& other, double way = 0.0);

/// A joint of a random scene.
struct RandomJoint {
  std::string kind;                 ///< ball, hinge, slider, rod, weld
  std::vector<std::string> bodies;  ///< one: the other side is the world
  Vector3 anchor = Vector3::Zero();
  Vector3 axis = Vector3::Zero();  ///< of a hinge or a slider
};

/// A valid scene that nobody thought of: what a person could have written, none of whose solids
/// overlap at the start.
struct RandomScene {
  std::string name;
  double duration = 1.0;
  double frame = 0.1;
  double G = 0.0;
  std::array<bool, 3> repeated{};  ///< whether the box from `low` to `high` is, along x, y, z
  Vector3 low = Vector3::Zero();
  Vector3 high = Vector3::Zero();
  std::vector<RandomBody> bodies;
  std::vector<RandomJoint> joints;

  /// As a scene file; digits that read back the same.
  [[nodiscard]] std::string toml() const;
};

/// The scene of that number: a pure function of seed and index.
[[nodiscard]] RandomScene random_scene(std::uint64_t seed, std::uint64_t index);

/// The same of all shapes that there are: spheres, boxes, capsules, cylinders, cones, hulls (one in
/// four rounded), compounds, height fields, solid meshes; as walls, driven, and free.
[[nodiscard]] RandomScene shapes_scene(std::uint64_t seed, std::uint64_t index);

/// What a person builds first, and what is hardest: bodies that touch at the start (rows, stacks,
/// boxes on a floor), grooves, corners, inclines with a stopper, rows of balls that run into each
/// other with little restitution, balls between walls that close. Moved, turned and scaled at
/// random; solids touch, but do not overlap beyond roundoff.
[[nodiscard]] RandomScene touching_scene(std::uint64_t seed, std::uint64_t index);

/// The same with friction between bodies, from none to rough.
[[nodiscard]] RandomScene rough_scene(std::uint64_t seed, std::uint64_t index);

/// Bodies on joints: pendulums, chains that hang at one end or at both, doors, cradles, what slides
/// on a rail, welded boxes, mechanisms that fly; with walls and bodies that they meet, driven hands
/// that they hang from, with friction or without. No two overlap at the start, and all velocities
/// are those of a turn of the whole mechanism.
[[nodiscard]] RandomScene jointed_scene(std::uint64_t seed, std::uint64_t index);

/// Balls, up to some two hundred, of one size or of several, light and heavy, thin or dense; in a
/// room, in a box that is repeated along some axes, with gravity or without, with or without loss.
[[nodiscard]] RandomScene balls_scene(std::uint64_t seed, std::uint64_t index);

}  // namespace kairos::experiments
