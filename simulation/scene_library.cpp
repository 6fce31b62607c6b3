#include "simulation/scene_library.hpp"

#include "core/error.hpp"
#include "core/nearest_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace kairos {
inline namespace simulation {
namespace {

namespace fs = std::filesystem;

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

/// Folder of the running program; empty where the system does not tell.
fs::path program_folder() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path();
}

}  // namespace

std::string scene_folder() {
  const fs::path installed = (program_folder() / KAIROS_INSTALLED_SCENES).lexically_normal();
  if (is_folder(installed)) {
    return installed.string();
  }
  return is_folder(KAIROS_SOURCE_SCENES) ? KAIROS_SOURCE_SCENES : "";
}

std::vector<std::string> shipped_scenes() {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(scene_folder(), error)) {
    if (entry.path().extension() == ".toml" || entry.path().extension() == ".def") {
      names.push_back(entry.path().stem().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string shipped_scene_path(const std::string& name) {
  std::error_code error;
  const fs::path thesis = fs::path(scene_folder()) / (name + ".def");
  return (fs::is_regular_file(thesis, error) ? thesis : fs::path(scene_folder()) / (name + ".toml"))
      .string();
}

std::string find_scene(const std::string& path_or_name) {
  const std::vector<std::string> names = shipped_scenes();
  if (std::find(names.begin(), names.end(), path_or_name) != names.end()) {
    return shipped_scene_path(path_or_name);
  }
  std::error_code error;
  if (fs::exists(path_or_name, error) && !fs::is_directory(path_or_name, error)) {
    return path_or_name;
  }
  const std::vector<std::string_view> views(names.begin(), names.end());
  throw InputError(
      path_or_name, 0, "",
      fmt::format("is neither a file nor a shipped scene; {}", suggestion(path_or_name, views)));
}

}  // namespace simulation
}  // namespace kairos
