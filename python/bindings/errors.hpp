#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <stdexcept>
#include <string>

namespace kairos::python {

/// A callable of the user's gave what cannot be used: `kairos.CallableError`. Of what it raised
/// itself, the exception comes through as it is.
class CallableError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Asks every tenth of a second whether a person has pressed Ctrl-C, while the interpreter's lock
/// is released. Throws `error_already_set` (KeyboardInterrupt). For the thread that Python called.
class Interrupts {
 public:
  void look() {
    const auto now = std::chrono::steady_clock::now();
    if (now < next_) {
      return;
    }
    next_ = now + std::chrono::milliseconds(100);
    const pybind11::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) {
      throw pybind11::error_already_set();
    }
  }

 private:
  std::chrono::steady_clock::time_point next_{};
};

}  // namespace kairos::python
