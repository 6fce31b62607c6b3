#pragma once

#include "core/contact_detector.hpp"

#include <pybind11/pybind11.h>

#include "python/bindings/arrays.hpp"
#include <string>
#include <vector>

namespace kairos::python {

/// A number per row, or one for all rows.
class NumberColumn {
 public:
  explicit NumberColumn(const Doubles& numbers)
      : data_(numbers.data()), stride_(numbers.size() == 1 ? 0 : 1) {}
  [[nodiscard]] double operator[](std::size_t row) const { return data_[row * stride_]; }

 private:
  const double* data_;
  std::size_t stride_;
};

/// Values of the library, one per row, or one for all rows.
template <typename Value>
class ValueColumn {
 public:
  void resize(std::size_t rows) {
    values_.resize(rows);
    stride_ = rows == 1 ? 0 : 1;
  }
  [[nodiscard]] Value& operator[](std::size_t row) { return values_[row * stride_]; }
  [[nodiscard]] const Value& operator[](std::size_t row) const { return values_[row * stride_]; }
  [[nodiscard]] std::size_t size() const { return values_.size(); }

 private:
  std::vector<Value> values_;
  std::size_t stride_ = 1;
};

/// Rows of numbers, (rows, width) in one piece, or one row for all; what they are called in
/// messages.
struct RowsOfNumbers {
  RowsOfNumbers(const Doubles& numbers, const char* called)
      : data(numbers.data()),
        rows(static_cast<std::size_t>(numbers.shape(0))),
        width(static_cast<std::size_t>(numbers.shape(1))),
        name(called) {}
  [[nodiscard]] const double* operator[](std::size_t row) const {
    return data + (rows == 1 ? 0 : row) * width;
  }
  /// The row as a vector of the library. Throws `std::invalid_argument` for what is out of range.
  [[nodiscard]] Vector3 vector(std::size_t row) const;

  const double* data;
  std::size_t rows;
  std::size_t width;
  const char* name;
};

/// A shape that is told by the keys of a scene.
struct GivenShape {
  Shape shape;
};

/// One side of N queries: shapes, and how they move, as the detectors take them. Arrays are
/// converted and checked once, as `kairos toi` checks a file; what is asked of them later is the
/// library's own loop. 160 bytes a row where every column has rows of its own.
class QueryBodies {
 public:
  /// `kinds`: 0 box, 1 sphere, 2 half-space (rows,); `sizes`: half-extents, radius and two unused
  /// numbers, or normal (rows, 3); (rows, 3) and (rows, 4) for the rest. `motions`: instead of
  /// position to angular velocity; empty: none. `shapes`: a `kairos.Shape` for each row, or one for
  /// all, instead of kinds and sizes; empty: none. An array of one row stands for all. Throws
  /// `InputError` that names the first bad row.
  QueryBodies(const pybind11::array_t<std::int8_t>& kinds, const Doubles& sizes,
              const Doubles& position, const Doubles& orientation, const Doubles& velocity,
              const Doubles& acceleration, const Doubles& angular_velocity,
              const pybind11::list& motions, const pybind11::list& shapes);

  [[nodiscard]] const Shape& shape(std::size_t row) const { return shapes_[row]; }
  [[nodiscard]] Pose pose(std::size_t row) const {
    return motions_.empty() ? poses_[row] : given(row).pose(0.0);
  }
  [[nodiscard]] bool has_half_spaces() const { return has_half_spaces_; }
  /// Whether motions were given: they are copied where they are used.
  [[nodiscard]] bool has_motions() const { return !motions_.empty(); }
  /// Whether no motion leads too far within this time, s; otherwise `check_reach` looks at each.
  [[nodiscard]] bool stays_near(double duration) const;
  /// Throws `std::invalid_argument` for a motion that does not last through the window, or leads
  /// further than the library can tell.
  void check_reach(std::size_t row, const Window& window, const char* side) const;
  [[nodiscard]] Motion motion(std::size_t row, const Window& window) const {
    return motions_.empty() ? Motion::ballistic(window.start, window.duration, poses_[row],
                                                twists_[row], accelerations_[row])
                            : given(row);
  }

 private:
  [[nodiscard]] const Motion& given(std::size_t row) const {
    return *motions_[motions_.size() == 1 ? 0 : row];
  }

  ValueColumn<Shape> shapes_;
  ValueColumn<Pose> poses_;
  ValueColumn<Twist> twists_;
  ValueColumn<Vector3> accelerations_;
  double greatest_[4] = {};  ///< magnitudes: positions, velocities, accelerations, angular ones
  bool has_half_spaces_ = false;
  pybind11::list kept_;  ///< keeps motions alive
  std::vector<const Motion*> motions_;
};

/// Seconds from `start` on; of numbers it is their local time. Throws `std::invalid_argument`.
[[nodiscard]] Window window_of(double start, double duration);

/// Throws `std::invalid_argument`: they have neither a distance nor a time of impact.
void refuse_two_half_spaces(const Shape& a, const Shape& b);

void bind_query_bodies(pybind11::module_& module);

}  // namespace kairos::python
