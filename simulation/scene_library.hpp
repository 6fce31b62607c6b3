#pragma once

#include <string>
#include <vector>

namespace kairos {
inline namespace simulation {

/// The folder of the shipped scenes: beside the installed program, or in the source tree; empty if
/// there is none.
[[nodiscard]] std::string scene_folder();
/// Names of the shipped scenes, in alphabetical order.
[[nodiscard]] std::vector<std::string> shipped_scenes();
/// The file of a shipped scene: TOML, or the thesis' own .def.
[[nodiscard]] std::string shipped_scene_path(const std::string& name);
/// The file that a person means: the bare name of a shipped scene, or a path. A name means the same
/// in every folder: a file that happens to have it is written `./name`. Throws `InputError`.
[[nodiscard]] std::string find_scene(const std::string& path_or_name);

}  // namespace simulation
}  // namespace kairos
