#include "python/bindings/scene.hpp"

#include "core/error.hpp"
#include "core/model.hpp"
#include "core/nearest_name.hpp"
#include "simulation/scene_library.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "python/bindings/bindings.hpp"
#include "python/bindings/values.hpp"
#include <memory>
#include <utility>

namespace py = pybind11;

namespace kairos::python {
namespace {

Value unplaced(decltype(Value::data) data) {
  static const auto no_file = std::make_shared<const std::string>();
  return {std::move(data), no_file, 0};
}

/// What a driven body is read with before its own drive takes the place: it stands still.
Value stand_in_drive() {
  Table drive;
  drive.set("amplitude", unplaced(Array{unplaced(0.0), unplaced(0.0), unplaced(0.0)}));
  drive.set("frequency", unplaced(1.0));
  return unplaced(std::move(drive));
}

/// A value as the right-hand side of a line of TOML.
std::string literal(const py::handle& object, const std::string& key) {
  Array one;
  one.push_back(value_of(object, key));
  Table line;
  line.set("v", unplaced(std::move(one)));  // in a list, so that a table stays in its line
  const std::string text = to_toml(line);
  const std::size_t open = text.find('[');
  return text.substr(open + 1, text.rfind(']') - open - 1);
}

BodyIndex find_body(const Scene& scene, const std::string& name, const std::string& key) {
  std::vector<std::string_view> names;
  for (BodyIndex i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].name == name) {
      return i;
    }
    names.push_back(scene.bodies[i].name);
  }
  throw InputError(
      scene.path, 0, key,
      fmt::format("\"{}\" is no body of the scene; {}", name, suggestion(name, names)));
}

}  // namespace

SceneDraft::SceneDraft(const std::string& name) : root_(unplaced(Table{})) {
  root().set("name", unplaced(name));
}

SceneDraft SceneDraft::read(const std::string& path) {
  SceneDraft draft("");
  draft.path_ = find_scene(path);
  draft.written_elsewhere_ = draft.path_.ends_with(".def");
  if (!draft.written_elsewhere_) {
    draft.root_ = parse_document(read_text_file(draft.path_), draft.path_);
  }
  return draft;
}

SceneDraft SceneDraft::parse(const std::string& text, const std::string& path) {
  SceneDraft draft("");
  draft.path_ = path;
  draft.root_ = parse_document(text, path);
  return draft;
}

Table& SceneDraft::root() {
  if (written_elsewhere_) {
    throw InputError(path_, 0, "",
                     "is in the thesis' format, which takes no more keys; allowed: "
                     "a scene in TOML, or override()");
  }
  return std::get<Table>(root_.data);
}

void SceneDraft::set(const py::dict& keys) {
  const Table table = table_of(keys, "");
  for (std::size_t i = 0; i < table.keys.size(); ++i) {
    root().set(table.keys[i], table.values[i]);
  }
}

void SceneDraft::append(const std::string& list, Table element) {
  Table& table = root();
  if (const Value* present = table.find(list); present == nullptr || present->array() == nullptr) {
    table.set(list, unplaced(Array{}));
  }
  std::get<Array>(table.find(list)->data).push_back(unplaced(std::move(element)));
}

void SceneDraft::body(const std::string& name, const py::dict& keys) {
  py::dict plain(keys.attr("copy")());
  if (plain.contains("drive") && PyCallable_Check(plain["drive"].ptr()) != 0) {
    drives_[name] = plain["drive"];
    plain["drive"] = py::none();
  }
  Table table = table_of(plain, "body." + name);
  table.set("name", unplaced(name));
  if (drives_.contains(name)) {
    table.set("drive", stand_in_drive());
  }
  append("body", std::move(table));
}

void SceneDraft::add(const std::string& list, const py::dict& keys) {
  append(list, table_of(keys, list));
}

void SceneDraft::force(const py::dict& keys) { append("force", table_of(keys, "force")); }

void SceneDraft::own_force(ForceChoices choices, std::vector<std::string> bodies) {
  forces_.push_back({std::move(choices), std::move(bodies)});
}

void SceneDraft::override_key(const std::string& key, const py::handle& value) {
  overrides_.push_back({key, literal(value, key)});
}

void SceneDraft::add_forces(Scene& scene) const {
  for (const OwnForce& own : forces_) {
    SceneForce force;
    const std::string key = "force." + own.choices.name;
    for (const std::string& name : own.bodies) {
      const BodyIndex i = find_body(scene, name, key);
      if (scene.bodies[i].drive != nullptr ||
          scene.bodies[i].entity->mobility() != Mobility::free) {
        throw InputError(scene.path, 0, key,
                         fmt::format("\"{}\", a {}, is not moved by forces; allowed: bodies that "
                                     "move freely",
                                     name, scene.bodies[i].entity->kind()));
      }
      if (own.choices.rotation && !scene.bodies[i].entity->rotates()) {
        throw InputError(scene.path, 0, key,
                         fmt::format("involves rotation, and \"{}\", a {}, does not turn; allowed: "
                                     "the entity \"body\"",
                                     name, scene.bodies[i].entity->kind()));
      }
      force.bodies.push_back(i);
    }
    force.force = make_python_force(own.choices, own.bodies.size());
    scene.forces.push_back(std::move(force));
  }
}

Scene SceneDraft::build() const {
  Scene scene = written_elsewhere_ ? read_scene(path_, overrides_)
                                   : read_scene_document(root_, path_, overrides_);
  for (const auto& [name, callable] : drives_) {
    Body& body = scene.bodies[find_body(scene, name, "body." + name + ".drive")];
    body.drive = make_python_drive(name, callable);
    const Motion motion = body.drive->motion(Instant{}, 1.0);
    body.initial = {motion.pose(0.0), motion.twist(0.0)};
  }
  add_forces(scene);
  return scene;
}

std::string SceneDraft::toml() const {
  if (has_callables()) {
    throw InputError(path_, 0, "", "holds callables of Python, which no scene file can");
  }
  if (written_elsewhere_) {
    return read_text_file(path_);
  }
  return to_toml(std::get<Table>(root_.data));
}

std::string SceneDraft::name() const {
  const Table* table = root_.table();
  const Value* name = table == nullptr ? nullptr : table->find("name");
  const auto* text = name == nullptr ? nullptr : std::get_if<std::string>(&name->data);
  return text != nullptr && !text->empty() ? *text : build().name;
}

namespace {

py::list explained(const SceneDraft& draft) {
  const Model model(draft.build());
  py::list rows;
  for (const Decision& decision : model.decisions()) {
    rows.append(py::make_tuple(decision.topic, decision.text, decision.reason));
  }
  return rows;
}

py::list body_names(const SceneDraft& draft) {
  py::list names;
  for (const Body& body : draft.build().bodies) {
    names.append(body.name);
  }
  return names;
}

}  // namespace

void bind_scene(py::module_& module) {
  py::class_<SceneDraft>(module, "SceneDraft", "A scene while it is written; see kairos.Scene.")
      .def(py::init<const std::string&>(), py::arg("name"))
      .def(py::init<const SceneDraft&>(), py::arg("other"))
      .def_static("read", &SceneDraft::read, py::arg("path"))
      .def_static("parse", &SceneDraft::parse, py::arg("text"), py::arg("path"))
      .def("set", &SceneDraft::set, py::arg("keys"))
      .def("body", &SceneDraft::body, py::arg("name"), py::arg("keys"))
      .def("add", &SceneDraft::add, py::arg("list"), py::arg("keys"))
      .def("force", &SceneDraft::force, py::arg("keys"))
      .def("own_force",
           [](SceneDraft& draft, const std::string& name, const py::object& callable,
              const std::vector<std::string>& bodies, const py::object& potential, bool rotation,
              bool single) {
             draft.own_force({name, callable, potential, rotation, single}, bodies);
           })
      .def("override", &SceneDraft::override_key, py::arg("key"), py::arg("value"))
      .def("toml", &SceneDraft::toml)
      .def("check", [](const SceneDraft& draft) { (void)Model(draft.build()); })
      .def("explain", &explained)
      .def("bodies", &body_names)
      .def_property_readonly("path", &SceneDraft::path)
      .def_property_readonly("name", &SceneDraft::name);
}

}  // namespace kairos::python
