#include "python/bindings/errors.hpp"

#include "core/error.hpp"

#include "python/bindings/bindings.hpp"

namespace py = pybind11;

namespace kairos::python {
namespace {

/// Raises a class of kairos/errors.py.
template <typename... Arguments>
void raise(const char* name, const Arguments&... arguments) {
  const py::object type = py::module_::import("kairos.errors").attr(name);
  const py::object error = type(arguments...);
  PyErr_SetObject(type.ptr(), error.ptr());
}

void translate(std::exception_ptr thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const InputError& error) {
    raise("InputError", error.file(), error.line(), error.key(), error.reason());
  } catch (const CallableError& error) {
    raise("CallableError", error.what());
  }
}

}  // namespace

void bind_errors(py::module_& /*module*/) { py::register_exception_translator(translate); }

}  // namespace kairos::python
