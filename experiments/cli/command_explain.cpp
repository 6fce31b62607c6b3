#include "core/model.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/cli/run_options.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>

namespace kairos::experiments {
namespace {

/// What of the speed each impact keeps: the product of both bodies, which few expect.
void explain_restitution(const Scene& scene, const Model& model) {
  std::map<double, std::string> free, all;  // one body of each restitution
  for (BodyIndex i = 0; i < model.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (model.is_field(i) || body.entity->kind() == "hand") {
      continue;
    }
    all.emplace(body.restitution, body.name);
    if (model.is_free(i)) {
      free.emplace(body.restitution, body.name);
    }
  }
  if (free.empty() || all.empty()) {
    return;
  }
  fmt::print("\nrestitution\n");
  if (all.size() == 1 && all.begin()->first == 1.0) {
    fmt::print(
        "  impacts lose nothing\n      because the restitution of a body is 1 where nothing "
        "is said, and an impact has the product of both\n");
    return;
  }
  constexpr std::size_t most = 8;
  std::set<std::pair<double, double>> told;
  for (const auto& [e, ball] : free) {
    for (const auto& [other, partner] : all) {
      if (told.size() < most && told.insert(std::minmax(e, other)).second) {
        fmt::print("  {} x {} = {:.6g}, as for {} and {}\n", e, other, e * other, ball, partner);
      }
    }
  }
  fmt::print(
      "      because an impact has the product of both bodies' restitution under newton, 1 "
      "for a body of which nothing is said; thesis knows none\n");
}

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
  explain_restitution(scene, model);
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
