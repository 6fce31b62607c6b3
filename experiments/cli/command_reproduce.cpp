#include "experiments/cli/commands.hpp"
#include "experiments/cli/experiment_options.hpp"
#include "experiments/report/report.hpp"
#include "experiments/sweeps/experiment_library.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <vector>

namespace kairos::experiments {
namespace {

struct ReproduceCommand {
  std::vector<std::string> only;
  std::string out = "out";
  SizeOptions size;

  void run() const;
};

/// All specs are read before the first one runs: a mistake in the last shows at once.
std::vector<ExperimentSpec> read_specs(const std::vector<std::string>& names, Size size) {
  std::vector<ExperimentSpec> specs;
  for (const std::string& name : names) {
    specs.push_back(read_experiment(find_experiment(name), size));
  }
  return specs;
}

void ReproduceCommand::run() const {
  const auto start = std::chrono::steady_clock::now();
  const auto specs = read_specs(only.empty() ? shipped_experiments() : only, size.size());
  const std::filesystem::path report = std::filesystem::path(out) / "report";
  fmt::print("Experiments at {} size, into {}\n", to_string(size.size()), report.string());
  std::size_t runs = 0;
  for (const ExperimentSpec& spec : specs) {
    fmt::print("{}\n  ", spec.title);
    std::fflush(stdout);
    const std::string command =
        fmt::format("kairos experiment {} --{}", spec.name, to_string(size.size()));
    runs += run_and_tell(spec, {size.size(), size.threads, command}, (report / spec.name).string())
                .runs;
    std::fflush(stdout);
  }
  const std::string page = write_report(report.string());
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  fmt::print("{} runs in all, {:.1f} s. The report: {}\n", runs, seconds, page);
}

}  // namespace

void add_reproduce_command(CLI::App& app) {
  const auto command = std::make_shared<ReproduceCommand>();
  CLI::App* reproduce =
      app.add_subcommand("reproduce", "Run all experiments, draw the figures, write the report");
  reproduce
      ->add_option("--only", command->only,
                   fmt::format("these only: {}", fmt::join(shipped_experiments(), ", ")))
      ->type_name("NAME");
  reproduce->add_option("--out", command->out, "the report goes to DIR/report/index.html")
      ->type_name("DIR")
      ->capture_default_str();
  command->size.add_to(*reproduce);
  reproduce->callback([command] { command->run(); });
}

}  // namespace kairos::experiments
