#include "experiments/output/run_summary.hpp"

#include "core/mesh_body.hpp"
#include "core/reading/csv.hpp"
#include "simulation/option.hpp"
#include "simulation/output/json_writer.hpp"
#include "simulation/registry.hpp"
#include "simulation/version.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>

namespace kairos::experiments {
namespace {

std::string_view gravity_name(GravityMode mode) {
  return mode == GravityMode::force ? "force" : "acceleration";
}

/// The integrators in use, each once: `auto` may have chosen several.
std::string integrators_in_use(const FinishedRun& run) {
  if (const SchemeInfo scheme = find_scheme(run.choice.method.scheme)->info();
      !scheme.integrator.empty()) {
    return std::string(scheme.integrator);
  }
  const IslandStepperFactory make =
      find_integrator(run.choice.method.integrator, run.choice.stepper);
  std::set<std::string> names;
  for (std::size_t i = 0; i < run.model.islands().size(); ++i) {
    names.emplace(make(run.model, i)->info().name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

double largest_error(const FinishedRun& run) {
  return std::max(run.metrics.max_energy_error, std::abs(energy_error(run.result.ledger)));
}

void add_scene(JsonWriter& json, const Scene& scene) {
  json.open("scene");
  json.text("name", scene.name);
  json.text("file", scene.path);
  json.text("gravity", gravity_name(scene.gravity));
  json.open("bounds");
  for (const Body& body : scene.bodies) {
    json.text(body.name, to_string(body.bounds));
  }
  json.close();
  json.close();
}

/// Meshes with more triangles are drawn as the box around them.
constexpr std::size_t most_drawn = 20'000;

/// Corners of triangles, "0 1 2; 0 2 3; ...".
std::string written(const std::vector<Triangle>& triangles) {
  std::string text;
  for (const Triangle& t : triangles) {
    text += fmt::format("{}{} {} {}", text.empty() ? "" : "; ", t[0], t[1], t[2]);
  }
  return text;
}

/// Vertices, "x y z; x y z; ...", body axes.
std::string written(const std::vector<Vector3>& vertices) {
  std::string text;
  for (const Vector3& x : vertices) {
    text += fmt::format("{}{} {} {}", text.empty() ? "" : "; ", x.x(), x.y(), x.z());
  }
  return text;
}

/// Adds what a picture of the run needs about each body; `kairos render` reads it.
void add_bodies(JsonWriter& json, const Model& model) {
  constexpr std::string_view movers[] = {"fixed", "driven", "free"};
  json.open("bodies");
  for (BodyIndex i = 0; i < model.size(); ++i) {
    const Body& body = model.body(i);
    json.open(body.name);
    json.text("entity", body.entity->kind());
    json.text("shape", shape_name(body.shape));
    if (const auto* half_space = std::get_if<HalfSpace>(&body.shape)) {
      json.number("nx", half_space->normal_B.x());
      json.number("ny", half_space->normal_B.y());
      json.number("nz", half_space->normal_B.z());
    } else {
      const Vector3 h = bounding_box(body.shape).half_extents;
      json.number("hx", h.x());
      json.number("hy", h.y());
      json.number("hz", h.z());
    }
    if (const auto* hull = std::get_if<Hull>(&body.shape)) {
      json.number("rounding", hull->rounding);
      json.text("vertices", written(hull->core->vertices));
    }
    const auto* mesh = std::get_if<Mesh>(&body.shape);
    if (mesh != nullptr && mesh->body->mesh.triangles().size() <= most_drawn) {
      json.text("vertices", written(mesh->body->mesh.vertices()));
      json.text("triangles", written(mesh->body->mesh.triangles()));
    }
    json.text("bounds", to_string(body.bounds));
    json.text("moves", movers[static_cast<std::size_t>(model.mobility(i))]);
    json.flag("field", model.is_field(i));
    json.close();
  }
  json.close();
}

/// A value of the table of options, as JSON; what the scene decides is left out here.
void add_option(JsonWriter& json, const Option& option, const RunChoice& choice) {
  const std::string text = option.get(choice);
  switch (option.kind) {
    case OptionKind::flag:
      json.flag(option.name, text == "true");
      return;
    case OptionKind::number:
    case OptionKind::count:
    case OptionKind::duration:
      if (!text.empty()) {
        json.number(option.name,
                    parse_number(text).value_or(std::numeric_limits<double>::infinity()));
      }
      return;
    case OptionKind::name:
    case OptionKind::frames:
      json.text(option.name, text);
      return;
  }
}

void add_method(JsonWriter& json, const FinishedRun& run) {
  RunChoice choice = run.choice;
  choice.frames = choice.frames.value_or(run.model.scene().frames);
  choice.duration = choice.duration.value_or(run.model.scene().duration);
  json.open("method");
  for (const Option& option : options()) {
    add_option(json, option, choice);
  }
  json.text("integrators_in_use", integrators_in_use(run));
  json.text("broad_phase", run.model.broad_phase());
  json.number("mean_frame", mean_frame_duration(*choice.frames));
  json.close();
}

void add_metrics(JsonWriter& json, const FinishedRun& run) {
  const RunMetrics& metrics = run.metrics;
  const double final_error = energy_error(run.result.ledger);
  json.open("metrics");
  const RunMetrics::Deepest& deepest = metrics.deepest();
  json.number("max_depth", deepest.depth);
  const std::size_t n = run.model.size();  // a checkpoint may have been forged
  if (deepest.pair && deepest.pair->first < n && deepest.pair->second < n) {
    json.number("time_of_max_depth", deepest.time);
    json.text("deepest_a", run.model.body(deepest.pair->first).name);
    json.text("deepest_b", run.model.body(deepest.pair->second).name);
  }
  json.number("time_overlapping", metrics.time_overlapping);
  json.count("frames_overlapping", metrics.frames_overlapping);
  json.number("energy_error", final_error);
  json.number("energy_error_relative", metrics.relative(final_error));
  json.number("max_energy_error", largest_error(run));
  json.number("max_energy_error_relative", metrics.relative(largest_error(run)));
  json.number("energy_scale", metrics.energy_scale);
  json.close();
}

void add_energy(JsonWriter& json, const EnergyLedger& ledger) {
  json.open("energy");
  json.number("initial", ledger.initial_energy());
  json.number("kinetic", ledger.kinetic());
  json.number("potential", ledger.potential());
  for (std::size_t i = 0; i < energy_line_count; ++i) {
    const auto line = static_cast<EnergyLine>(i);
    json.number(to_string(line), ledger.line(line));
  }
  json.number("unexplained", ledger.unexplained());
  json.number("flow", ledger.flow());
  json.close();
}

void add_cost(JsonWriter& json, const Cost& cost) {
  json.open("cost");
  json.count("frames", cost.frames);
  json.count("steps", cost.steps);
  json.count("right_hand_sides", cost.right_hand_sides);
  json.count("overlap_tests", cost.overlap_tests);
  json.count("toi_queries", cost.toi_queries);
  json.count("toi_evaluations", cost.toi_evaluations);
  json.count("contact_solves", cost.contact_solves);
  json.count("impacts", cost.impacts);
  json.count("events", cost.events);
  json.close();
}

std::string_view status_name(RunStatus status) {
  return status == RunStatus::completed ? "completed" : "stopped";
}

}  // namespace

std::string summary_json(const FinishedRun& run) {
  JsonWriter json;
  add_scene(json, run.model.scene());
  add_bodies(json, run.model);
  add_method(json, run);
  json.open("versions");
  for (const auto& [name, version] : versions()) {
    json.text(name, version);
  }
  json.close();
  json.text("status", status_name(run.result.status));
  json.text("reason", run.result.reason);
  json.number("end", run.result.end.seconds);
  add_metrics(json, run);
  add_energy(json, run.result.ledger);
  add_cost(json, run.result.cost);
  return json.finish();
}

std::string summary_text(const FinishedRun& run) {
  const MethodChoice& method = run.choice.method;
  const RunMetrics& metrics = run.metrics;
  const EnergyLedger& ledger = run.result.ledger;
  std::string text;
  const auto line = [&text](std::string_view name, const std::string& value) {
    fmt::format_to(std::back_inserter(text), "{:<22}{}\n", name, value);
  };
  line("scene", run.model.scene().name);
  const std::string in_use = integrators_in_use(run);
  const bool as_named = in_use.empty() || in_use == method.integrator;
  line("method",
       fmt::format("{} + {}{} + {} + {}", method.scheme, method.integrator,
                   as_named ? "" : fmt::format(" ({})", in_use), method.detector, method.impact));
  line(status_name(run.result.status), fmt::format("t = {} s", run.result.end.seconds));
  line("frames", fmt::format("{}", run.result.cost.frames));
  line("integrator steps", fmt::format("{}, {} right-hand sides", run.result.cost.steps,
                                       run.result.cost.right_hand_sides));
  line("impacts", fmt::format("{}", run.result.cost.impacts));
  line("deepest penetration", fmt::format("{:.6g} m", metrics.deepest().depth));
  line("time overlapping", fmt::format("{:.6g} s", metrics.time_overlapping));
  const double final_error = energy_error(ledger);
  line("energy error",
       fmt::format("{:.3e} J ({:.3e} of {:.6g} J), at most {:.3e} J", final_error,
                   metrics.relative(final_error), metrics.energy_scale, largest_error(run)));
  line("energy",
       fmt::format("{:.9g} J kinetic, {:.9g} J potential", ledger.kinetic(), ledger.potential()));
  for (std::size_t i = 0; i < energy_line_count; ++i) {
    const auto name = static_cast<EnergyLine>(i);
    if (ledger.line(name) != 0.0) {
      line(fmt::format("  {}", to_string(name)), fmt::format("{:.6e} J", ledger.line(name)));
    }
  }
  line("  unexplained", fmt::format("{:.1e} J", ledger.unexplained()));
  return text;
}

}  // namespace kairos::experiments
