#include "core/model.hpp"
#include "core/plain_balls.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/cli/run_options.hpp"
#include "simulation/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace kairos::experiments {
namespace {

/// "1 x 0.5", "sqrt(1 x 0.5)", "min(1, 0.5)".
std::string combination(Combine how, double e, double other) {
  switch (how) {
    case Combine::product:
      return fmt::format("{} x {}", e, other);
    case Combine::geometric_mean:
      return fmt::format("sqrt({} x {})", e, other);
    case Combine::minimum:
      break;
  }
  return fmt::format("min({}, {})", e, other);
}

/// Explains the restitution of pairs: by default the product of both bodies', which few expect.
void explain_restitution(const Scene& scene, const Model& model) {
  std::map<double, BodyIndex> free;              // one body of each restitution
  std::map<double, std::vector<BodyIndex>> all;  // two of each, since no body meets itself
  for (BodyIndex i = 0; i < model.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (model.is_field(i) || body.entity->kind() == "hand") {
      continue;
    }
    if (std::vector<BodyIndex>& of_it = all[body.restitution]; of_it.size() < 2) {
      of_it.push_back(i);
    }
    if (model.is_free(i)) {
      free.emplace(body.restitution, i);
    }
  }
  if (free.empty() || all.empty()) {
    return;
  }
  const std::string_view how = to_string(scene.restitution_combine);
  fmt::print("\nrestitution\n");
  if (all.size() == 1 && all.begin()->first == 1.0) {
    fmt::print(
        "  impacts lose nothing{}\n      because the restitution of a body is 1 where nothing "
        "is said, and an impact has the {} of both\n",
        model.has_friction() ? " but to friction" : "", how);
    return;
  }
  constexpr std::size_t most = 8;
  std::set<std::pair<double, double>> told;
  for (const auto& [e, body] : free) {
    for (const auto& [other, partners] : all) {
      const BodyIndex partner = partners.front() != body ? partners.front() : partners.back();
      if (partner != body && told.size() < most && told.insert(std::minmax(e, other)).second) {
        fmt::print("  {} = {:.6g}, as for {} and {}\n",
                   combination(scene.restitution_combine, e, other),
                   combine(scene.restitution_combine, e, other), scene.bodies[body].name,
                   scene.bodies[partner].name);
      }
    }
  }
  fmt::print(
      "      because an impact has the {} of both bodies' restitution under newton, 1 "
      "for a body without a value; thesis has none\n",
      how);
}

/// Which schemes can run a scene with friction.
void explain_friction(const Model& model) {
  if (!model.has_friction()) {
    return;
  }
  std::string treat;
  std::string refuse;
  for (const auto& scheme : schemes()) {
    std::string& names = scheme->info().friction ? treat : refuse;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", scheme->info().name);
  }
  fmt::print("  schemes that treat it: {}\n", treat.empty() ? "none yet" : treat);
  if (!refuse.empty()) {
    fmt::print("  schemes that know none and refuse the scene: {}\n", refuse);
  }
}

/// Which bodies `event-driven` lets meet in fewer words.
void explain_plain_balls(const Model& model) {
  const PlainBalls plain(model);
  if (plain.count() > 0) {
    fmt::print("\nplain balls\n  {} of {} bodies meet each other as points with a radius\n",
               plain.count(), model.size());
    fmt::print("      because {}\n", PlainBalls::reason);
  }
}

void explain(const SceneOptions& options) {
  const Model model(options.scene());
  const Scene& scene = model.scene();
  fmt::print("{}: {}\n", scene.name, scene.summary);
  std::string_view topic;
  for (const Decision& decision : model.decisions()) {
    if (topic == "friction" && decision.topic != topic) {
      explain_friction(model);
    }
    if (decision.topic != topic) {
      topic = decision.topic;
      fmt::print("\n{}\n", topic);
    }
    fmt::print("  {}\n      because {}\n", decision.text, decision.reason);
  }
  explain_plain_balls(model);
  explain_restitution(scene, model);
}

}  // namespace

void add_explain_command(Command& app) {
  const auto options = std::make_shared<SceneOptions>();
  Command command = app.add_subcommand(
      "explain", "Say what the model of a scene leaves out, what it chooses, and why");
  options->add_to(command);
  command.callback([options] { explain(*options); });
}

}  // namespace kairos::experiments
