#include "core/error.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "python/bindings/arrays.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/callables.hpp"
#include "python/bindings/run_record.hpp"
#include "python/bindings/scene.hpp"
#include "python/bindings/values.hpp"
#include <cmath>

namespace py = pybind11;

namespace kairos::python {
namespace {

std::unique_ptr<RunRecord> run(const SceneDraft& draft, const py::dict& options,
                               const py::object& law, const py::object& listener,
                               bool keep_motions) {
  auto record = std::make_unique<RunRecord>();
  set_options_of(record->choice, options);
  record->model = std::make_unique<Model>(draft.build());
  record->kept = std::make_unique<RunKeeper>(keep_motions, listener);
  PlugIns own;
  if (!law.is_none()) {
    own.impact = make_python_law(law);
  }
  {
    const py::gil_scoped_release unlocked;
    record->result = simulate(*record->model, record->choice, *record->kept, {}, own);
    record->view = record->kept->finish_view();
  }
  return record;
}

std::string refused(const SceneDraft& draft, const py::dict& options) {
  RunChoice choice;
  set_options_of(choice, options);
  return why_refused(Model(draft.build()), choice);
}

py::array times_of(const py::object& self) {
  const auto& times = self.cast<const RunRecord&>().kept->times();
  py::array_t<double> view(static_cast<py::ssize_t>(times.size()), times.data(), self);
  view.attr("flags").attr("writeable") = false;
  return view;
}

/// A read-only view of one part of the states of all frames.
auto part(py::ssize_t offset) {
  return [offset](const py::object& self) {
    const auto& record = self.cast<const RunRecord&>();
    return states_view(record.kept->states(), record.model->size(), offset, self);
  };
}

py::array ledger_of(const py::object& self) {
  const auto& ledger = self.cast<const RunRecord&>().kept->ledger();
  RecordType type;
  type.field("frame", "<i8").field("t", "<f8").field("kinetic", "<f8").field("potential", "<f8");
  for (std::size_t i = 0; i < energy_line_count; ++i) {
    type.field(std::string(to_string(static_cast<EnergyLine>(i))), "<f8");
  }
  type.field("unexplained", "<f8").field("flow", "<f8");
  py::array view(type.dtype(), {static_cast<py::ssize_t>(ledger.size())},
                 {static_cast<py::ssize_t>(sizeof(LedgerRow))}, ledger.data(), self);
  view.attr("flags").attr("writeable") = false;
  return view;
}

BodyIndex index_of(const Model& model, const std::string& name) {
  for (BodyIndex i = 0; i < model.size(); ++i) {
    if (model.body(i).name == name) {
      return i;
    }
  }
  throw py::key_error(fmt::format("no body '{}' in the scene", name));
}

/// States of bodies at given times, from their motions: (times, bodies) in one piece.
py::tuple sample(const RunRecord& record, const Doubles& times,
                 const std::vector<std::string>& names) {
  if (!record.kept->wants_motions()) {
    throw py::value_error("the run kept no motions; run with motions=True");
  }
  const Trajectory& trajectory = record.kept->trajectory();
  const State at_rest = record.model->initial_state();  // of bodies that never move
  std::vector<BodyIndex> bodies;
  for (const std::string& name : names) {
    bodies.push_back(index_of(*record.model, name));
  }
  const double end = record.result.end.seconds;
  std::vector<BodyState> states;
  states.reserve(static_cast<std::size_t>(times.size()) * bodies.size());
  for (py::ssize_t k = 0; k < times.size(); ++k) {
    const double t = times.data()[k];
    if (!(t >= 0.0 && t <= end)) {
      throw py::value_error(
          fmt::format("times[{}]: is {} s; allowed: times of the run, 0 to {} s", k, t, end));
    }
    for (const BodyIndex body : bodies) {
      states.push_back(trajectory.motions(body).empty() ? at_rest[body]
                                                        : trajectory.at(body, {t, 0.0}));
    }
  }
  const std::size_t columns = bodies.size();
  const auto copied = [&](py::ssize_t offset) {
    return states_view(states, columns, offset, py::none()).attr("copy")();
  };
  return py::make_tuple(copied(StateLayout::position), orientations_of(states, columns),
                        copied(StateLayout::linear), copied(StateLayout::angular));
}

py::list body_rows(const RunRecord& record) {
  constexpr const char* movers[] = {"fixed", "driven", "free"};
  const Model& model = *record.model;
  py::list rows;
  for (BodyIndex i = 0; i < model.size(); ++i) {
    const Body& body = model.body(i);
    py::dict row;
    row["name"] = body.name;
    row["entity"] = body.entity->kind();
    row["shape"] = shape_name(body.shape);
    row["moves"] = movers[static_cast<std::size_t>(model.mobility(i))];
    row["field"] = model.is_field(i);
    row["bounds"] = to_string(body.bounds);
    row["mass"] = body.mass;
    const bool flat = std::holds_alternative<HalfSpace>(body.shape);
    const Vector3 v =
        flat ? std::get<HalfSpace>(body.shape).normal_B : bounding_box(body.shape).half_extents;
    row[flat ? "normal" : "half_extents"] = py::array_t<double>(3, v.data());
    rows.append(row);
  }
  return rows;
}

}  // namespace

void bind_run(py::module_& module) {
  bind_contact(module);
  module.def("run", &run, py::arg("scene"), py::arg("options"), py::arg("law"), py::arg("listener"),
             py::arg("motions"));
  module.def("why_refused", &refused, py::arg("scene"), py::arg("options"));
  module.def("page_of", &page_of, py::arg("page_template"), py::arg("runs"));
  py::class_<RunRecord>(module, "RunRecord", "A finished run; see kairos.Run.")
      .def_property_readonly("status",
                             [](const RunRecord& r) {
                               return r.result.status == RunStatus::completed ? "completed"
                                                                              : "stopped";
                             })
      .def_property_readonly("reason", [](const RunRecord& r) { return r.result.reason; })
      .def_property_readonly("end", [](const RunRecord& r) { return r.result.end.seconds; })
      .def_property_readonly("bodies", &body_rows)
      .def_property_readonly("times", &times_of)
      .def_property_readonly("position", part(StateLayout::position))
      .def_property_readonly("velocity", part(StateLayout::linear))
      .def_property_readonly("angular_velocity", part(StateLayout::angular))
      .def_property_readonly(
          "orientation",
          [](const RunRecord& r) { return orientations_of(r.kept->states(), r.model->size()); })
      .def_property_readonly("ledger", &ledger_of)
      .def_property_readonly(
          "events",
          [](const RunRecord& r) { return events_array(*r.model, r.kept->trajectory().events()); })
      .def_property_readonly("cost", &cost_of)
      .def_property_readonly("summary", &summary_of)
      .def("sample", &sample, py::arg("times"), py::arg("names"));
}

}  // namespace kairos::python
