#include "ccd/relative_boxes.hpp"

#include "ccd/roundoff.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

constexpr std::array<int, 3> next{1, 2, 0};
constexpr std::array<int, 3> after{2, 0, 1};

/// Separation along face normal i of a.
double face_a(const RelativeBoxes& s, int i) {
  return std::abs(s.d_A[i]) - s.half_a[i] -
         (s.half_b[0] * std::abs(s.axes_A(i, 0)) + s.half_b[1] * std::abs(s.axes_A(i, 1)) +
          s.half_b[2] * std::abs(s.axes_A(i, 2)));
}

/// Projection of d on axis j of b.
double along_b(const RelativeBoxes& s, int j) {
  return s.d_A[0] * s.axes_A(0, j) + s.d_A[1] * s.axes_A(1, j) + s.d_A[2] * s.axes_A(2, j);
}

double face_b(const RelativeBoxes& s, int j) {
  return std::abs(along_b(s, j)) - s.half_b[j] -
         (s.half_a[0] * std::abs(s.axes_A(0, j)) + s.half_a[1] * std::abs(s.axes_A(1, j)) +
          s.half_a[2] * std::abs(s.axes_A(2, j)));
}

/// Projection of d on e_i x (axis j of b).
double along_edges(const RelativeBoxes& s, int i, int j) {
  const int k = next[static_cast<std::size_t>(i)];
  const int l = after[static_cast<std::size_t>(i)];
  return s.d_A[l] * s.axes_A(k, j) - s.d_A[k] * s.axes_A(l, j);
}

double edges(const RelativeBoxes& s, int i, int j) {
  const int k = next[static_cast<std::size_t>(i)];
  const int l = after[static_cast<std::size_t>(i)];
  const int m = next[static_cast<std::size_t>(j)];
  const int n = after[static_cast<std::size_t>(j)];
  const double radius_a =
      s.half_a[k] * std::abs(s.axes_A(l, j)) + s.half_a[l] * std::abs(s.axes_A(k, j));
  const double radius_b =
      s.half_b[m] * std::abs(s.axes_A(i, n)) + s.half_b[n] * std::abs(s.axes_A(i, m));
  return std::abs(along_edges(s, i, j)) - radius_a - radius_b;
}

double edge_length(const RelativeBoxes& s, int i, int j) {
  const double x = s.axes_A(next[static_cast<std::size_t>(i)], j);
  const double y = s.axes_A(after[static_cast<std::size_t>(i)], j);
  return std::sqrt(x * x + y * y);
}

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
  if (axis < 3) {
    return {axis, face_a(s, axis), 1.0, s.d_A[axis] < 0.0 ? -1.0 : 1.0};
  }
  if (axis < 6) {
    return {axis, face_b(s, axis - 3), 1.0, along_b(s, axis - 3) < 0.0 ? -1.0 : 1.0};
  }
  const int i = (axis - 6) / 3;
  const int j = (axis - 6) % 3;
  return {axis, edges(s, i, j), edge_length(s, i, j), along_edges(s, i, j) < 0.0 ? -1.0 : 1.0};
}

AxisSeparation greatest_separation(const RelativeBoxes& s) {
  int best = 0;
  double value = face_a(s, 0);
  for (int i = 1; i < 3; ++i) {
    const double f = face_a(s, i);
    if (f > value) {
      value = f;
      best = i;
    }
  }
  for (int j = 0; j < 3; ++j) {
    const double f = face_b(s, j);
    if (f > value) {
      value = f;
      best = 3 + j;
    }
  }
  const double error = s.error();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double f = edges(s, i, j) - error;
      // Dividing by a length of at most 1 raises only positive values.
      if (f <= value && f <= 0.0 && value >= 0.0) {
        continue;
      }
      const double length = edge_length(s, i, j);
      if (f > value * length && length > 0.0) {
        value = f / length;
        best = 6 + 3 * i + j;
      }
    }
  }
  return axis_separation(s, best);
}

Vector3 axis_normal(const RelativeBoxes& s, const AxisSeparation& axis) {
  if (axis.axis < 3) {
    return axis.sign * Vector3::Unit(axis.axis);
  }
  if (axis.axis < 6) {
    return axis.sign * s.axes_A.col(axis.axis - 3);
  }
  const int i = (axis.axis - 6) / 3;
  const int j = (axis.axis - 6) % 3;
  Vector3 n = Vector3::Zero();
  n[next[static_cast<std::size_t>(i)]] = -s.axes_A(after[static_cast<std::size_t>(i)], j);
  n[after[static_cast<std::size_t>(i)]] = s.axes_A(next[static_cast<std::size_t>(i)], j);
  return n * (axis.sign / axis.length);
}

bool boxes_overlap(const RelativeBoxes& s) {
  for (int i = 0; i < 3; ++i) {
    if (face_a(s, i) > 0.0) {
      return false;
    }
  }
  for (int j = 0; j < 3; ++j) {
    if (face_b(s, j) > 0.0) {
      return false;
    }
  }
  const double error = s.error();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (edges(s, i, j) > error) {
        return false;
      }
    }
  }
  return true;
}

Verdict classify(const RelativeBoxes& s) {
  const double error = s.error();
  double faces = -infinity;
  for (int i = 0; i < 3; ++i) {
    faces = std::max({faces, face_a(s, i), face_b(s, i)});
  }
  if (faces > error) {
    return Verdict::separated;
  }
  double crossed = -infinity;
  double least_sine = infinity;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double f = edges(s, i, j);
      if (f > error) {
        return Verdict::separated;
      }
      crossed = std::max(crossed, f);
    }
  }
  if (faces >= -error) {
    return Verdict::undecided;
  }
  if (crossed < -error) {
    return Verdict::overlapping;
  }
  // Some edge pair cannot tell. Were two edges exactly parallel, the six faces alone would decide:
  // the cross-sections are rectangles. Turning b by the small angle between them moves its support
  // and the separations by less than 4 sine * size, so faces that overlap by more decide still.
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      least_sine = std::min(least_sine, edge_length(s, i, j));
    }
  }
  const double size = s.d_A.lpNorm<1>() + s.half_a.sum() + s.half_b.sum();
  const double moved = 4.0 * (least_sine + 16.0 * unit_roundoff) * size;
  return moved < -faces - error ? Verdict::overlapping : Verdict::undecided;
}

}  // namespace kairos::ccd
