#include "core/model.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/cli/run_options.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <memory>

namespace kairos::experiments {
namespace {

void explain(const SceneOptions& options) {
  const Model model(options.scene());
  const Scene& scene = model.scene();
  fmt::print("{}: {}\n", scene.name, scene.summary);
  std::string_view topic;
  for (const Decision& decision : model.decisions()) {
    if (decision.topic != topic) {
      topic = decision.topic;
      fmt::print("\n{}\n", topic);
    }
    fmt::print("  {}\n      because {}\n", decision.text, decision.reason);
  }
}

}  // namespace

void add_explain_command(CLI::App& app) {
  const auto options = std::make_shared<SceneOptions>();
  CLI::App* command = app.add_subcommand(
      "explain", "Say what the model of a scene leaves out, what it chooses, and why");
  options->add_to(*command);
  command->callback([options] { explain(*options); });
}

}  // namespace kairos::experiments
