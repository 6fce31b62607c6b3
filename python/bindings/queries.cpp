#include "core/contact_detector.hpp"
#include "core/error.hpp"
#include "simulation/registry.hpp"

#include <fmt/format.h>

#include "python/bindings/arrays.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/errors.hpp"
#include "python/bindings/query_columns.hpp"
#include "python/bindings/worker_threads.hpp"
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>

namespace py = pybind11;

namespace kairos::python {
namespace {

/// A row of what `toi` returns.
struct ToiRow {
  double t_lo, t_hi, gap;
  std::array<double, 3> normal, witness_a, witness_b;
  std::int32_t status, evaluations;
};
static_assert(sizeof(ToiRow) == 104, "numpy sees no padding");

/// A row of what `distance` returns.
struct DistanceRow {
  double gap;
  std::array<double, 3> normal, point;
};
static_assert(sizeof(DistanceRow) == 56, "numpy sees no padding");

py::dtype toi_dtype() {
  return RecordType()
      .field("t_lo", "<f8")
      .field("t_hi", "<f8")
      .field("gap", "<f8")
      .field("normal", "(3,)<f8")
      .field("witness_a", "(3,)<f8")
      .field("witness_b", "(3,)<f8")
      .field("status", "<i4")
      .field("evaluations", "<i4")
      .dtype();
}

py::dtype distance_dtype() {
  return RecordType()
      .field("gap", "<f8")
      .field("normal", "(3,)<f8")
      .field("point", "(3,)<f8")
      .dtype();
}

void copy(const Vector3& v, std::array<double, 3>& out) { out = {v.x(), v.y(), v.z()}; }

ToiRow row_of(const TimeOfImpact& toi) {
  ToiRow row{};
  row.t_lo = toi.t_lo;
  row.t_hi = toi.t_hi;
  row.gap = toi.gap;
  copy(toi.normal, row.normal);
  copy(toi.witness_a, row.witness_a);
  copy(toi.witness_b, row.witness_b);
  row.status = static_cast<std::int32_t>(toi.status);
  row.evaluations = toi.evaluations;
  return row;
}

/// The first bad row of a batch, whatever the order in which threads come across bad ones.
class FirstFailure {
 public:
  void tell(std::size_t row, const std::string& what) {
    const std::lock_guard lock(mutex_);
    if (row < row_) {
      row_ = row;
      what_ = what;
    }
  }
  void raise() const {
    if (row_ != none) {
      throw InputError("", 0, fmt::format("row {}", row_), what_);
    }
  }

 private:
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::mutex mutex_;
  std::size_t row_ = none;
  std::string what_;
};

/// Answers `answer(row)` for all rows with the interpreter's lock released; bad rows are named.
template <typename Answer>
void for_all_rows(std::size_t count, std::size_t threads, const Answer& answer) {
  FirstFailure failure;
  Interrupts interrupts;
  {
    const py::gil_scoped_release unlocked;
    in_pieces(
        count, threads,
        [&](std::size_t first, std::size_t last) {
          for (std::size_t i = first; i < last; ++i) {
            try {
              answer(i);
            } catch (const std::exception& bad) {
              failure.tell(i, bad.what());
            }
          }
        },
        [&] { interrupts.look(); });
  }
  failure.raise();
}

std::shared_ptr<const ContactDetector> locating(const std::string& name) {
  auto detector = find_detector(name);
  const DetectorInfo info = detector->info();
  if (!info.locates || info.at_step_ends) {
    throw InputError("", 0, "detector",
                     fmt::format("'{}' does not tell when two motions touch; allowed: certified, "
                                 "conservative-advancement, bisection",
                                 name));
  }
  return detector;
}

py::array toi(const QueryColumns& a, const QueryColumns& b, const Doubles& duration,
              const Doubles& start, const std::string& detector_name, double tolerance,
              std::size_t threads, std::size_t count) {
  if (!(tolerance >= 0.0) || !std::isfinite(tolerance)) {
    throw InputError("", 0, "tolerance",
                     fmt::format("is {}; allowed: a finite number > 0 (m), or 0: the detector's "
                                 "default",
                                 tolerance));
  }
  const auto detector = locating(detector_name);
  py::array answers(toi_dtype(), py::array::ShapeContainer{static_cast<py::ssize_t>(count)});
  auto* rows = static_cast<ToiRow*>(answers.mutable_data());
  const NumberColumn durations(duration), starts(start);
  for_all_rows(count, threads, [&](std::size_t i) {
    const Window window = window_of(starts[i], durations[i]);
    const Shape shape_a = a.shape(i, "a"), shape_b = b.shape(i, "b");
    refuse_two_half_spaces(shape_a, shape_b);
    Motion made_a, made_b;  // of bodies that are given as numbers
    const Motion& motion_a = a.motion(i, window, "a", made_a);
    const Motion& motion_b = b.motion(i, window, "b", made_b);
    const TimeOfImpact found =
        detector->time_of_impact({shape_a, motion_a}, {shape_b, motion_b}, window, tolerance);
    if (!std::isfinite(found.t_lo + found.t_hi + found.gap + found.normal.sum())) {
      throw std::range_error("the answer is beyond the range of a double");
    }
    rows[i] = row_of(found);
  });
  return answers;
}

py::array overlap(const QueryColumns& a, const QueryColumns& b, std::size_t threads,
                  std::size_t count) {
  const auto detector = find_detector("certified");
  py::array_t<bool> answers(static_cast<py::ssize_t>(count));
  bool* rows = answers.mutable_data();
  for_all_rows(count, threads, [&](std::size_t i) {
    const Shape shape_a = a.shape(i, "a"), shape_b = b.shape(i, "b");
    refuse_two_half_spaces(shape_a, shape_b);
    rows[i] = detector->overlaps(shape_a, a.pose(i, "a"), shape_b, b.pose(i, "b"));
  });
  return answers;
}

py::array distance(const QueryColumns& a, const QueryColumns& b, std::size_t threads,
                   std::size_t count) {
  const auto detector = find_detector("certified");
  py::array answers(distance_dtype(), py::array::ShapeContainer{static_cast<py::ssize_t>(count)});
  auto* rows = static_cast<DistanceRow*>(answers.mutable_data());
  for_all_rows(count, threads, [&](std::size_t i) {
    const Shape shape_a = a.shape(i, "a"), shape_b = b.shape(i, "b");
    refuse_two_half_spaces(shape_a, shape_b);
    const Overlap found = detector->overlap(shape_a, a.pose(i, "a"), shape_b, b.pose(i, "b"));
    rows[i].gap = found.gap;
    copy(found.normal, rows[i].normal);
    copy(found.point, rows[i].point);
  });
  return answers;
}

}  // namespace

void bind_queries(py::module_& module) {
  bind_query_columns(module);
  module.def("toi", &toi, py::arg("a"), py::arg("b"), py::arg("duration"), py::arg("start"),
             py::arg("detector"), py::arg("tolerance"), py::arg("threads"), py::arg("count"));
  module.def("overlap", &overlap, py::arg("a"), py::arg("b"), py::arg("threads"), py::arg("count"));
  module.def("distance", &distance, py::arg("a"), py::arg("b"), py::arg("threads"),
             py::arg("count"));
}

}  // namespace kairos::python
