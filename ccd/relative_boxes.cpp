#include "ccd/relative_boxes.hpp"

#include "ccd/rounding/roundoff.hpp"
#include "core/circular.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

constexpr std::array<int, 5> cyclic{0, 1, 2, 0, 1};  ///< cyclic[i + 1] comes after i

/// Edge i of a and edge j of b; k, l and m, n come after them in cyclic order.
struct EdgePair {
  int i, j, k, l, m, n;
  explicit EdgePair(int axis) : i((axis - 6) / 3), j((axis - 6) % 3) {
    const auto after = [](int x, int by) { return cyclic[static_cast<std::size_t>(x + by)]; };
    k = after(i, 1);
    l = after(i, 2);
    m = after(j, 1);
    n = after(j, 2);
  }
};

}  // namespace

RelativeBoxes::RelativeBoxes(const Box& a, const Pose& pose_a, const Box& b, const Pose& pose_b)
    : half_a(a.half_extents), half_b(b.half_extents) {
  const Quaternion to_a = pose_a.orientation.conjugate();
  d_A = to_a * Vector3(pose_b.position - pose_a.position);
  axes_A = (to_a * pose_b.orientation).toRotationMatrix();
}

RelativeBoxes::RelativeBoxes(const Vector3& half_a_, const Matrix3& R_WA, const Vector3& half_b_,
                             const Matrix3& R_WB, const Vector3& d_W)
    : half_a(half_a_), half_b(half_b_) {
  d_A.noalias() = R_WA.transpose() * d_W;
  axes_A.noalias() = R_WA.transpose() * R_WB;
}

double RelativeBoxes::error() const {
  return 24.0 * unit_roundoff * (d_A.lpNorm<1>() + half_a.sum() + half_b.sum());
}

AxisSeparation axis_separation(const RelativeBoxes& s, int axis) {
  const Matrix3& R = s.axes_A;
  if (axis < 3) {
    const double extent = s.half_a[axis] + s.half_b.dot(R.row(axis).cwiseAbs());
    return {axis, std::abs(s.d_A[axis]) - extent, 1.0, s.d_A[axis] < 0.0 ? -1.0 : 1.0};
  }
  if (axis < 6) {
    const double along = s.d_A.dot(R.col(axis - 3));
    const double extent = s.half_b[axis - 3] + s.half_a.dot(R.col(axis - 3).cwiseAbs());
    return {axis, std::abs(along) - extent, 1.0, along < 0.0 ? -1.0 : 1.0};
  }
  const EdgePair e(axis);
  const double x = R(e.k, e.j);
  const double y = R(e.l, e.j);
  const double along = s.d_A[e.l] * x - s.d_A[e.k] * y;
  const double extent =
      (s.half_a[e.k] * std::abs(y) + s.half_a[e.l] * std::abs(x)) +
      (s.half_b[e.m] * std::abs(R(e.i, e.n)) + s.half_b[e.n] * std::abs(R(e.i, e.m)));
  return {axis, std::abs(along) - extent, std::sqrt(x * x + y * y), along < 0.0 ? -1.0 : 1.0};
}

AxisSeparation unit_edge_separation(const RelativeBoxes& s, int axis) {
  const EdgePair e(axis);
  // In the frame of a the direction has two entries of an axis of b, so that it is as exact as
  // these, however small.
  const double x = -s.axes_A(e.l, e.j);
  const double y = s.axes_A(e.k, e.j);
  const double size = std::max(std::abs(x), std::abs(y));
  constexpr double none = 1e-200;  // their length times a separation is to be no subnormal number
  if (!(size > none)) {
    return {axis, -infinity};
  }
  const double length = hypotenuse(x / size, y / size);
  Vector3 n = Vector3::Zero();
  n[e.k] = x / size / length;
  n[e.l] = y / size / length;
  const Vector3 along_b = s.axes_A.transpose() * n;
  const double along = n.dot(s.d_A);
  const double gap =
      std::abs(along) - s.half_a.dot(n.cwiseAbs()) - s.half_b.dot(along_b.cwiseAbs());
  return {axis, gap * (size * length), size * length, along < 0.0 ? -1.0 : 1.0};
}

AxisSeparation sharpened(const RelativeBoxes& s, const AxisSeparation& greatest) {
  const bool noisy = greatest.length < small_sine;
  if (!noisy && greatest.gap() > 64.0 * s.error()) {
    return greatest;
  }
  AxisSeparation best = noisy ? axis_separation(s, 0) : greatest;
  for (int axis = 1; noisy && axis < 6; ++axis) {
    const AxisSeparation face = axis_separation(s, axis);
    best = face.gap() > best.gap() ? face : best;
  }
  for (int axis = 6; axis < axis_count; ++axis) {
    const AxisSeparation edges = unit_edge_separation(s, axis);
    if (edges.length < small_sine || noisy) {
      best = edges.gap() - s.error() > best.gap() ? edges : best;
    }
  }
  return best;
}

Vector3 axis_normal(const RelativeBoxes& s, const AxisSeparation& axis) {
  if (axis.axis < 3) {
    return axis.sign * Vector3::Unit(axis.axis);
  }
  if (axis.axis < 6) {
    return axis.sign * s.axes_A.col(axis.axis - 3);
  }
  const EdgePair e(axis.axis);
  Vector3 n = Vector3::Zero();
  n[e.k] = -s.axes_A(e.l, e.j);
  n[e.l] = s.axes_A(e.k, e.j);
  return n * (axis.sign / axis.length);
}

Verdict classify(const RelativeBoxes& s, int& axis) {
  const double error = s.error();
  const auto separates = [&](int candidate) { return axis_separation(s, candidate).value > error; };
  if (separates(axis)) {
    return Verdict::separated;
  }
  const Verdict verdict = classify(s);
  if (verdict == Verdict::separated) {
    // The greatest separation lasts longest, unless it is roundoff itself.
    axis = greatest_separation(s).axis;
    for (int other = 0; !separates(axis); ++other) {
      axis = other;
    }
  }
  return verdict;
}

}  // namespace kairos::ccd
