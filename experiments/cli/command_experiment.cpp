#include "core/error.hpp"
#include "core/nearest_name.hpp"
#include "experiments/cli/checks.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/cli/experiment_options.hpp"
#include "experiments/data_folders.hpp"
#include "experiments/report/report_entry.hpp"
#include "experiments/thesis/thesis_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace kairos::experiments {
namespace {

struct ExperimentCommand {
  std::string name;
  std::string out;
  SizeOptions size;

  void run() const {
    if (const ThesisFigure* figure = find_thesis_figure(name)) {
      return make(*figure);
    }
    const std::vector<std::string> known = reproducible_names();
    std::error_code none;
    if (std::find(known.begin(), known.end(), name) == known.end() &&
        !std::filesystem::is_regular_file(name, none)) {
      const std::vector<std::string_view> views(known.begin(), known.end());
      throw InputError("", 0, name,
                       "is neither an experiment, nor a figure, nor the file of a spec; " +
                           suggestion(name, views));
    }
    const ExperimentSpec spec = read_experiment(find_experiment(name), size.size());
    const std::string folder =
        out.empty() ? (std::filesystem::path("out") / spec.name).string() : out;
    const std::string command =
        fmt::format("kairos experiment {} --{}", name, to_string(size.size()));
    run_and_tell(spec, {size.size(), size.threads, command, size.force}, folder);
  }

 private:
  /// The measurements of a figure count as an experiment, too.
  void make(const ThesisFigure& figure) const {
    const std::string folder =
        out.empty() ? (std::filesystem::path("out") / figure.name).string() : out;
    const FigureOutcome made = make_figure(figure, size.size(), folder);
    fmt::print("{}: data in {:.1f} s, drawn in {:.1f} s -> {}\n", figure.name, made.data_seconds,
               made.drawing_seconds, folder);
    if (!made.problem.empty()) {
      fmt::print(stderr, "{}: {}\n", figure.name, made.problem);
    }
  }
};

}  // namespace

void add_experiment_command(Command& app) {
  const auto command = std::make_shared<ExperimentCommand>();
  Command experiment = app.add_subcommand("experiment", "Run an experiment by name");
  experiment
      .add_option("name", command->name,
                  fmt::format("one of: table-tennis, {}; or a figure of `kairos reproduce`",
                              fmt::join(shipped_experiments(), ", ")))
      .required();
  experiment.add_option("--out", command->out, "folder for tables and figures; default out/NAME")
      .type_name("DIR")
      .check(some_path());
  command->size.add_to(experiment);
  experiment.callback([command] { command->run(); });
}

}  // namespace kairos::experiments
