#include <fmt/format.h>

#include "python/bindings/callables.hpp"
#include "python/bindings/errors.hpp"
#include <cmath>

namespace py = pybind11;

namespace kairos::python {
namespace {

/// A drive of the user's: pieces of motion, on demand.
class PythonDrive final : public Drive {
 public:
  PythonDrive(std::string body, const py::object& callable)
      : body_(std::move(body)), callable_(callable) {}

  [[nodiscard]] Motion motion(Instant t, double at_most) const override {
    const py::gil_scoped_acquire lock;
    const py::object answer = callable_.get()(t.seconds, at_most);
    if (!py::isinstance<Motion>(answer)) {
      fail(t, fmt::format("returned {}; needed: a kairos.Motion", std::string(py::repr(answer))));
    }
    auto motion = answer.cast<Motion>();
    // The motion begins at t, whatever part of a longer one was returned.
    const double s0 = t - motion.start;
    if (!(s0 >= -1e-9 * std::max(1.0, std::abs(t.seconds))) || !(motion.duration - s0 > 0.0)) {
      fail(t, fmt::format("returned a motion from {} s that lasts {} s; needed: one that holds t",
                          motion.start.seconds, motion.duration));
    }
    if (s0 > 0.0) {
      motion = motion.shifted(s0);
    }
    motion.start = t;
    motion.duration = std::min(motion.duration, at_most);
    return motion;
  }
  [[nodiscard]] std::string description() const override { return "a drive of the user's"; }

 private:
  [[noreturn]] void fail(Instant t, const std::string& what) const {
    throw CallableError(fmt::format("drive of '{}' at t = {} s: {}", body_, t.seconds, what));
  }

  std::string body_;
  Callable callable_;
};

}  // namespace

std::shared_ptr<const Drive> make_python_drive(const std::string& body,
                                               const py::object& callable) {
  return std::make_shared<const PythonDrive>(body, callable);
}

}  // namespace kairos::python
