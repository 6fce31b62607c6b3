#include "core/entity.hpp"
#include "core/reading/scene_keys.hpp"
#include "simulation/option.hpp"
#include "simulation/output/json_writer.hpp"
#include "simulation/registry.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/version.hpp"

#include "studio/engine/engine.hpp"

namespace kairos::studio {
namespace {

void add_names(JsonWriter& json) {
  json.open("scheme");
  for (const auto& scheme : schemes()) {
    json.text(scheme->info().name, scheme->info().summary);
  }
  json.close();
  json.open("integrator");
  json.text("auto", "closed form where the scene allows it, a Runge-Kutta method otherwise");
  for (const IntegratorEntry& entry : integrator_entries()) {
    json.text(entry.info.name, entry.info.source);
  }
  json.close();
  json.open("detector");
  for (const auto& detector : detectors()) {
    json.text(detector->info().name, detector->info().summary);
  }
  json.close();
  json.open("impact");
  for (const auto& law : impact_laws()) {
    json.text(law->info().name, law->info().summary);
  }
  json.close();
}

void add_options(JsonWriter& json) {
  constexpr std::string_view kinds[] = {"name", "number", "count", "flag", "duration", "frames"};
  for (const Option& option : options()) {
    json.open(option.name);
    json.text("kind", kinds[static_cast<std::size_t>(option.kind)]);
    json.text("help", option.help);
    json.text("default", option.default_text());
    json.text("unit", option.range.unit);
    json.text("allowed", option.kind == OptionKind::number || option.kind == OptionKind::count
                             ? option.range.text()
                             : "");
    json.close();
  }
}

void add_entities(JsonWriter& json) {
  constexpr std::string_view movers[] = {"fixed", "driven", "free"};
  for (const EntityType& type : entity_catalogue()) {
    json.open(type.kind);
    json.text("moves", movers[static_cast<std::size_t>(type.mobility)]);
    json.open("keys");
    for (const EntityKey& key : type.keys) {
      json.text(key.key, key.unit);
    }
    json.close();
    json.close();
  }
}

}  // namespace

Answer about() {
  JsonWriter json;
  json.text("version", version());
  json.open("names");
  add_names(json);
  json.close();
  json.open("options");
  add_options(json);
  json.close();
  json.open("entities");
  add_entities(json);
  json.close();
  json.open("keys");
  for (const SceneKey& key : scene_keys()) {
    json.text(std::string(key.table) + (key.table.empty() ? "" : ".") + std::string(key.key), "");
  }
  json.close();
  json.open("scenes");
  for (const std::string& name : shipped_scenes()) {
    json.text(name, shipped_scene_path(name));
  }
  json.close();
  return {.json = json.finish()};
}

}  // namespace kairos::studio
