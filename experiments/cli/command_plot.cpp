#include "core/error.hpp"
#include "experiments/cli/checks.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/figures/draw_figures.hpp"
#include "experiments/output/output_folder.hpp"
#include "experiments/run_error.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

namespace kairos::experiments {
namespace {

struct PlotCommand {
  std::vector<std::string> runs;
  std::string out;
  std::string bodies;

  void run() const;
};

void PlotCommand::run() const {
  std::error_code none;
  for (const std::string& folder : runs) {
    if (!std::filesystem::is_regular_file(std::filesystem::path(folder) / "summary.json", none)) {
      throw InputError(folder, 0, "", "holds no summary.json; needed: what kairos run --out wrote");
    }
    if (incomplete(folder)) {
      throw InputError(folder, 0, "", "is not whole: it was being written when the program ended");
    }
  }
  const std::filesystem::path picture =
      out.empty() ? std::filesystem::path(runs.front()) / "plot.png" : std::filesystem::path(out);
  const std::string kind = picture.extension().string();
  if (kind != ".png" && kind != ".svg" && kind != ".pdf") {
    throw InputError("", 0, "--out",
                     fmt::format("'{}' is not allowed; allowed: a file .png, .svg or .pdf", out));
  }
  if (const std::string problem = draw_runs(runs, bodies, picture.string()); !problem.empty()) {
    throw RunError(problem);
  }
  fmt::print("{}\n", picture.string());
}

}  // namespace

void add_plot_command(Command& app) {
  const auto command = std::make_shared<PlotCommand>();
  Command plot = app.add_subcommand(
      "plot", "Draw runs over time, beside each other: height, gap, speed, energy ledger, events");
  plot.add_option("runs", command->runs, "folders that `kairos run --out` wrote")
      .required()
      .type_name("RUN...");
  plot.add_option("--out", command->out,
                  "the picture: .png, .svg or .pdf (default: plot.png in the first folder)")
      .type_name("FILE");
  plot.add_option("--bodies", command->bodies,
                  "names of those that are drawn, with commas (default: those that move, up to 6)")
      .type_name("A,B");
  plot.callback([command] { command->run(); });
}

}  // namespace kairos::experiments
