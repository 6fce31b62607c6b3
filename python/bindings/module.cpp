#include "simulation/version.hpp"

#include <pybind11/stl.h>

#include "python/bindings/bindings.hpp"

// The compiled part of the package `kairos`: thin, and typed by kairos/_kairos.pyi. What a person
// writes is in the Python files around it.
PYBIND11_MODULE(_kairos, module) {
  module.doc() = "Compiled part of kairos; use the package kairos.";
  module.def(
      "versions", [] { return kairos::versions(); },
      "Name and version of kairos and of what decides the bits of a run.");
  kairos::python::bind_errors(module);
  kairos::python::bind_tables(module);
  kairos::python::bind_motion(module);
  kairos::python::bind_scene(module);
  kairos::python::bind_run(module);
  kairos::python::bind_queries(module);
}
