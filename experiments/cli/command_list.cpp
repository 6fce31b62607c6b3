#include "core/entity.hpp"
#include "core/error.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/registry.hpp"
#include "experiments/scene_library.hpp"
#include "experiments/sweeps/experiment_library.hpp"
#include "experiments/sweeps/sweep_spec.hpp"
#include "experiments/thesis/thesis_figure.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <array>
#include <functional>
#include <memory>
#include <string>

namespace kairos::experiments {
namespace {

void list_schemes() {
  for (const auto& scheme : schemes()) {
    const SchemeInfo info = scheme->info();
    fmt::print("  {:<24}{} [{}]\n", info.name, info.summary, info.source);
  }
}

/// "exact" or the order.
std::string order(int order) { return order == 0 ? "exact" : fmt::format("{}", order); }

void list_integrators() {
  fmt::print("  {:<24}{:<10}{:<22}{:<12}{:<12}{:<10}{}\n", "", "order", "dense position/speed",
             "symplectic", "step", "library", "source");
  fmt::print("  {:<24}closed-form where the model allows it, a Runge-Kutta method otherwise\n",
             "auto");
  for (const IntegratorEntry& entry : integrators()) {
    const StepperInfo& info = entry.info;
    const std::string most = info.variable_order ? "up to " : "";
    fmt::print("  {:<24}{:<10}{:<22}{:<12}{:<12}{:<10}{}\n", info.name, most + order(info.order),
               most + order(info.position_order) + " / " + order(info.velocity_order),
               info.symplectic ? "yes" : "no",
               info.controlled   ? "controlled"
               : info.order == 0 ? "any"
                                 : "fixed",
               info.library, info.source);
  }
}

void list_detectors() {
  for (const auto& detector : detectors()) {
    const DetectorInfo info = detector->info();
    fmt::print("  {:<24}{}{}{}\n", info.name, info.summary, info.locates ? "; locates" : "",
               info.proves ? "; proves" : "");
  }
}

void list_impact_laws() {
  for (const auto& law : impact_laws()) {
    fmt::print("  {:<24}{}\n", law->info().name, law->info().summary);
  }
}

void list_broad_phases() {
  for (const std::string_view name : broad_phases()) {
    fmt::print("  {}\n", name);
  }
}

void list_entities() {
  for (const EntityType& type : entity_catalogue()) {
    fmt::print("  {:<24}{} [{}]\n", type.kind, type.summary, type.source);
  }
}

void list_scenes() {
  for (const std::string& name : shipped_scenes()) {
    std::string summary;
    try {
      summary = read_scene(find_scene(name)).summary;
    } catch (const InputError& error) {
      summary = fmt::format("cannot be read: {}", error.what());
    }
    fmt::print("  {:<24}{}\n", name, summary);
  }
}

void list_experiments() {
  for (const std::string& name : shipped_experiments()) {
    fmt::print("  {:<24}{}\n", name, read_experiment(find_experiment(name), Size::quick).title);
  }
}

void list_figures() {
  for (const ThesisFigure& figure : thesis_figures()) {
    fmt::print("  {:<24}{}\n", figure.name, figure.title);
  }
}

struct Section {
  const char* name;
  void (*list)();
};
constexpr std::array<Section, 9> sections{{{"schemes", list_schemes},
                                           {"integrators", list_integrators},
                                           {"detectors", list_detectors},
                                           {"impact-laws", list_impact_laws},
                                           {"broad-phases", list_broad_phases},
                                           {"entities", list_entities},
                                           {"scenes", list_scenes},
                                           {"experiments", list_experiments},
                                           {"figures", list_figures}}};

}  // namespace

void add_list_command(CLI::App& app) {
  const auto wanted = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("list", "What there is to choose from");
  std::vector<std::string> names;
  for (const Section& section : sections) {
    names.emplace_back(section.name);
  }
  command->add_option("what", *wanted, "one of them only")->check(CLI::IsMember(names));
  command->callback([wanted] {
    for (const Section& section : sections) {
      if (wanted->empty() || *wanted == section.name) {
        fmt::print("{}\n", section.name);
        section.list();
      }
    }
  });
}

}  // namespace kairos::experiments
