#include "python/bindings/query_bodies.hpp"

#include "core/reading/shape_reader.hpp"
#include "simulation/query_limits.hpp"

#include <fmt/format.h>

#include "python/bindings/row_loop.hpp"
#include "python/bindings/values.hpp"
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

namespace py = pybind11;

namespace kairos::python {
namespace {

void refuse(const char* column, const std::string& reason) {
  if (!reason.empty()) {
    throw std::invalid_argument(fmt::format("{}: {}", column, reason));
  }
}

double checked(double x, const char* column) {
  if (!(std::abs(x) <= largest_magnitude)) {
    refuse(column, fmt::format("{} is not allowed; allowed: finite numbers of magnitude up to {}",
                               x, largest_magnitude));
  }
  return x;
}

Shape shape_of(int kind, const RowsOfNumbers& sizes, std::size_t row) {
  if (kind == 2) {
    const Vector3 normal = sizes.vector(row);
    const double norm = normal.norm();
    if (!(std::abs(norm - 1.0) <= 1e-6)) {  // physical: what a person's rounding may cost
      refuse("normal", fmt::format("has length {}; allowed: 1 within 1e-06", norm));
    }
    return HalfSpace{norm == 1.0 ? normal : Vector3(normal / norm)};
  }
  const double* x = sizes[row];
  const char* name = kind == 1 ? "radius" : "half_extents";
  for (int i = 0; i < (kind == 1 ? 1 : 3); ++i) {
    refuse(name, why_no_extent(checked(x[i], name)));
  }
  return kind == 1 ? Shape(Sphere{x[0]}) : Shape(Box{{x[0], x[1], x[2]}});
}

Pose pose_of(const RowsOfNumbers& position, const RowsOfNumbers& orientation, std::size_t row) {
  const double* x = orientation[row];
  Quaternion q(checked(x[0], "orientation"), checked(x[1], "orientation"),
               checked(x[2], "orientation"), checked(x[3], "orientation"));
  const double norm = q.norm();
  refuse("orientation", why_not_unit(norm));
  q.coeffs() /= norm;
  return {position.vector(row), q};
}

/// The greatest magnitude of numbers that are finite.
double greatest(const RowsOfNumbers& rows) {
  const std::size_t count = rows.rows * rows.width;
  if (count == 0) {
    return 0.0;
  }
  return Eigen::Map<const Eigen::ArrayXd>(rows.data, static_cast<Eigen::Index>(count))
      .abs()
      .maxCoeff();
}

/// Rows of two arrays that go together: one row stands for all.
std::size_t rows_of(std::size_t a, std::size_t b) { return a == 1 ? b : a; }

GivenShape given_shape(const py::kwargs& keys) {
  static const auto no_file = std::make_shared<const std::string>();
  const Value value{table_of(keys, "shape"), no_file, 0};
  const TableReader table(Item(value, "shape"));
  table.refuse_unknown(shape_keys());
  return {read_shape(table, "", false)};
}

/// Makes a value of each row, on all cores; one value, where every array of it has one row.
template <typename Value, typename Make>
void fill(ValueColumn<Value>& values, std::size_t rows, const Make& make) {
  values.resize(rows);
  for_all_rows(rows, 0, [&](std::size_t i) { values[i] = make(i); });
}

}  // namespace

Vector3 RowsOfNumbers::vector(std::size_t row) const {
  const double* x = (*this)[row];
  return {checked(x[0], name), checked(x[1], name), checked(x[2], name)};
}

QueryBodies::QueryBodies(const py::array_t<std::int8_t>& kinds, const Doubles& sizes,
                         const Doubles& position, const Doubles& orientation,
                         const Doubles& velocity, const Doubles& acceleration,
                         const Doubles& angular_velocity, const py::list& motions,
                         const py::list& shapes)
    : kept_(motions) {
  const RowsOfNumbers size(sizes, "size"), p(position, "position"), q(orientation, "orientation"),
      v(velocity, "velocity"), a(acceleration, "acceleration"),
      w(angular_velocity, "angular_velocity");
  const auto kind_rows = static_cast<std::size_t>(kinds.size());
  const std::int8_t* kind = kinds.data();
  if (shapes.empty()) {
    fill(shapes_, rows_of(size.rows, kind_rows),
         [&](std::size_t i) { return shape_of(kind[kind_rows == 1 ? 0 : i], size, i); });
  } else {
    shapes_.resize(shapes.size());
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      shapes_[i] = shapes[i].cast<const GivenShape&>().shape;
    }
  }
  fill(poses_, rows_of(p.rows, q.rows), [&](std::size_t i) { return pose_of(p, q, i); });
  fill(twists_, rows_of(v.rows, w.rows), [&](std::size_t i) {
    return Twist{v.vector(i), w.vector(i)};
  });
  fill(accelerations_, a.rows, [&](std::size_t i) { return a.vector(i); });
  const RowsOfNumbers* all[] = {&p, &v, &a, &w};
  std::transform(std::begin(all), std::end(all), greatest_,
                 [](const RowsOfNumbers* rows) { return greatest(*rows); });
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    has_half_spaces_ = has_half_spaces_ || std::holds_alternative<HalfSpace>(shapes_[i]);
  }
  for (const py::handle& motion : motions) {
    motions_.push_back(motion.cast<const Motion*>());
  }
}

bool QueryBodies::stays_near(double duration) const {
  const auto [p, v, a, w] = greatest_;
  // A vector is at most sqrt(3) times as long as its greatest number; the rest is for rounding.
  const double reach = 2.0 * (p + (v + w) * duration + a * duration * duration);
  return motions_.empty() && reach <= largest_magnitude;
}

void QueryBodies::check_reach(std::size_t row, const Window& window, const char* side) const {
  if (motions_.empty()) {
    if (const std::string reason =
            why_too_far(poses_[row], twists_[row], accelerations_[row], window.duration);
        !reason.empty()) {
      throw std::invalid_argument(fmt::format("{}.velocity: {}", side, reason));
    }
    return;
  }
  const Motion& motion = given(row);
  const double before = window.start - motion.start;
  const double after = motion.end() - (window.start + window.duration);
  if (before < 0.0 || after < 0.0) {
    throw std::invalid_argument(fmt::format(
        "{}.motion: lasts from {} s for {} s; needed: all of the window, {} s from {} "
        "s on",
        side, motion.start.seconds, motion.duration, window.duration, window.start.seconds));
  }
}

Window window_of(double start, double duration) {
  if (!std::isfinite(start)) {
    throw std::invalid_argument(fmt::format("start: {}; allowed: finite numbers (s)", start));
  }
  if (!(duration >= 0.0)) {
    throw std::invalid_argument("duration: " + why_no_window(duration));
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

void bind_query_bodies(py::module_& module) {
  py::class_<QueryBodies>(module, "QueryBodies", "One side of N queries; see kairos.Bodies.")
      .def(py::init<const py::array_t<std::int8_t>&, const Doubles&, const Doubles&, const Doubles&,
                    const Doubles&, const Doubles&, const Doubles&, const py::list&,
                    const py::list&>());
  py::class_<GivenShape>(module, "Shape", R"(A shape told by the keys of a body in a scene file.

shape: "sphere", "box", "capsule", "cylinder", "cone", "hull", "mesh", "compound", "height-field" or
"half-space"; then the keys of its size: radius (m), length, height, half_extents, points, file, unit,
rounding, solid, part (a list of dicts), heights, spacing. Files are relative to the working folder. A
hull is about its centroid; a mesh and a compound stay about the origin that they are told about. Shares
its memory with all that are made of it. Raises InputError with the key that is wrong.)")
      .def(py::init(&given_shape))
      .def("__repr__", [](const GivenShape& given) {
        return fmt::format("<kairos.Shape {}>", shape_name(given.shape));
      });
}

}  // namespace kairos::python
