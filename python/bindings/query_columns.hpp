#pragma once

#include "core/contact_detector.hpp"

#include <pybind11/pybind11.h>

#include "python/bindings/arrays.hpp"
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

/// One side of N queries, as columns: shape, and how it moves. An array of one row stands for all.
/// Everything is checked row by row, as `kairos toi` checks a file; throws `std::invalid_argument`.
class QueryColumns {
 public:
  /// `kinds`: 0 box, 1 sphere, 2 half-space (rows,); `sizes`: half-extents, radius and two unused
  /// numbers, or normal (rows, 3); (rows, 3) and (rows, 4) for the rest. `motions`: instead of
  /// position to angular velocity; empty: none.
  QueryColumns(const pybind11::array_t<std::int8_t>& kinds, const Doubles& sizes,
               const Doubles& position, const Doubles& orientation, const Doubles& velocity,
               const Doubles& acceleration, const Doubles& angular_velocity,
               const pybind11::list& motions);

  [[nodiscard]] Shape shape(std::size_t row, const char* side) const;
  [[nodiscard]] Pose pose(std::size_t row, const char* side) const;
  /// The motion of a row, made in `storage` where it is given as numbers.
  [[nodiscard]] const Motion& motion(std::size_t row, const Window& window, const char* side,
                                     Motion& storage) const;

 private:
  /// Rows of several numbers.
  struct Column {
    const double* data = nullptr;
    std::size_t stride = 0;
    const char* name = "";
    Column(const Doubles& numbers, std::size_t width, const char* called);
    [[nodiscard]] Vector3 vector(std::size_t row, const char* side) const;
  };

  std::vector<pybind11::object> kept_;  // arrays and motions that are referred to
  const std::int8_t* kinds_;
  std::size_t kind_stride_;
  Column sizes_, position_, orientation_, velocity_, acceleration_, angular_velocity_;
  std::vector<const Motion*> motions_;
};

/// Seconds from `start` on; of numbers it is their local time. Throws `std::invalid_argument`.
[[nodiscard]] Window window_of(double start, double duration);
void refuse_two_half_spaces(const Shape& a, const Shape& b);

void bind_query_columns(pybind11::module_& module);

}  // namespace kairos::python
