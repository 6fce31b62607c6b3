#include "experiments/cli/commands.hpp"
#include "experiments/cli/experiment_options.hpp"
#include "experiments/sweeps/experiment_library.hpp"

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
    const ExperimentSpec spec = read_experiment(find_experiment(name), size.size());
    const std::string folder =
        out.empty() ? (std::filesystem::path("out") / spec.name).string() : out;
    const std::string command =
        fmt::format("kairos experiment {} --{}", name, to_string(size.size()));
    run_and_tell(spec, {size.size(), size.threads, command}, folder);
  }
};

}  // namespace

void add_experiment_command(CLI::App& app) {
  const auto command = std::make_shared<ExperimentCommand>();
  CLI::App* experiment = app.add_subcommand("experiment", "Run an experiment by name");
  experiment
      ->add_option("name", command->name,
                   fmt::format("one of: {}", fmt::join(shipped_experiments(), ", ")))
      ->required();
  experiment->add_option("--out", command->out, "folder for tables and figures; default out/NAME")
      ->type_name("DIR");
  command->size.add_to(*experiment);
  experiment->callback([command] { command->run(); });
}

}  // namespace kairos::experiments
