#include "core/error.hpp"
#include "core/nearest_name.hpp"
#include "experiments/cli/checks.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/cli/experiment_options.hpp"
#include "experiments/data_folders.hpp"
#include "experiments/report/report.hpp"
#include "experiments/report/report_entry.hpp"
#include "experiments/thesis/thesis_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <vector>

namespace kairos::experiments {
namespace {

namespace fs = std::filesystem;

struct ReproduceCommand {
  std::vector<std::string> only;
  std::string out = "out";
  SizeOptions size;

  void run() const;

 private:
  [[nodiscard]] std::vector<std::string> wanted() const;
  void make(const ThesisFigure& figure, const fs::path& folder) const;
  void make(const ExperimentSpec& spec, const fs::path& folder) const;
};

/// The wanted names, each once, as the report has them; figures may be written fig1 or 1.
std::vector<std::string> ReproduceCommand::wanted() const {
  const std::vector<std::string> all = reproducible_names();
  if (only.empty()) {
    return all;
  }
  std::vector<std::string> names;
  for (const std::string& name : only) {
    const ThesisFigure* figure = find_thesis_figure(name);
    const std::string known = figure != nullptr ? std::string(figure->name) : name;
    if (std::find(all.begin(), all.end(), known) == all.end()) {
      const std::vector<std::string_view> views(all.begin(), all.end());
      throw InputError("", 0, "--only",
                       fmt::format("'{}' is neither a figure nor an experiment; {}", name,
                                   suggestion(name, views)));
    }
    if (std::find(names.begin(), names.end(), known) == names.end()) {
      names.push_back(known);
    }
  }
  return names;
}

void ReproduceCommand::make(const ThesisFigure& figure, const fs::path& folder) const {
  fmt::print("{}\n  ", figure.title);
  std::fflush(stdout);
  const FigureOutcome made = make_figure(figure, size.size(), folder.string());
  fmt::print("{}: data in {:.1f} s, drawn in {:.1f} s -> {}\n", figure.name, made.data_seconds,
             made.drawing_seconds, folder.string());
  std::fflush(stdout);
  if (!made.problem.empty()) {
    fmt::print(stderr, "{}: {}\n", figure.name, made.problem);
  }
}

void ReproduceCommand::make(const ExperimentSpec& spec, const fs::path& folder) const {
  fmt::print("{}\n  ", spec.title);
  std::fflush(stdout);
  const std::string command =
      fmt::format("kairos experiment {} --{}", spec.name, to_string(size.size()));
  run_and_tell(spec, {size.size(), size.threads, command, size.force}, folder.string());
  std::fflush(stdout);
}

void ReproduceCommand::run() const {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<std::string> names = wanted();
  // All specs are read before anything runs: a mistake in the last shows at once.
  std::vector<ExperimentSpec> specs;
  for (const std::string& name : names) {
    if (find_thesis_figure(name) == nullptr) {
      specs.push_back(read_experiment(find_experiment(name), size.size()));
    }
  }
  const fs::path report = fs::path(out) / "report";
  fmt::print("{} figures and {} experiments at {} size, into {}\n", names.size() - specs.size(),
             specs.size(), to_string(size.size()), report.string());
  for (const std::string& name : names) {
    if (const ThesisFigure* figure = find_thesis_figure(name)) {
      make(*figure, report / name);
    }
  }
  for (const ExperimentSpec& spec : specs) {
    make(spec, report / spec.name);
  }
  const Report page = write_report(report.string());
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  fmt::print("In all {:.1f} s. The report: {}\n", seconds, page.path);
  if (only.empty() && !page.holes.empty()) {
    fmt::print(stderr, "paper: not made: {}\n", fmt::join(page.holes, ", "));
  }
}

}  // namespace

void add_reproduce_command(Command& app) {
  const auto command = std::make_shared<ReproduceCommand>();
  Command reproduce = app.add_subcommand(
      "reproduce", "Make the thesis' figures, run all experiments, write the report");
  reproduce
      .add_option("--only", command->only,
                  fmt::format("these only: {}", fmt::join(reproducible_names(), ", ")))
      .type_name("NAME");
  reproduce.add_option("--out", command->out, "the report goes to DIR/report/index.html")
      .type_name("DIR")
      .check(some_path())
      .capture_default_str();
  command->size.add_to(reproduce);
  reproduce.callback([command] { command->run(); });
}

}  // namespace kairos::experiments
