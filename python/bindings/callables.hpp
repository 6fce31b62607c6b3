#pragma once

#include "core/drive.hpp"
#include "core/force.hpp"
#include "core/impact_law.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <string>

namespace kairos::python {

// Callables of the user's as plug-ins. Each call takes the interpreter's lock. What a callable
// raises comes through the run as it is; what it returns is checked, and named where it is wrong.

/// What a callable sees of bodies: arrays that are filled anew for each call. Shapes (n, 3) and
/// (n, 4), or (3,) and (4,) of a single body.
class StateArrays {
 public:
  StateArrays(std::size_t bodies, bool single);
  void fill(std::span<const BodyState> bodies);
  /// The object with position, orientation, velocity and angular_velocity.
  [[nodiscard]] const pybind11::object& object() const { return object_; }
  [[nodiscard]] std::size_t bodies() const { return bodies_; }
  [[nodiscard]] bool single() const { return single_; }

 private:
  std::size_t bodies_;
  bool single_;
  double* position_;
  double* orientation_;
  double* velocity_;
  double* angular_velocity_;
  pybind11::object object_;
};

struct ForceChoices {
  std::string name;
  pybind11::object callable;
  pybind11::object potential;  ///< None: it has none
  bool rotation = false;       ///< returns (force, torque) and may depend on how bodies turn
  bool single = false;         ///< arrays of one body have no leading axis
};
[[nodiscard]] std::shared_ptr<const Force> make_python_force(const ForceChoices& choices,
                                                             std::size_t bodies);

/// `callable(t, at_most) -> Motion`.
[[nodiscard]] std::shared_ptr<const Drive> make_python_drive(const std::string& body,
                                                             const pybind11::object& callable);

/// `callable(contact) -> (velocity_a, velocity_b)`, see kairos.run.
[[nodiscard]] std::shared_ptr<const ImpactLaw> make_python_law(const pybind11::object& callable);

/// Of the object that a law sees.
void bind_contact(pybind11::module_& module);

/// Drops a reference from a thread that may not hold the interpreter's lock.
class Callable {
 public:
  explicit Callable(pybind11::object object) : object_(std::move(object)) {}
  Callable(const Callable&) = delete;
  Callable& operator=(const Callable&) = delete;
  ~Callable() {
    const pybind11::gil_scoped_acquire lock;
    object_ = pybind11::object();
  }
  [[nodiscard]] const pybind11::object& get() const { return object_; }

 private:
  pybind11::object object_;
};

}  // namespace kairos::python
