// Clang finds a function of an inline namespace where a namespace of that name is opened: the
// namespace `integrators` comes first.
// clang-format off
#include "integrators/catalogue/catalogue.hpp"
#include "integrators/closed_form_or.hpp"
// clang-format on
#include "simulation/registry.hpp"

#include "ccd/all_pairs.hpp"
#include "ccd/bisection.hpp"
#include "ccd/cells.hpp"
#include "ccd/certified.hpp"
#include "ccd/conservative_advancement.hpp"
#include "ccd/dynamic_tree.hpp"
#include "ccd/sat.hpp"
#include "ccd/step_ends.hpp"
#include "ccd/sweep_and_prune.hpp"
#include "ccd/swept_box.hpp"
#include "ccd/swept_windows.hpp"
#include "core/error.hpp"
#include "core/laws/garwin_law.hpp"
#include "core/laws/newton_law.hpp"
#include "core/laws/routh_law.hpp"
#include "core/laws/simultaneous_laws.hpp"
#include "core/laws/thesis_law.hpp"
#include "core/model.hpp"
#include "core/nearest_name.hpp"
#include "core/schemes/event/event_driven.hpp"
#include "core/schemes/frame/bisected.hpp"
#include "core/schemes/frame/geometric.hpp"
#include "core/schemes/frame/original.hpp"
#include "core/schemes/frame/substepped.hpp"
#include "core/schemes/stepping/moreau_jean.hpp"
#include "core/schemes/stepping/penalty.hpp"
#include "core/schemes/stepping/pgs.hpp"
#include "core/schemes/stepping/xpbd.hpp"
#include "simulation/model_gaps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

namespace kairos {
inline namespace simulation {
namespace {

template <typename Port>
using Entries = std::vector<std::shared_ptr<const Port>>;

[[noreturn]] void unknown(std::string_view port, std::string_view name,
                          std::span<const std::string_view> names) {
  throw InputError("", 0, std::string(port),
                   fmt::format("'{}' is unknown; {}", name, suggestion(name, names)));
}

/// The entry of that name, by what each says of itself.
template <typename Port>
std::shared_ptr<const Port> find(std::string_view port, std::string_view name,
                                 std::span<const std::shared_ptr<const Port>> entries) {
  std::vector<std::string_view> names;
  for (const auto& entry : entries) {
    if (entry->info().name == name) {
      return entry;
    }
    names.push_back(entry->info().name);
  }
  unknown(port, name, names);
}

/// What `auto` means where a detector needs a stepper that finds impacts by itself.
constexpr std::string_view rootfinding_integrator = "cvode-adams";

using NamedBroadPhase = std::pair<std::string_view, std::unique_ptr<BroadPhase> (*)(std::size_t)>;
/// Cells hold bodies on the motions that they have; of boxes a tree does as well.
constexpr std::array<NamedBroadPhase, 4> broad_phase_catalogue{
    {{"all-pairs", ccd::make_all_pairs},
     {"sweep-and-prune", ccd::make_sweep_and_prune},
     {"dynamic-tree", ccd::make_dynamic_tree},
     {"cells", ccd::make_dynamic_tree}}};

bool has_integrator(std::string_view name) {
  const auto all = integrator_entries();
  return std::any_of(all.begin(), all.end(),
                     [name](const IntegratorEntry& entry) { return entry.info.name == name; });
}

const IntegratorEntry& find_entry(std::string_view name) {
  std::vector<std::string_view> names{"auto"};
  for (const IntegratorEntry& entry : integrator_entries()) {
    if (entry.info.name == name) {
      return entry;
    }
    names.push_back(entry.info.name);
  }
  unknown("integrator", name, names);
}

}  // namespace

std::span<const std::shared_ptr<const Scheme>> schemes() {
  static const Entries<Scheme> entries{make_original(), make_geometric(),    make_substepped(),
                                       make_bisected(), make_event_driven(), make_moreau_jean(),
                                       make_pgs(),      make_xpbd(),         make_penalty()};
  return entries;
}

std::span<const std::shared_ptr<const ContactDetector>> detectors() {
  static const Entries<ContactDetector> entries = [] {
    Entries<ContactDetector> made{ccd::make_sat(), ccd::make_linear(), ccd::make_bisection(),
                                  ccd::make_conservative_advancement(), ccd::make_certified()};
    if (has_integrator(rootfinding_integrator)) {
      made.push_back(ccd::make_cvode_rootfinding());
    }
    return made;
  }();
  return entries;
}

std::span<const std::shared_ptr<const ImpactLaw>> impact_laws() {
  static const Entries<ImpactLaw> entries{make_thesis_law(), make_newton_law(),
                                          make_moreau_law(), make_reflections_law(),
                                          make_routh_law(),  make_garwin_law()};
  return entries;
}

std::span<const IntegratorEntry> integrator_entries() {
  static const std::vector<IntegratorEntry> entries = [] {
    std::vector<IntegratorEntry> made;
    for (const auto& [info, make] : integrators::catalogue()) {
      made.push_back({info, make});
    }
    return made;
  }();
  return entries;
}

std::shared_ptr<const Scheme> find_scheme(std::string_view name) {
  return find("scheme", name, schemes());
}
std::shared_ptr<const ContactDetector> find_detector(std::string_view name) {
  return find("detector", name, detectors());
}
std::shared_ptr<const ImpactLaw> find_impact_law(std::string_view name) {
  return find("impact law", name, impact_laws());
}

IslandStepperFactory find_integrator(std::string_view name, const StepperOptions& options) {
  if (name == "auto") {
    return [options](const Model& model, std::size_t island) {
      if (model.closed_form(island)) {
        return find_entry("closed-form").make(options);
      }
      std::unique_ptr<Stepper> stepper = find_entry("dopri5").make(options);
      return model.tumbles(island) ? integrators::make_closed_form_or(std::move(stepper))
                                   : std::move(stepper);
    };
  }
  return
      [make = find_entry(name).make, options](const Model&, std::size_t) { return make(options); };
}

IslandStepperFactory find_watching_integrator(std::string_view name,
                                              const StepperOptions& options) {
  const auto make = find_entry(name == "auto" ? rootfinding_integrator : name).make;
  return [make, options](const Model& model, std::size_t island) {
    std::unique_ptr<Stepper> stepper = make(options);
    return stepper->watch(std::make_shared<const ModelGaps>(model, island)) ? std::move(stepper)
                                                                            : nullptr;
  };
}

std::span<const std::string_view> broad_phases() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> made;
    for (const auto& [name, make] : broad_phase_catalogue) {
      made.push_back(name);
    }
    return made;
  }();
  return names;
}

BroadPhaseFactory find_broad_phase(std::string_view name) {
  for (const auto& [known, make] : broad_phase_catalogue) {
    if (known == name) {
      return make;
    }
  }
  unknown("broad phase", name, broad_phases());
}

NeighbourhoodFactory find_neighbourhood(std::string_view name) {
  if (name == "cells") {
    return ccd::make_cells;
  }
  return [boxes = find_broad_phase(name)](const Model& model, double tolerance) {
    return std::make_unique<ccd::SweptWindows>(model, boxes(model.size()), tolerance);
  };
}

SweptBounds swept_bounds() {
  return [](const MovingShape& moving, const Window& window) {
    const double start = window.start - moving.motion.start;
    return ccd::swept_aabb(moving.shape, moving.motion, start, start + window.duration);
  };
}

}  // namespace simulation
}  // namespace kairos
