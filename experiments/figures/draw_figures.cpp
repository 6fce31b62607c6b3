#include "experiments/figures/draw_figures.hpp"

#include "experiments/child_process.hpp"
#include "experiments/data_folders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace kairos::experiments {

namespace {

std::string look_for_python() {
  const char* wanted = std::getenv("KAIROS_PYTHON");
  for (const std::string& python :
       {std::string(wanted == nullptr ? "" : wanted), std::string("python3"),
        std::string("/usr/bin/python3"), std::string("/usr/local/bin/python3")}) {
    if (!python.empty() &&
        run_child({python, "-c", "import matplotlib, numpy"}, ChildOutput::hidden) == 0) {
      return python;
    }
  }
  return "";
}

}  // namespace

std::string find_python() {
  static const std::string found = look_for_python();
  return found;
}

std::string draw_figures(const std::string& script, const std::string& folder) {
  const std::string scripts = figure_folder();
  if (scripts.empty()) {
    return "no figures: the folder of figure scripts is missing";
  }
  const std::string name = script.empty() ? "lines" : script;
  std::string module = name;  // as Python imports it
  std::replace(module.begin(), module.end(), '-', '_');
  std::string file = module;  // thesis.fig01 is thesis/fig01.py
  std::replace(file.begin(), file.end(), '.', '/');
  std::error_code none;
  if (!std::filesystem::is_regular_file(std::filesystem::path(scripts) / (file + ".py"), none)) {
    return fmt::format("no figures: there is no script '{}'", name);
  }
  const std::string python = find_python();
  if (python.empty()) {
    return "no figures: no python3 with matplotlib was found; set KAIROS_PYTHON to one";
  }
  // -B: leave no compiled files beside the sources.
  const int code =
      run_child({python, "-B", (std::filesystem::path(scripts) / "draw.py").string(), name, folder},
                ChildOutput::shown);
  return code == 0 ? "" : fmt::format("no figures: the script '{}' ended with code {}", name, code);
}

std::string draw_runs(const std::vector<std::string>& runs, const std::string& bodies,
                      const std::string& picture) {
  const std::string scripts = figure_folder();
  const std::string python = find_python();
  if (scripts.empty() || python.empty()) {
    return scripts.empty()
               ? "no picture: the folder of figure scripts is missing"
               : "no picture: no python3 with matplotlib was found; set KAIROS_PYTHON to one";
  }
  std::vector<std::string> command{
      python, "-B", (std::filesystem::path(scripts) / "run_plot.py").string(), picture};
  if (!bodies.empty()) {
    command.insert(command.end(), {"--bodies", bodies});
  }
  command.insert(command.end(), runs.begin(), runs.end());
  const int code = run_child(command, ChildOutput::shown);
  return code == 0 ? "" : fmt::format("no picture: run_plot.py ended with code {}", code);
}

}  // namespace kairos::experiments
