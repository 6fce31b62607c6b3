#include "python/bindings/query_columns.hpp"

#include "simulation/query_limits.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace py = pybind11;

namespace kairos::python {
namespace {

void refuse(const char* side, const char* column, const std::string& reason) {
  if (!reason.empty()) {
    throw std::invalid_argument(fmt::format("{}.{}: {}", side, column, reason));
  }
}

double checked(double x, const char* side, const char* column) {
  if (!(std::abs(x) <= largest_magnitude)) {
    refuse(side, column,
           fmt::format("{} is not allowed; allowed: finite numbers of magnitude up to {}", x,
                       largest_magnitude));
  }
  return x;
}

}  // namespace

QueryColumns::Column::Column(const Doubles& numbers, std::size_t width, const char* called)
    : data(numbers.data()), stride(numbers.shape(0) == 1 ? 0 : width), name(called) {}

Vector3 QueryColumns::Column::vector(std::size_t row, const char* side) const {
  const double* x = data + row * stride;
  return {checked(x[0], side, name), checked(x[1], side, name), checked(x[2], side, name)};
}

QueryColumns::QueryColumns(const py::array_t<std::int8_t>& kinds, const Doubles& sizes,
                           const Doubles& position, const Doubles& orientation,
                           const Doubles& velocity, const Doubles& acceleration,
                           const Doubles& angular_velocity, const py::list& motions)
    : kept_{kinds, sizes, position, orientation, velocity, acceleration, angular_velocity, motions},
      kinds_(kinds.data()),
      kind_stride_(kinds.size() == 1 ? 0 : 1),
      sizes_(sizes, 3, "size"),
      position_(position, 3, "position"),
      orientation_(orientation, 4, "orientation"),
      velocity_(velocity, 3, "velocity"),
      acceleration_(acceleration, 3, "acceleration"),
      angular_velocity_(angular_velocity, 3, "angular_velocity") {
  for (const py::handle& motion : motions) {
    motions_.push_back(motion.cast<const Motion*>());
  }
}

Shape QueryColumns::shape(std::size_t row, const char* side) const {
  const int kind = kinds_[row * kind_stride_];
  if (kind == 2) {
    const Vector3 normal = sizes_.vector(row, side);
    const double norm = normal.norm();
    if (!(std::abs(norm - 1.0) <= 1e-6)) {  // physical: what a person's rounding may cost
      refuse(side, "normal", fmt::format("has length {}; allowed: 1 within 1e-06", norm));
    }
    return HalfSpace{norm == 1.0 ? normal : Vector3(normal / norm)};
  }
  const double* x = sizes_.data + row * sizes_.stride;
  const char* name = kind == 1 ? "radius" : "half_extents";
  for (int i = 0; i < (kind == 1 ? 1 : 3); ++i) {
    refuse(side, name, why_no_extent(checked(x[i], side, name)));
  }
  return kind == 1 ? Shape(Sphere{x[0]}) : Shape(Box{{x[0], x[1], x[2]}});
}

Pose QueryColumns::pose(std::size_t row, const char* side) const {
  if (!motions_.empty()) {
    const Motion& motion = *motions_[motions_.size() == 1 ? 0 : row];
    return motion.pose(0.0);
  }
  const double* x = orientation_.data + row * orientation_.stride;
  Quaternion q(checked(x[0], side, "orientation"), checked(x[1], side, "orientation"),
               checked(x[2], side, "orientation"), checked(x[3], side, "orientation"));
  const double norm = q.norm();
  refuse(side, "orientation", why_not_unit(norm));
  q.coeffs() /= norm;
  return {position_.vector(row, side), q};
}

const Motion& QueryColumns::motion(std::size_t row, const Window& window, const char* side,
                                   Motion& storage) const {
  if (!motions_.empty()) {
    const Motion& motion = *motions_[motions_.size() == 1 ? 0 : row];
    const double before = window.start - motion.start;
    const double after = motion.end() - (window.start + window.duration);
    if (before < 0.0 || after < 0.0) {
      refuse(side, "motion",
             fmt::format("lasts from {} s for {} s; needed: all of the window, {} s from {} s on",
                         motion.start.seconds, motion.duration, window.duration,
                         window.start.seconds));
    }
    return motion;
  }
  const Pose at = pose(row, side);
  const Twist twist{velocity_.vector(row, side), angular_velocity_.vector(row, side)};
  const Vector3 acceleration = acceleration_.vector(row, side);
  refuse(side, "velocity", why_too_far(at, twist, acceleration, window.duration));
  storage = Motion::ballistic(window.start, window.duration, at, twist, acceleration);
  return storage;
}

Window window_of(double start, double duration) {
  if (!std::isfinite(start)) {
    throw std::invalid_argument(fmt::format("start: {}; allowed: finite numbers (s)", start));
  }
  if (const std::string reason = why_no_window(duration); !reason.empty()) {
    throw std::invalid_argument("duration: " + reason);
  }
  if (!(duration <= longest_duration_asked)) {
    throw std::invalid_argument(fmt::format("duration: {}; allowed: finite numbers up to {} (s)",
                                            duration, longest_duration_asked));
  }
  return {{start, 0.0}, duration};
}

void refuse_two_half_spaces(const Shape& a, const Shape& b) {
  if (std::holds_alternative<HalfSpace>(a) && std::holds_alternative<HalfSpace>(b)) {
    throw std::invalid_argument("two half-spaces have no time of impact; allowed: at most one");
  }
}

void bind_query_columns(py::module_& module) {
  py::class_<QueryColumns>(module, "QueryColumns", "One side of N queries; see kairos.Bodies.")
      .def(py::init<const py::array_t<std::int8_t>&, const Doubles&, const Doubles&, const Doubles&,
                    const Doubles&, const Doubles&, const Doubles&, const py::list&>());
}

}  // namespace kairos::python
