#pragma once

#include "core/state.hpp"

#include <pybind11/numpy.h>

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace kairos::python {

/// A body's state is 13 doubles in a row; arrays of states are seen as numpy arrays without a copy.
/// Orientations alone are copied: Eigen keeps w last, kairos writes it first.
static_assert(sizeof(BodyState) == 13 * sizeof(double));

/// Rows of `columns` doubles, C-contiguous; converts what is not yet so.
using Doubles = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// Byte offsets of the parts of a `BodyState`.
struct StateLayout {
  static constexpr pybind11::ssize_t stride = sizeof(BodyState);
  static constexpr pybind11::ssize_t position = 0;
  static constexpr pybind11::ssize_t linear = 7 * sizeof(double);
  static constexpr pybind11::ssize_t angular = 10 * sizeof(double);
};

/// States in rows of `bodies`, as a read-only array (rows, bodies, 3) that refers to them.
[[nodiscard]] pybind11::array states_view(const std::vector<BodyState>& states, std::size_t bodies,
                                          pybind11::ssize_t offset, const pybind11::handle& owner);
/// Orientations (w, x, y, z) of the same, copied: (rows, bodies, 4).
[[nodiscard]] pybind11::array orientations_of(const std::vector<BodyState>& states,
                                              std::size_t bodies);

/// A structured dtype, field by field; offsets follow each other without gaps.
class RecordType {
 public:
  /// `format`: as numpy writes it, "<f8", "(3,)<f8", "<U12".
  RecordType& field(const std::string& name, const std::string& format);
  [[nodiscard]] pybind11::dtype dtype() const;

 private:
  pybind11::list fields_;
};

}  // namespace kairos::python
