#include "core/reading/scene_keys.hpp"

namespace kairos {
inline namespace core {
namespace {

constexpr SceneKey keys[] = {
    {"", "name"},
    {"", "summary"},
    {"", "duration"},
    {"", "frame"},
    {"", "gravity"},
    {"", "G"},
    {"", "bounds"},
    {"", "friction"},
    {"", "friction_combine"},
    {"", "restitution_combine"},
    {"", "body"},
    {"", "many"},
    {"", "force"},
    {"", "joint"},
    {"", "exact"},
    {"frame", "csv"},
    {"frame", "mean"},
    {"frame", "jitter"},
    {"frame", "spike_probability"},
    {"frame", "spike_factor"},
    {"frame", "seed"},
    {"body", "name"},
    {"body", "entity"},
    {"body", "shape"},
    {"body", "radius"},
    {"body", "half_extents"},
    {"body", "mass"},
    {"body", "inertia"},
    {"body", "position"},
    {"body", "orientation"},
    {"body", "axis_angle"},
    {"body", "velocity"},
    {"body", "angular_velocity"},
    {"body", "restitution"},
    {"body", "friction"},
    {"body", "collision_type"},
    {"body", "normal"},
    {"body", "scale"},
    {"body", "G"},
    {"body", "bounds"},
    {"body", "drive"},
    {"body", "holds"},
    {"many", "name"},
    {"many", "count"},
    {"many", "region"},
    {"many", "placement"},
    {"many", "sizes"},
    {"many", "orientations"},
    {"many", "velocity_deviation"},
    {"many", "angular_velocity_deviation"},
    {"many", "seed"},
    {"many.region", "min"},
    {"many.region", "max"},
    {"body.drive", "track"},
    {"body.drive", "smooth"},
    {"body.drive", "position_scale"},
    {"body.drive", "amplitude"},
    {"body.drive", "frequency"},
    {"body.drive", "phase"},
    {"body.drive", "rotation_axis"},
    {"body.drive", "rotation_amplitude"},
    {"body.drive", "rotation_phase"},
    {"force", "kind"},
    {"force", "name"},
    {"force", "bodies"},
    {"force.quadratic-drag", "density"},
    {"force.quadratic-drag", "drag_coefficient"},
    {"force.quadratic-drag", "area"},
    {"force.quadratic-drag", "wind"},
    {"force.linear-drag", "coefficient"},
    {"force.linear-drag", "rotational"},
    {"force.linear-drag", "wind"},
    {"force.magnus-lift", "density"},
    {"force.magnus-lift", "lift_coefficient"},
    {"force.magnus-lift", "radius"},
    {"force.magnus-lift", "wind"},
    {"force.buoyancy", "density"},
    {"force.buoyancy", "volume"},
    {"force.buoyancy", "G"},
    {"force.buoyancy", "centre"},
    {"force.spring", "stiffness"},
    {"force.spring", "damping"},
    {"force.spring", "rest_length"},
    {"force.spring", "point_a"},
    {"force.spring", "point_b"},
    {"force.spring", "anchor"},
    {"force.damper", "damping"},
    {"force.damper", "point_a"},
    {"force.damper", "point_b"},
    {"force.damper", "anchor"},
    {"joint", "kind"},
    {"joint", "name"},
    {"joint", "bodies"},
    {"joint", "anchor"},
    {"joint", "point_a"},
    {"joint", "point_b"},
    {"joint", "collide"},
    {"joint.hinge", "axis"},
    {"joint.slider", "axis"},
    {"joint.rod", "length"},
    {"exact", "solution"},
};

}  // namespace

std::span<const SceneKey> scene_keys() { return keys; }

std::vector<std::string_view> scene_keys_of(std::string_view table) {
  std::vector<std::string_view> result;
  for (const SceneKey& key : keys) {
    if (key.table == table) {
      result.push_back(key.key);
    }
  }
  return result;
}

}  // namespace core
}  // namespace kairos
