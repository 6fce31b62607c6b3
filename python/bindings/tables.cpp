#include "core/entity.hpp"
#include "core/reading/scene_keys.hpp"
#include "simulation/option.hpp"
#include "simulation/registry.hpp"
#include "simulation/scene_library.hpp"

#include <pybind11/stl.h>

#include "python/bindings/bindings.hpp"

namespace py = pybind11;

namespace kairos::python {
namespace {

const char* kind_name(OptionKind kind) {
  switch (kind) {
    case OptionKind::name:
      return "name";
    case OptionKind::number:
      return "number";
    case OptionKind::count:
      return "count";
    case OptionKind::flag:
      return "flag";
    case OptionKind::duration:
      return "duration";
    case OptionKind::frames:
      return "frames";
  }
  return "";
}

py::list option_rows() {
  py::list rows;
  for (const Option& option : options()) {
    py::dict row;
    row["name"] = option.name;
    row["kind"] = kind_name(option.kind);
    row["unit"] = option.range.unit;
    row["default"] = option.default_text();
    row["help"] = option.help;
    rows.append(row);
  }
  return rows;
}

py::list entity_rows() {
  py::list rows;
  for (const EntityType& type : entity_catalogue()) {
    py::dict row;
    row["kind"] = type.kind;
    row["summary"] = type.summary;
    py::list keys;
    for (const EntityKey& key : type.keys) {
      keys.append(py::make_tuple(key.key, key.unit, key.meaning));
    }
    row["keys"] = keys;
    rows.append(row);
  }
  return rows;
}

template <typename Row>
void add_named(py::dict& plug_ins, const char* port, const Row& row) {
  py::list names;
  for (const auto& name : row) {
    names.append(name);
  }
  plug_ins[port] = names;
}

py::dict plug_ins() {
  py::dict dict;
  std::vector<std::string_view> names;
  for (const auto& scheme : schemes()) {
    names.push_back(scheme->info().name);
  }
  add_named(dict, "scheme", names);
  names = {"auto"};
  for (const IntegratorEntry& entry : integrator_entries()) {
    names.push_back(entry.info.name);
  }
  add_named(dict, "integrator", names);
  names.clear();
  for (const auto& detector : detectors()) {
    names.push_back(detector->info().name);
  }
  add_named(dict, "detector", names);
  names.clear();
  for (const auto& law : impact_laws()) {
    names.push_back(law->info().name);
  }
  add_named(dict, "impact", names);
  return dict;
}

}  // namespace

// The library's own tables: what is added there is here by itself.
void bind_tables(py::module_& module) {
  module.def("option_table", option_rows,
             "Every option of a run: name, kind, unit, default, help.");
  module.def("entity_table", entity_rows,
             "Every entity: kind, summary, own keys (key, unit, meaning).");
  module.def(
      "scene_keys", [](const std::string& table) { return scene_keys_of(table); }, py::arg("table"),
      "Keys of a table of scene files: '' (top level), 'frame', 'body', 'body.drive', 'force', "
      "...");
  module.def("plug_ins", plug_ins, "Names by port: scheme, integrator, detector, impact.");
  module.def("find_scene", &find_scene, py::arg("path_or_name"),
             "The file of a scene: the bare name of a shipped one, or a path.");
  module.def("shipped_scenes", &shipped_scenes, "Names of the shipped scenes that are found.");
}

}  // namespace kairos::python
