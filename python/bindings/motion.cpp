#include "python/bindings/motion.hpp"

#include <fmt/format.h>
#include <pybind11/numpy.h>

#include "python/bindings/arrays.hpp"
#include "python/bindings/bindings.hpp"
#include <cmath>
#include <limits>

namespace py = pybind11;

namespace kairos::python {
namespace {

Doubles finite_numbers(const py::handle& object, const char* what) {
  const Doubles numbers = Doubles::ensure(object);
  if (!numbers) {
    PyErr_Clear();
    throw py::value_error(fmt::format("{}: is no array of numbers", what));
  }
  for (py::ssize_t i = 0; i < numbers.size(); ++i) {
    if (!std::isfinite(numbers.data()[i])) {
      throw py::value_error(
          fmt::format("{}: holds {}; allowed: finite numbers", what, numbers.data()[i]));
    }
  }
  return numbers;
}

std::string shape_of(const py::array& array) { return py::str(array.attr("shape")); }

template <int Dim>
py::array coefficients_of(const Polynomial<Dim>& p) {
  py::array_t<double> out({static_cast<py::ssize_t>(p.degree()) + 1, py::ssize_t{Dim}});
  for (int k = 0; k <= p.degree(); ++k) {
    for (int i = 0; i < Dim; ++i) {
      out.mutable_at(k, i) = p[k][i];
    }
  }
  return out;
}

py::array array_of(const Vector3& v) { return py::array_t<double>(3, v.data()); }

py::array array_of(const Quaternion& q) {
  const double wxyz[] = {q.w(), q.x(), q.y(), q.z()};
  return py::array_t<double>(4, wxyz);
}

double checked_duration(double duration) {
  if (!(duration > 0.0)) {
    throw py::value_error(fmt::format("duration: is {}; allowed: a number > 0 (s)", duration));
  }
  return duration;
}

Motion make_motion(const py::object& position, double duration, const py::object& quaternion,
                   double start, double error_radius, const py::object& velocity,
                   const py::object& angular_velocity) {
  Motion motion;
  motion.start = {start, 0.0};
  motion.duration = checked_duration(duration);
  motion.position = polynomial_of<3>(position, "position");
  motion.velocity = velocity.is_none() ? motion.position.differentiated()
                                       : polynomial_of<3>(velocity, "velocity");
  motion.quaternion = polynomial_of<4>(quaternion, "quaternion");
  motion.rotation = motion.quaternion.degree() > 0 ? RotationKind::polynomial : RotationKind::fixed;
  if (!angular_velocity.is_none()) {
    motion.angular_velocity = polynomial_of<3>(angular_velocity, "angular_velocity");
  }
  if (!(error_radius >= 0.0) || !std::isfinite(error_radius)) {
    throw py::value_error("error_radius: allowed: a finite number >= 0 (m)");
  }
  motion.error_radius = error_radius;
  return motion;
}

Motion ballistic(const py::object& position, const py::object& velocity,
                 const py::object& acceleration, const py::object& orientation,
                 const py::object& angular_velocity, double duration, double start) {
  return Motion::ballistic(
      {start, 0.0}, checked_duration(duration),
      {vector_of(position, "position"), quaternion_of(orientation, "orientation")},
      {vector_of(velocity, "velocity"), vector_of(angular_velocity, "angular_velocity")},
      vector_of(acceleration, "acceleration"));
}

}  // namespace

template <int Dim>
Polynomial<Dim> polynomial_of(const py::handle& coefficients, const char* what) {
  const Doubles numbers = finite_numbers(coefficients, what);
  const bool constant = numbers.ndim() == 1 && numbers.shape(0) == Dim;
  const bool table = numbers.ndim() == 2 && numbers.shape(1) == Dim && numbers.shape(0) >= 1 &&
                     numbers.shape(0) <= Polynomial<Dim>::max_degree + 1;
  if (!constant && !table) {
    throw py::value_error(
        fmt::format("{}: has the shape {}; allowed: ({},), or (k, {}) with k up "
                    "to {}, the constant first",
                    what, shape_of(numbers), Dim, Dim, Polynomial<Dim>::max_degree + 1));
  }
  Polynomial<Dim> p;
  p.resize(constant ? 0 : static_cast<int>(numbers.shape(0)) - 1);
  const double* next = numbers.data();
  for (int k = 0; k <= p.degree(); ++k) {
    for (int i = 0; i < Dim; ++i) {
      p[k][i] = *next++;
    }
  }
  return p;
}

template Polynomial<3> polynomial_of<3>(const py::handle&, const char*);
template Polynomial<4> polynomial_of<4>(const py::handle&, const char*);

Vector3 vector_of(const py::handle& object, const char* what) {
  const Doubles numbers = finite_numbers(object, what);
  if (numbers.ndim() != 1 || numbers.size() != 3) {
    throw py::value_error(
        fmt::format("{}: has the shape {}; allowed: (3,)", what, shape_of(numbers)));
  }
  return {numbers.data()[0], numbers.data()[1], numbers.data()[2]};
}

Quaternion quaternion_of(const py::handle& object, const char* what) {
  const Doubles numbers = finite_numbers(object, what);
  if (numbers.ndim() != 1 || numbers.size() != 4) {
    throw py::value_error(
        fmt::format("{}: has the shape {}; allowed: (4,), w first", what, shape_of(numbers)));
  }
  Quaternion q(numbers.data()[0], numbers.data()[1], numbers.data()[2], numbers.data()[3]);
  const double norm = q.norm();
  constexpr double unit_tolerance = 1e-6;  // physical: what a person's rounding may cost
  if (!(std::abs(norm - 1.0) <= unit_tolerance)) {
    throw py::value_error(
        fmt::format("{}: has length {}; allowed: 1 within {}", what, norm, unit_tolerance));
  }
  q.coeffs() /= norm;
  return q;
}

void bind_motion(py::module_& module) {
  const double forever = std::numeric_limits<double>::infinity();
  const py::tuple zero = py::make_tuple(0.0, 0.0, 0.0);
  const py::tuple unturned = py::make_tuple(1.0, 0.0, 0.0, 0.0);
  py::class_<Motion>(module, "Motion",
                     "One body on an interval of time, as polynomials in local time.")
      .def(py::init(&make_motion), py::arg("position"), py::arg("duration"), py::kw_only(),
           py::arg("quaternion") = unturned, py::arg("start") = 0.0, py::arg("error_radius") = 0.0,
           py::arg("velocity") = py::none(), py::arg("angular_velocity") = py::none(),
           "position: (3,) or coefficients (k, 3), constant first, m. duration: s.\n"
           "quaternion: (4,) or coefficients (k, 4), body to world, w first.\n"
           "error_radius: bound of the distance of the true motion from this one, m.")
      .def_static("ballistic", &ballistic, py::arg("position"), py::arg("velocity") = zero,
                  py::arg("acceleration") = zero, py::kw_only(), py::arg("orientation") = unturned,
                  py::arg("angular_velocity") = zero, py::arg("duration") = forever,
                  py::arg("start") = 0.0,
                  "p + v s + a s^2/2 (m), turning at a constant rate (rad/s, world frame).")
      .def_property_readonly("start", [](const Motion& m) { return m.start.seconds; })
      .def_readonly("duration", &Motion::duration)
      .def_readonly("error_radius", &Motion::error_radius)
      .def_property_readonly("coefficients",
                             [](const Motion& m) { return coefficients_of(m.position); })
      .def(
          "position", [](const Motion& m, double s) { return array_of(m.pose(s).position); },
          py::arg("s"), "Position (3,) at local time s, m.")
      .def(
          "orientation", [](const Motion& m, double s) { return array_of(m.orientation(s)); },
          py::arg("s"), "Unit quaternion (4,) at local time s, w first.")
      .def(
          "velocity", [](const Motion& m, double s) { return array_of(m.twist(s).linear); },
          py::arg("s"), "Velocity (3,) at local time s, m/s.");
}

}  // namespace kairos::python
