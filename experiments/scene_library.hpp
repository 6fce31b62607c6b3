#pragma once

#include <string>
#include <vector>

namespace kairos::experiments {

/// The folder of the shipped scenes: beside the installed program, or in the source tree; empty if
/// there is none.
[[nodiscard]] std::string scene_folder();
/// Names of the shipped scenes, in alphabetical order.
[[nodiscard]] std::vector<std::string> shipped_scenes();
/// The file that a person means: a path, or the bare name of a shipped scene. Throws `InputError`.
[[nodiscard]] std::string find_scene(const std::string& path_or_name);

}  // namespace kairos::experiments
