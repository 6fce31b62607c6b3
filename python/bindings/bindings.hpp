#pragma once

#include <pybind11/pybind11.h>

namespace kairos::python {

// One function and one file per part of the module `_kairos`, called by module.cpp in this order.
void bind_errors(pybind11::module_& module);
void bind_tables(pybind11::module_& module);
void bind_motion(pybind11::module_& module);
void bind_scene(pybind11::module_& module);
void bind_run(pybind11::module_& module);
void bind_queries(pybind11::module_& module);

}  // namespace kairos::python
