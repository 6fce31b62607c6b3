#include "core/scene_keys.hpp"

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
    {"", "body"},
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
    {"body", "collision_type"},
    {"body", "normal"},
    {"body", "scale"},
    {"body", "G"},
    {"body", "bounds"},
    {"body", "drive"},
    {"body.drive", "track"},
    {"body.drive", "smooth"},
    {"body.drive", "position_scale"},
    {"body.drive", "amplitude"},
    {"body.drive", "frequency"},
    {"body.drive", "phase"},
    {"body.drive", "rotation_axis"},
    {"body.drive", "rotation_amplitude"},
    {"body.drive", "rotation_phase"},
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
