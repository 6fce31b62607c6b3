#pragma once

#include "core/reading/document.hpp"
#include "simulation/option.hpp"

#include <pybind11/pybind11.h>

#include <string>

namespace kairos::python {

/// A value of a scene from Python: bool, int, float, str, path, sequence or array, dict. Throws
/// `TypeError` with the path of the key otherwise.
[[nodiscard]] Value value_of(const pybind11::handle& object, const std::string& key);
/// A table from keywords. Keys with the value None are left out.
[[nodiscard]] Table table_of(const pybind11::dict& keys, const std::string& path);
/// The same value back: for reading a scene in Python.
[[nodiscard]] pybind11::object to_python(const Value& value);

/// A value of an option of a run: str, path, number, bool.
[[nodiscard]] OptionValue option_value_of(const pybind11::handle& object, const std::string& name);
/// Sets what keywords say; None leaves an option as it is.
void set_options_of(RunChoice& choice, const pybind11::dict& options);

}  // namespace kairos::python
