#include "python/bindings/values.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>
#include <variant>

namespace py = pybind11;

namespace kairos::python {
namespace {

Value unplaced(decltype(Value::data) data) {
  static const auto no_file = std::make_shared<const std::string>();
  return {std::move(data), no_file, 0};
}

std::string type_of(const py::handle& object) {
  return py::str(py::type::of(object).attr("__name__"));
}

bool is_path(const py::handle& object) { return py::hasattr(object, "__fspath__"); }

std::string path_text(const py::handle& object) {
  return py::str(py::module_::import("os").attr("fspath")(object));
}

Value array_of(const py::sequence& sequence, const std::string& key) {
  Array array;
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    array.push_back(value_of(py::object(sequence[i]), fmt::format("{}[{}]", key, i)));
  }
  return unplaced(std::move(array));
}

}  // namespace

Value value_of(const py::handle& object, const std::string& key) {
  if (PyBool_Check(object.ptr())) {
    return unplaced(object.cast<bool>());
  }
  if (py::isinstance<py::str>(object)) {
    return unplaced(object.cast<std::string>());
  }
  if (PyFloat_Check(object.ptr())) {
    return unplaced(object.cast<double>());
  }
  if (py::isinstance<py::dict>(object)) {
    return unplaced(table_of(py::reinterpret_borrow<py::dict>(object), key));
  }
  if (is_path(object)) {
    return unplaced(path_text(object));
  }
  if (py::hasattr(object, "tolist")) {  // an array or a scalar of numpy's
    return value_of(py::object(object.attr("tolist")()), key);
  }
  if (py::isinstance<py::list>(object) || py::isinstance<py::tuple>(object)) {
    return array_of(py::reinterpret_borrow<py::sequence>(object), key);
  }
  if (PyIndex_Check(object.ptr())) {
    return unplaced(static_cast<std::int64_t>(object.cast<long long>()));
  }
  throw py::type_error(
      fmt::format("{}: is a {}; allowed: bool, number, str, path, sequence or "
                  "array of these, dict",
                  key, type_of(object)));
}

Table table_of(const py::dict& keys, const std::string& path) {
  Table table;
  for (const auto& [key, value] : keys) {
    if (!value.is_none()) {
      const std::string name = py::str(key);
      table.set(name, value_of(value, path.empty() ? name : path + "." + name));
    }
  }
  return table;
}

py::object to_python(const Value& value) {
  struct Writer {
    py::object operator()(bool x) const { return py::bool_(x); }
    py::object operator()(std::int64_t x) const { return py::int_(x); }
    py::object operator()(double x) const { return py::float_(x); }
    py::object operator()(const std::string& x) const { return py::str(x); }
    py::object operator()(const Array& array) const {
      py::list list;
      for (const Value& element : array) {
        list.append(to_python(element));
      }
      return list;
    }
    py::object operator()(const Table& table) const {
      py::dict dict;
      for (std::size_t i = 0; i < table.keys.size(); ++i) {
        dict[py::str(table.keys[i])] = to_python(table.values[i]);
      }
      return dict;
    }
    py::object operator()(const DateOrTime&) const { return py::none(); }
  };
  return std::visit(Writer{}, value.data);
}

OptionValue option_value_of(const py::handle& object, const std::string& name) {
  if (PyBool_Check(object.ptr())) {
    return object.cast<bool>();
  }
  if (py::isinstance<py::str>(object)) {
    return object.cast<std::string>();
  }
  if (is_path(object)) {
    return path_text(object);
  }
  if (PyNumber_Check(object.ptr()) != 0) {
    const double number = PyFloat_AsDouble(object.ptr());
    if (!PyErr_Occurred()) {
      return number;
    }
    PyErr_Clear();
  }
  throw py::type_error(
      fmt::format("{}: is a {}; allowed: str, path, number, bool", name, type_of(object)));
}

void set_options_of(RunChoice& choice, const py::dict& options) {
  std::vector<OptionSetting> settings;
  for (const auto& [key, value] : options) {
    if (!value.is_none()) {
      const std::string name = py::str(key);
      settings.emplace_back(name, option_value_of(value, name));
    }
  }
  set_options(choice, settings);
}

}  // namespace kairos::python
