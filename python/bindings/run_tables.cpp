#include "simulation/option.hpp"
#include "simulation/registry.hpp"
#include "simulation/version.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "python/bindings/arrays.hpp"
#include "python/bindings/run_record.hpp"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <string_view>

namespace py = pybind11;

namespace kairos::python {
namespace {

constexpr std::size_t kind_length = 24;  // of the name of a kind of event
constexpr std::size_t grade_length = 8;
constexpr std::size_t flag_length = 12;

std::size_t longest_name(const Model& model) {
  std::size_t longest = 1;
  for (BodyIndex i = 0; i < model.size(); ++i) {
    longest = std::max(longest, model.body(i).name.size());
  }
  return longest;
}

py::dtype event_dtype(std::size_t name_length) {
  RecordType type;
  type.field("t", "<f8").field("t_correction", "<f8");
  type.field("kind", fmt::format("<U{}", kind_length));
  type.field("a", fmt::format("<U{}", name_length)).field("b", fmt::format("<U{}", name_length));
  type.field("a_index", "<i8").field("b_index", "<i8");
  type.field("gap", "<f8").field("point", "(3,)<f8").field("normal", "(3,)<f8");
  for (const char* body : {"a", "b"}) {
    for (const char* when : {"before", "after"}) {
      const std::string prefix = fmt::format("{}_{}_", body, when);
      type.field(prefix + "position", "(3,)<f8").field(prefix + "velocity", "(3,)<f8");
      type.field(prefix + "angular_velocity", "(3,)<f8");
    }
  }
  type.field("grade", fmt::format("<U{}", grade_length)).field("bracket", "<f8");
  type.field("flag", fmt::format("<U{}", flag_length));
  return type.dtype();
}

/// Writes the fields of a row one after the other.
class RowWriter {
 public:
  explicit RowWriter(char* at) : at_(at) {}
  template <typename Number>
  void number(Number x) {
    std::memcpy(at_, &x, sizeof x);
    at_ += sizeof x;
  }
  void vector(const Vector3& v) {
    std::memcpy(at_, v.data(), 3 * sizeof(double));
    at_ += 3 * sizeof(double);
  }
  /// Names are ASCII: letters, digits, `_`, `-`; what is not becomes a question mark.
  void text(std::string_view text, std::size_t length) {
    for (std::size_t i = 0; i < length; ++i) {
      const auto c = i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
      number(static_cast<std::uint32_t>(c < 0x80U ? c : '?'));
    }
  }
  void state(const BodyState& s) {
    vector(s.pose.position);
    vector(s.twist.linear);
    vector(s.twist.angular);
  }

 private:
  char* at_;
};

/// What `auto` came to: the integrators in use, each once.
std::string integrators_in_use(const RunRecord& run) {
  const IslandStepperFactory make =
      find_integrator(run.choice.method.integrator, run.choice.stepper);
  std::set<std::string> names;
  for (std::size_t i = 0; i < run.model->islands().size(); ++i) {
    names.emplace(make(*run.model, i)->info().name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

py::object option_value(const Option& option, const RunChoice& choice) {
  const std::string text = option.get(choice);
  switch (option.kind) {
    case OptionKind::flag:
      return py::bool_(text == "true");
    case OptionKind::number:
    case OptionKind::count:
    case OptionKind::duration:
      return text.empty() ? py::object(py::none()) : py::object(py::float_(py::str(text)));
    case OptionKind::name:
    case OptionKind::frames:
      return py::str(text);
  }
  return py::none();
}

py::dict method_of(const RunRecord& run) {
  RunChoice choice = run.choice;
  choice.frames = choice.frames.value_or(run.model->scene().frames);
  choice.duration = choice.duration.value_or(run.model->scene().duration);
  py::dict method;
  for (const Option& option : options()) {
    method[py::str(std::string(option.name))] = option_value(option, choice);
  }
  method["integrators_in_use"] = integrators_in_use(run);
  method["broad_phase"] = run.model->broad_phase();
  method["mean_frame"] = mean_frame_duration(*choice.frames);
  return method;
}

py::dict metrics_of(const RunRecord& run) {
  const RunMetrics& metrics = run.kept->metrics();
  const double final_error = energy_error(run.result.ledger);
  const double largest = std::max(metrics.max_energy_error, std::abs(final_error));
  py::dict dict;
  const RunMetrics::Deepest& deepest = metrics.deepest();
  dict["max_depth"] = deepest.depth;
  if (deepest.pair) {
    dict["time_of_max_depth"] = deepest.time;
    dict["deepest_a"] = run.model->body(deepest.pair->first).name;
    dict["deepest_b"] = run.model->body(deepest.pair->second).name;
  }
  dict["time_overlapping"] = metrics.time_overlapping;
  dict["frames_overlapping"] = metrics.frames_overlapping;
  dict["energy_error"] = final_error;
  dict["energy_error_relative"] = metrics.relative(final_error);
  dict["max_energy_error"] = largest;
  dict["max_energy_error_relative"] = metrics.relative(largest);
  dict["energy_scale"] = metrics.energy_scale;
  return dict;
}

}  // namespace

py::array events_array(const Model& model, const std::vector<Event>& events) {
  const std::size_t names = longest_name(model);
  py::array array(event_dtype(names),
                  py::array::ShapeContainer{static_cast<py::ssize_t>(events.size())});
  const auto stride = static_cast<std::size_t>(array.itemsize());
  auto* row = static_cast<char*>(array.mutable_data());
  for (const Event& event : events) {
    RowWriter writer(row);
    writer.number(event.time.seconds);
    writer.number(event.time.correction);
    writer.text(to_string(event.kind), kind_length);
    writer.text(model.body(event.a).name, names);
    writer.text(model.body(event.b).name, names);
    writer.number(static_cast<std::int64_t>(event.a));
    writer.number(static_cast<std::int64_t>(event.b));
    writer.number(event.contact.gap);
    writer.vector(event.contact.point);
    writer.vector(event.contact.normal);
    for (const BodyState* state :
         {&event.before_a, &event.after_a, &event.before_b, &event.after_b}) {
      writer.state(*state);
    }
    writer.text(changes_contact(event.kind) ? to_string(event.grade) : "", grade_length);
    writer.number(event.bracket);
    writer.text(to_string(event.flag), flag_length);
    row += stride;
  }
  return array;
}

py::dict cost_of(const RunRecord& run) {
  const Cost& cost = run.result.cost;
  py::dict dict;
  dict["frames"] = cost.frames;
  dict["steps"] = cost.steps;
  dict["right_hand_sides"] = cost.right_hand_sides;
  dict["overlap_tests"] = cost.overlap_tests;
  dict["toi_queries"] = cost.toi_queries;
  dict["toi_evaluations"] = cost.toi_evaluations;
  dict["impacts"] = cost.impacts;
  dict["events"] = cost.events;
  return dict;
}

py::dict summary_of(const RunRecord& run) {
  const Scene& scene = run.model->scene();
  py::dict dict;
  dict["scene"] = scene.name;
  dict["file"] = scene.path;
  dict["gravity"] = scene.gravity == GravityMode::force ? "force" : "acceleration";
  py::dict bounds;
  for (const Body& body : scene.bodies) {
    bounds[py::str(body.name)] = to_string(body.bounds);
  }
  dict["bounds"] = bounds;
  dict["method"] = method_of(run);
  dict["versions"] = py::dict(py::cast(versions()));
  dict["status"] = run.result.status == RunStatus::completed ? "completed" : "stopped";
  dict["reason"] = run.result.reason;
  dict["end"] = run.result.end.seconds;
  dict["metrics"] = metrics_of(run);
  dict["cost"] = cost_of(run);
  return dict;
}

}  // namespace kairos::python
