#include "ccd/relative_boxes.hpp"

#include "ccd/roundoff.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

constexpr std::array<int, 3> next{1, 2, 0};
constexpr std::array<int, 3> after{2, 0, 1};

/// The boxes and |R|: every projection of an extent is a sum of these. Indices are template
/// arguments, so that all fifteen separations are straight arithmetic on registers.
struct Projections {
  const RelativeBoxes& s;
  Matrix3 R;
  explicit Projections(const RelativeBoxes& boxes) : s(boxes), R(boxes.axes_A.cwiseAbs()) {}

  /// Separation along face normal I of a.
  template <int I>
  double face_a() const {
    return std::abs(s.d_A[I]) - s.half_a[I] -
           (s.half_b[0] * R(I, 0) + s.half_b[1] * R(I, 1) + s.half_b[2] * R(I, 2));
  }
  /// Projection of d on axis J of b.
  template <int J>
  double along_b() const {
    return s.d_A[0] * s.axes_A(0, J) + s.d_A[1] * s.axes_A(1, J) + s.d_A[2] * s.axes_A(2, J);
  }
  template <int J>
  double face_b() const {
    return std::abs(along_b<J>()) - s.half_b[J] -
           (s.half_a[0] * R(0, J) + s.half_a[1] * R(1, J) + s.half_a[2] * R(2, J));
  }
  /// Projection of d on e_I x (axis J of b).
  template <int I, int J>
  double along_edges() const {
    constexpr int k = next[I];
    constexpr int l = after[I];
    return s.d_A[l] * s.axes_A(k, J) - s.d_A[k] * s.axes_A(l, J);
  }
  template <int I, int J>
  double edges() const {
    constexpr int k = next[I];
    constexpr int l = after[I];
    constexpr int m = next[J];
    constexpr int n = after[J];
    return std::abs(along_edges<I, J>()) - (s.half_a[k] * R(l, J) + s.half_a[l] * R(k, J)) -
           (s.half_b[m] * R(I, n) + s.half_b[n] * R(I, m));
  }
  /// Square of the sine between the edges.
  template <int I, int J>
  double sine_squared() const {
    const double x = s.axes_A(next[I], J);
    const double y = s.axes_A(after[I], J);
    return x * x + y * y;
  }
};

/// Calls f<I, J>() for all edge pairs in order; stops where one returns true.
template <typename F>
bool any_edge_pair(const F& f) {
  return f.template operator()<0, 0>() || f.template operator()<0, 1>() ||
         f.template operator()<0, 2>() || f.template operator()<1, 0>() ||
         f.template operator()<1, 1>() || f.template operator()<1, 2>() ||
         f.template operator()<2, 0>() || f.template operator()<2, 1>() ||
         f.template operator()<2, 2>();
}

template <int Axis>
AxisSeparation separation_along(const Projections& p) {
  if constexpr (Axis < 3) {
    return {Axis, p.face_a<Axis>(), 1.0, p.s.d_A[Axis] < 0.0 ? -1.0 : 1.0};
  } else if constexpr (Axis < 6) {
    return {Axis, p.face_b<Axis - 3>(), 1.0, p.along_b<Axis - 3>() < 0.0 ? -1.0 : 1.0};
  } else {
    constexpr int i = (Axis - 6) / 3;
    constexpr int j = (Axis - 6) % 3;
    return {Axis, p.edges<i, j>(), std::sqrt(p.sine_squared<i, j>()),
            p.along_edges<i, j>() < 0.0 ? -1.0 : 1.0};
  }
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
  using Along = AxisSeparation (*)(const Projections&);
  static constexpr std::array<Along, axis_count> along{
      separation_along<0>,  separation_along<1>,  separation_along<2>,  separation_along<3>,
      separation_along<4>,  separation_along<5>,  separation_along<6>,  separation_along<7>,
      separation_along<8>,  separation_along<9>,  separation_along<10>, separation_along<11>,
      separation_along<12>, separation_along<13>, separation_along<14>};
  return along[static_cast<std::size_t>(axis)](Projections(s));
}

AxisSeparation greatest_separation(const RelativeBoxes& s) {
  const Projections p(s);
  const std::array<double, 6> faces{p.face_a<0>(), p.face_a<1>(), p.face_a<2>(),
                                    p.face_b<0>(), p.face_b<1>(), p.face_b<2>()};
  int best = 0;
  for (int i = 1; i < 6; ++i) {
    if (faces[static_cast<std::size_t>(i)] > faces[static_cast<std::size_t>(best)]) {
      best = i;
    }
  }
  double value = faces[static_cast<std::size_t>(best)];
  const double error = s.error();
  any_edge_pair([&]<int I, int J>() {
    const double f = p.edges<I, J>() - error;
    // Dividing by a sine raises only positive values: most pairs need no root.
    if (f <= value && (f <= 0.0 ? value >= 0.0 : f * f <= value * value * p.sine_squared<I, J>())) {
      return false;
    }
    const double length = std::sqrt(p.sine_squared<I, J>());
    if (f > value * length && length > 0.0) {
      value = f / length;
      best = 6 + 3 * I + J;
    }
    return false;
  });
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
  const Projections p(s);
  if (p.face_a<0>() > 0.0 || p.face_a<1>() > 0.0 || p.face_a<2>() > 0.0 || p.face_b<0>() > 0.0 ||
      p.face_b<1>() > 0.0 || p.face_b<2>() > 0.0) {
    return false;
  }
  const double error = s.error();
  return !any_edge_pair([&]<int I, int J>() { return p.edges<I, J>() > error; });
}

Verdict classify(const RelativeBoxes& s) {
  const Projections p(s);
  const double error = s.error();
  if (p.face_a<0>() > error || p.face_a<1>() > error || p.face_a<2>() > error ||
      p.face_b<0>() > error || p.face_b<1>() > error || p.face_b<2>() > error) {
    return Verdict::separated;
  }
  double crossed = -infinity;
  const bool apart = any_edge_pair([&]<int I, int J>() {
    const double f = p.edges<I, J>();
    crossed = std::max(crossed, f);
    return f > error;
  });
  if (apart) {
    return Verdict::separated;
  }
  const double faces = std::max(
      {p.face_a<0>(), p.face_a<1>(), p.face_a<2>(), p.face_b<0>(), p.face_b<1>(), p.face_b<2>()});
  if (faces >= -error) {
    return Verdict::undecided;
  }
  if (crossed < -error) {
    return Verdict::overlapping;
  }
  // Some edge pair cannot tell. Were two edges exactly parallel, the six faces alone would decide:
  // the cross-sections are rectangles. Turning b by the small angle between them moves its support
  // and the separations by less than 4 sine * size, so faces that overlap by more decide still.
  double least = infinity;
  any_edge_pair([&]<int I, int J>() {
    least = std::min(least, p.sine_squared<I, J>());
    return false;
  });
  const double size = s.d_A.lpNorm<1>() + s.half_a.sum() + s.half_b.sum();
  const double moved = 4.0 * (std::sqrt(least) + 16.0 * unit_roundoff) * size;
  return moved < -faces - error ? Verdict::overlapping : Verdict::undecided;
}

}  // namespace kairos::ccd
