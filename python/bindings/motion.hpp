#pragma once

#include "core/motion.hpp"

#include <pybind11/pybind11.h>

namespace kairos::python {

/// A polynomial from coefficients, an array (k, Dim) with the constant first. Throws `ValueError`.
template <int Dim>
[[nodiscard]] Polynomial<Dim> polynomial_of(const pybind11::handle& coefficients, const char* what);

/// A vector of three finite numbers. Throws `ValueError` that names `what`.
[[nodiscard]] Vector3 vector_of(const pybind11::handle& object, const char* what);
/// A unit quaternion (w, x, y, z), within 1e-6, normalised. Throws `ValueError`.
[[nodiscard]] Quaternion quaternion_of(const pybind11::handle& object, const char* what);

}  // namespace kairos::python
