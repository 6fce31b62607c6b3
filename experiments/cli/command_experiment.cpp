#include "experiments/cli/commands.hpp"
#include "experiments/cli/experiment_options.hpp"
#include "experiments/data_folders.hpp"
#include "experiments/thesis/thesis_figure.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <filesystem>
#include <memory>

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
    const ExperimentSpec spec = read_experiment(find_experiment(name), size.size());
    const std::string folder =
        out.empty() ? (std::filesystem::path("out") / spec.name).string() : out;
    const std::string command =
        fmt::format("kairos experiment {} --{}", name, to_string(size.size()));
    run_and_tell(spec, {size.size(), size.threads, command}, folder);
  }

 private:
  /// What is measured for a figure is an experiment, too.
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

void add_experiment_command(CLI::App& app) {
  const auto command = std::make_shared<ExperimentCommand>();
  CLI::App* experiment = app.add_subcommand("experiment", "Run an experiment by name");
  experiment
      ->add_option("name", command->name,
                   fmt::format("one of: table-tennis, {}; or a figure of `kairos reproduce`",
                               fmt::join(shipped_experiments(), ", ")))
      ->required();
  experiment->add_option("--out", command->out, "folder for tables and figures; default out/NAME")
      ->type_name("DIR");
  command->size.add_to(*experiment);
  experiment->callback([command] { command->run(); });
}

}  // namespace kairos::experiments
