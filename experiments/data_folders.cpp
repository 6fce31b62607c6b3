#include "experiments/data_folders.hpp"

#include "core/error.hpp"
#include "core/nearest_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

namespace kairos::experiments {
namespace {

namespace fs = std::filesystem;

/// The experiments that the report shows first; others follow in alphabetical order.
constexpr std::array<std::string_view, 6> report_order = {
    "overview", "penetration", "energy-drift", "bat", "jiggle", "spinning-box"};

/// A folder of data beside the installed program, or in the source tree.
std::string data_folder(const std::string& name) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  const fs::path installed = (program / KAIROS_INSTALLED_DATA / name).lexically_normal();
  for (const fs::path& folder : {installed, fs::path(KAIROS_SOURCE_EXPERIMENTS) / name}) {
    if (fs::is_directory(folder, error)) {
      return folder.string();
    }
  }
  return "";
}

}  // namespace

std::string figure_folder() { return data_folder("figures"); }
std::string report_folder() { return data_folder("report"); }

std::string paper_folder() {
  const std::string installed = data_folder("paper");
  const fs::path source = fs::path(KAIROS_SOURCE_EXPERIMENTS).parent_path() / "paper";
  std::error_code error;
  return !installed.empty() ? installed : fs::is_directory(source, error) ? source.string() : "";
}

std::vector<std::string> shipped_experiments() {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(data_folder("specs"), error)) {
    if (entry.path().extension() == ".toml") {
      names.push_back(entry.path().stem().string());
    }
  }
  const auto rank = [](const std::string& name) {
    return std::find(report_order.begin(), report_order.end(), name) - report_order.begin();
  };
  std::sort(names.begin(), names.end(), [&](const std::string& a, const std::string& b) {
    return rank(a) != rank(b) ? rank(a) < rank(b) : a < b;
  });
  return names;
}

std::string find_experiment(const std::string& path_or_name) {
  const std::vector<std::string> names = shipped_experiments();
  if (std::find(names.begin(), names.end(), path_or_name) != names.end()) {
    return (fs::path(data_folder("specs")) / (path_or_name + ".toml")).string();
  }
  std::error_code error;
  if (fs::is_regular_file(path_or_name, error)) {
    return path_or_name;
  }
  const std::vector<std::string_view> views(names.begin(), names.end());
  throw InputError(path_or_name, 0, "",
                   fmt::format("is neither a file nor a shipped experiment; {}",
                               suggestion(path_or_name, views)));
}

}  // namespace kairos::experiments
