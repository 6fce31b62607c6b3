#include "core/contact_detector.hpp"
#include "core/error.hpp"
#include "simulation/registry.hpp"

#include <fmt/format.h>

#include "python/bindings/arrays.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/query_bodies.hpp"
#include "python/bindings/row_loop.hpp"
#include <algorithm>
#include <cmath>
#include <cstdint>

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

/// The answer as a row; throws where it is no number.
ToiRow checked_row(const TimeOfImpact& found) {
  if (!std::isfinite(found.t_lo + found.t_hi + found.gap + found.normal.sum())) {
    throw std::range_error("the answer is beyond the range of a double");
  }
  return row_of(found);
}

/// Refuses two half-spaces row by row, where both sides have some.
class HalfSpaceGuard {
 public:
  HalfSpaceGuard(const QueryBodies& a, const QueryBodies& b)
      : a_(a), b_(b), needed_(a.has_half_spaces() && b.has_half_spaces()) {}
  void check(std::size_t row) const {
    if (needed_) {
      refuse_two_half_spaces(a_.shape(row), b_.shape(row));
    }
  }

 private:
  const QueryBodies &a_, &b_;
  bool needed_;
};

py::array toi(const QueryBodies& a, const QueryBodies& b, const Doubles& duration,
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
  const HalfSpaceGuard half_spaces(a, b);
  const double longest =
      duration.size() == 0 ? 0.0
                           : *std::max_element(duration.data(), duration.data() + duration.size());
  const bool a_is_near = a.stays_near(longest), b_is_near = b.stays_near(longest);
  for_all_rows(count, threads, [&](std::size_t i) {
    const Window window = window_of(starts[i], durations[i]);
    half_spaces.check(i);
    if (!a_is_near) {
      a.check_reach(i, window, "a");
    }
    if (!b_is_near) {
      b.check_reach(i, window, "b");
    }
    const Motion motion_a = a.motion(i, window), motion_b = b.motion(i, window);
    rows[i] = checked_row(detector->time_of_impact({a.shape(i), motion_a}, {b.shape(i), motion_b},
                                                   window, tolerance));
  });
  return answers;
}

py::array overlap(const QueryBodies& a, const QueryBodies& b, std::size_t threads,
                  std::size_t count) {
  const auto detector = find_detector("certified");
  py::array_t<bool> answers(static_cast<py::ssize_t>(count));
  bool* rows = answers.mutable_data();
  const HalfSpaceGuard half_spaces(a, b);
  for_all_rows(count, threads, [&](std::size_t i) {
    half_spaces.check(i);
    rows[i] = detector->overlaps(a.shape(i), a.pose(i), b.shape(i), b.pose(i));
  });
  return answers;
}

py::array distance(const QueryBodies& a, const QueryBodies& b, std::size_t threads,
                   std::size_t count) {
  const auto detector = find_detector("certified");
  py::array answers(distance_dtype(), py::array::ShapeContainer{static_cast<py::ssize_t>(count)});
  auto* rows = static_cast<DistanceRow*>(answers.mutable_data());
  const HalfSpaceGuard half_spaces(a, b);
  for_all_rows(count, threads, [&](std::size_t i) {
    half_spaces.check(i);
    const Overlap found = detector->overlap(a.shape(i), a.pose(i), b.shape(i), b.pose(i));
    rows[i].gap = found.gap;
    copy(found.normal, rows[i].normal);
    copy(found.point, rows[i].point);
  });
  return answers;
}

}  // namespace

void bind_queries(py::module_& module) {
  bind_query_bodies(module);
  module.def("toi", &toi, py::arg("a"), py::arg("b"), py::arg("duration"), py::arg("start"),
             py::arg("detector"), py::arg("tolerance"), py::arg("threads"), py::arg("count"));
  module.def("overlap", &overlap, py::arg("a"), py::arg("b"), py::arg("threads"), py::arg("count"));
  module.def("distance", &distance, py::arg("a"), py::arg("b"), py::arg("threads"),
             py::arg("count"));
}

}  // namespace kairos::python
