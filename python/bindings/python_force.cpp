#include <fmt/format.h>

#include "python/bindings/arrays.hpp"
#include "python/bindings/callables.hpp"
#include "python/bindings/errors.hpp"
#include <cmath>
#include <cstring>

namespace py = pybind11;

namespace kairos::python {
namespace {

py::array_t<double> array_for(std::size_t bodies, bool single, py::ssize_t width) {
  return single ? py::array_t<double>(width)
                : py::array_t<double>({static_cast<py::ssize_t>(bodies), width});
}

/// A force of the user's. One instance belongs to one scene that runs in one thread at a time.
class PythonForce final : public Force {
 public:
  PythonForce(const ForceChoices& choices, std::size_t bodies)
      : name_(choices.name),
        callable_(choices.callable),
        potential_(choices.potential),
        has_potential_(!choices.potential.is_none()),
        rotation_(choices.rotation),
        states_(bodies, choices.single) {}
  ~PythonForce() override = default;

  void add(Instant t, std::span<const BodyState> bodies,
           std::span<Wrench> wrenches) const override {
    const py::gil_scoped_acquire lock;
    states_.fill(bodies);
    const py::object answer = callable_.get()(t.seconds, states_.object());
    if (!rotation_) {
      add_vectors(answer, t, wrenches, &Wrench::force, "force");
      return;
    }
    if (!py::isinstance<py::tuple>(answer) || py::len(answer) != 2) {
      fail(t, fmt::format("returned {}; needed with rotation=True: (force, torque)",
                          std::string(py::str(py::type::of(answer)))));
    }
    const auto pair = py::reinterpret_borrow<py::tuple>(answer);
    add_vectors(pair[0], t, wrenches, &Wrench::force, "force");
    add_vectors(pair[1], t, wrenches, &Wrench::torque, "torque");
  }

  [[nodiscard]] double potential(Instant t, std::span<const BodyState> bodies) const override {
    if (!has_potential_) {
      return 0.0;
    }
    const py::gil_scoped_acquire lock;
    states_.fill(bodies);
    const py::object answer = potential_.get()(t.seconds, states_.object());
    const double joules = PyFloat_AsDouble(answer.ptr());
    if (joules == -1.0 && PyErr_Occurred()) {
      PyErr_Clear();
      fail(t, fmt::format("its potential returned {}; needed: a number (J)",
                          std::string(py::repr(answer))));
    }
    if (!std::isfinite(joules)) {
      fail(t, fmt::format("its potential returned {}; needed: a finite number (J)", joules));
    }
    return joules;
  }

  [[nodiscard]] bool conservative() const override { return has_potential_; }
  [[nodiscard]] bool involves_rotation() const override { return rotation_; }
  [[nodiscard]] std::string description() const override { return name_; }

 private:
  [[noreturn]] void fail(Instant t, const std::string& what) const {
    throw CallableError(fmt::format("force '{}' at t = {} s: {}", name_, t.seconds, what));
  }

  void add_vectors(const py::handle& answer, Instant t, std::span<Wrench> wrenches,
                   Vector3 Wrench::*part, const char* what) const {
    const Doubles numbers = Doubles::ensure(answer);
    if (!numbers) {
      PyErr_Clear();
      fail(t, fmt::format("returned {} as {}; needed: an array of numbers",
                          std::string(py::repr(answer)), what));
    }
    const auto n = static_cast<py::ssize_t>(states_.bodies());
    const bool fits = states_.single()
                          ? numbers.ndim() == 1 && numbers.shape(0) == 3
                          : numbers.ndim() == 2 && numbers.shape(0) == n && numbers.shape(1) == 3;
    if (!fits) {
      fail(t, fmt::format("returned a {} of the shape {}; needed: {}", what,
                          std::string(py::str(numbers.attr("shape"))),
                          states_.single() ? "(3,)" : fmt::format("({}, 3)", n)));
    }
    const double* x = numbers.data();
    for (Wrench& wrench : wrenches) {
      const Vector3 v(x[0], x[1], x[2]);
      if (!v.allFinite()) {
        fail(t, fmt::format("returned a {} of ({}, {}, {}); needed: finite numbers", what, x[0],
                            x[1], x[2]));
      }
      wrench.*part += v;
      x += 3;
    }
  }

  std::string name_;
  Callable callable_;
  Callable potential_;
  bool has_potential_;
  bool rotation_;
  mutable StateArrays states_;  // what the callable sees, filled under the interpreter's lock
};

}  // namespace

StateArrays::StateArrays(std::size_t bodies, bool single) : bodies_(bodies), single_(single) {
  py::array_t<double> position = array_for(bodies, single, 3);
  py::array_t<double> orientation = array_for(bodies, single, 4);
  py::array_t<double> velocity = array_for(bodies, single, 3);
  py::array_t<double> angular_velocity = array_for(bodies, single, 3);
  position_ = position.mutable_data();
  orientation_ = orientation.mutable_data();
  velocity_ = velocity.mutable_data();
  angular_velocity_ = angular_velocity.mutable_data();
  for (const py::array_t<double>& array : {position, orientation, velocity, angular_velocity}) {
    array.attr("flags").attr("writeable") = false;
  }
  object_ = py::module_::import("kairos.states")
                .attr("States")(position, orientation, velocity, angular_velocity);
}

void StateArrays::fill(std::span<const BodyState> bodies) {
  double* q = orientation_;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const BodyState& body = bodies[i];
    std::memcpy(position_ + 3 * i, body.pose.position.data(), 3 * sizeof(double));
    std::memcpy(velocity_ + 3 * i, body.twist.linear.data(), 3 * sizeof(double));
    std::memcpy(angular_velocity_ + 3 * i, body.twist.angular.data(), 3 * sizeof(double));
    *q++ = body.pose.orientation.w();
    *q++ = body.pose.orientation.x();
    *q++ = body.pose.orientation.y();
    *q++ = body.pose.orientation.z();
  }
}

std::shared_ptr<const Force> make_python_force(const ForceChoices& choices, std::size_t bodies) {
  return std::make_shared<const PythonForce>(choices, bodies);
}

}  // namespace kairos::python
