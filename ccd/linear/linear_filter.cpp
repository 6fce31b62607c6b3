#include "ccd/linear/linear_filter.hpp"

#include "ccd/rounding/roundoff.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace kairos::ccd {
namespace {

/// Every operation is exact up to a factor 1 + d with |d| <= this; for double-doubles as in
/// [Joldes2017] (sum: 3 u^2, product: 5 u^2).
template <typename Real>
constexpr double roundoff_of = std::is_same_v<Real, double> ? unit_roundoff : 0x1p-103;

template <typename Real>
constexpr Real third = Real(1.0 / 3.0);
template <>
constexpr DoubleDouble third<DoubleDouble>{0x1.5555555555555p-2, 0x1.5555555555555p-56};

// Within these, no product of three differs overflows, and what underflows is below all bounds.
constexpr double least_size = 0x1p-250;
constexpr double largest_size = 0x1p250;

double rounded(double x) { return x; }
double rounded(const DoubleDouble& x) { return x.high; }

int sign_beyond(double value, double bound) {
  return value > bound ? 1 : (value < -bound ? -1 : 0);
}

DoubleDouble difference(double a, double b, DoubleDouble /*type*/) { return core::two_sum(a, -b); }
double difference(double a, double b, double /*type*/) { return a - b; }

template <typename Real>
Real cross(const std::array<Real, 3>& a, const std::array<Real, 3>& b, std::size_t k) {
  const std::size_t i = (k + 1) % 3;
  const std::size_t j = (k + 2) % 3;
  return a[i] * b[j] - a[j] * b[i];
}
template <typename Real>
std::array<Real, 3> cross(const std::array<Real, 3>& a, const std::array<Real, 3>& b) {
  return {cross(a, b, 0), cross(a, b, 1), cross(a, b, 2)};
}
template <typename Real>
Real dot(const std::array<Real, 3>& a, const std::array<Real, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <typename Real>
std::array<Real, 3> minus(const std::array<Real, 3>& a, const std::array<Real, 3>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

}  // namespace

template <typename Real>
auto LinearFilter<Real>::Moving::at(const Real& t) const -> Vector {
  const Real s = Real(1.0) - t;
  return {start[0] * s + end[0] * t, start[1] * s + end[1] * t, start[2] * s + end[2] * t};
}

template <typename Real>
auto LinearFilter<Real>::between(const LinearQuery& query, std::size_t from, std::size_t to) const
    -> Moving {
  Moving moving;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    moving.start[k] = difference(query.start[to][i], query.start[from][i], Real());
    moving.end[k] = difference(query.end[to][i], query.end[from][i], Real());
  }
  return moving;
}

template <typename Real>
LinearFilter<Real>::LinearFilter(const LinearQuery& query)
    : kind_(query.kind),
      x_(between(query, 0, 1)),
      y_(between(query, 0, 2)),
      z_(between(query, 0, 3)) {
  double largest = 0.0;
  double least = infinity;
  for (std::size_t k = 0; k < 3; ++k) {
    for (const Moving* m : {&x_, &y_, &z_}) {
      size_[k] = std::max({size_[k], std::abs(rounded(m->start[k])), std::abs(rounded(m->end[k]))});
    }
    largest = std::max(largest, size_[k]);
    least = std::min(least, size_[k]);
  }
  in_range_ = largest < largest_size && least > least_size;
  if (in_range_) {
    find_coefficients();
  }
}

// Equation (2).
template <typename Real>
void LinearFilter<Real>::find_coefficients() {
  const Vector n_0 = cross(y_.start, z_.start);
  const Vector n_2 = cross(y_.end, z_.end);
  const Vector forth = cross(y_.start, z_.end);
  const Vector back = cross(y_.end, z_.start);
  const Vector n_1{forth[0] + back[0], forth[1] + back[1], forth[2] + back[2]};
  f_[0] = dot(x_.start, n_0);
  f_[1] = dot(x_.end, n_0) + dot(x_.start, n_1);
  f_[2] = dot(x_.start, n_2) + dot(x_.end, n_1);
  f_[3] = dot(x_.end, n_2);
  // Equation (9).
  error_ = 224.0 * roundoff_of<Real> * size_[0] * size_[1] * size_[2];
}

template <typename Real>
int LinearFilter<Real>::proven_sign(const Real& f) const {
  return sign_beyond(rounded(f), error_);
}

// All Bernstein coefficients beyond separation |n|, where |n| <= |e_1| |e_2| for the two edges
// across whose plane, or planes, the volume is measured.
template <typename Real>
bool LinearFilter<Real>::never_coplanar(double separation) const {
  double needed = 0.0;
  if (separation > 0.0) {
    const auto longest = [this](const Moving& a, const Moving& b) {
      const Vector start = minus(a.start, b.start);
      const Vector end = minus(a.end, b.end);
      const double length = std::sqrt(std::max(rounded(dot(start, start)), rounded(dot(end, end))));
      return length + 0x1p-40 * length + 0x1p-49 * (size_[0] + size_[1] + size_[2]);
    };
    const Moving origin{};
    const double edge = kind_ == LinearKind::vertex_face ? longest(y_, x_) : longest(x_, origin);
    const double other = kind_ == LinearKind::vertex_face ? longest(z_, x_) : longest(z_, y_);
    needed = separation * edge * other * (1.0 + 0x1p-50);
  }
  const double inner = 3.0 * needed;
  const int sign = sign_beyond(rounded(f_[0]), error_ + needed);
  return sign != 0 && sign == sign_beyond(rounded(f_[1]), error_ + inner) &&
         sign == sign_beyond(rounded(f_[2]), error_ + inner) &&
         sign == sign_beyond(rounded(f_[3]), error_ + needed);
}

template <typename Real>
Real LinearFilter<Real>::value(const Real& t) const {
  const Real s = Real(1.0) - t;
  const Real tt = t * t;
  return ((f_[0] * s + f_[1] * t) * s + f_[2] * tt) * s + f_[3] * (tt * t);
}

template <typename Real>
Real LinearFilter<Real>::slope(const Real& t) const {
  const Real s = Real(1.0) - t;
  const Real d_0 = f_[1] - Real(3.0) * f_[0];
  const Real d_1 = f_[2] - f_[1];
  const Real d_2 = Real(3.0) * f_[3] - f_[2];
  return (d_0 * s + Real(2.0) * d_1 * t) * s + d_2 * (t * t);
}

template <typename Real>
Real LinearFilter<Real>::blossom(const Real& a, const Real& b, const Real& c) const {
  const Real r = Real(1.0) - a;
  const Real s = Real(1.0) - b;
  const Real t = Real(1.0) - c;
  const Real one = a * (s * t) + r * (b * t + s * c);
  const Real two = r * (b * c) + a * (s * c + b * t);
  return f_[0] * (r * (s * t)) + f_[3] * (a * (b * c)) + (f_[1] * one + f_[2] * two) * third<Real>;
}

// Equation (10): the derivative has no root, as its discriminant is negative, errors included.
template <typename Real>
bool LinearFilter<Real>::is_monotone() const {
  const double error = 6.0 * error_;
  const double d_0 = std::abs(rounded(f_[1] - Real(3.0) * f_[0])) - error;
  const double d_1 = std::abs(rounded(f_[2] - f_[1])) + error;
  const double d_2 = std::abs(rounded(Real(3.0) * f_[3] - f_[2])) - error;
  const bool same_sign =
      (rounded(f_[1] - Real(3.0) * f_[0]) > 0.0) == (rounded(Real(3.0) * f_[3] - f_[2]) > 0.0);
  return same_sign && d_0 > 0.0 && d_2 > 0.0 && d_0 * d_2 > d_1 * d_1 * (1.0 + 0x1p-50);
}

/// Where to cut [0, 1] so that f is monotone in between, as near as one knows; with both ends.
template <typename Real>
int LinearFilter<Real>::split_points(std::array<Real, 4>& points) const {
  const double c = rounded(f_[1] - Real(3.0) * f_[0]);
  const double half_b = rounded(f_[2] - f_[1]) - c;
  const double a = rounded(Real(3.0) * f_[3] - f_[2]) - c - 2.0 * half_b;
  const double discriminant = half_b * half_b - a * c;
  int count = 0;
  if (discriminant > 0.0) {
    const double q = -(half_b + std::copysign(std::sqrt(discriminant), half_b));
    std::array<double, 2> roots{q / a, c / q};
    if (roots[1] < roots[0]) {
      std::swap(roots[0], roots[1]);
    }
    for (const double t : roots) {
      if (t > 0.0 && t < 1.0) {
        points[static_cast<std::size_t>(++count)] = Real(t);
      }
    }
  }
  return count + 1;
}

/// The root between two places of opposite signs, as near as one knows: Newton's method, kept
/// within a bracket.
template <typename Real>
Real LinearFilter<Real>::search(const Real& begin, const Real& end, int before) const {
  double lower = rounded(begin);
  double upper = rounded(end);
  double t = 0.5 * (lower + upper);
  const std::array<double, 4> f{rounded(f_[0]), rounded(f_[1]), rounded(f_[2]), rounded(f_[3])};
  const double d_0 = f[1] - 3.0 * f[0];
  const double d_1 = 2.0 * (f[2] - f[1]);
  const double d_2 = 3.0 * f[3] - f[2];
  for (int i = 0; i < 60; ++i) {
    const double s = 1.0 - t;
    const double value = ((f[0] * s + f[1] * t) * s + f[2] * t * t) * s + f[3] * t * t * t;
    (value * before > 0.0 ? lower : upper) = t;
    double next = t - value / ((d_0 * s + d_1 * t) * s + d_2 * t * t);
    if (!(next > lower && next < upper)) {
      next = 0.5 * (lower + upper);
    }
    const bool done = std::abs(next - t) <= 0x1p-52;
    t = next;
    if (done) {
      break;
    }
  }
  return Real(t);
}

template <typename Real>
bool LinearFilter<Real>::bracket_root(const Real& near, const Real& begin, const Real& end,
                                      int before, RootBracket<Real>& root) const {
  Real t = near;
  if constexpr (!std::is_same_v<Real, double>) {
    for (int i = 0; i < 2; ++i) {
      const double by = rounded(slope(t));
      t = by == 0.0 ? t : t - value(t) / Real(by);
    }
  }
  double width = 2.0 * error_ / std::abs(rounded(slope(t))) + 8.0 * roundoff_of<Real>;
  for (int i = 0; i < 3 && width < 0.25; ++i, width *= 8.0) {
    root.lower = t - Real(width);
    root.upper = t + Real(width);
    if (rounded(root.lower - begin) < 0.0) {
      root.lower = begin;
    }
    if (rounded(end - root.upper) < 0.0) {
      root.upper = end;
    }
    root.before = before;
    if (!(rounded(root.upper - root.lower) > 0.0)) {
      return false;  // Newton's method has left the bracket
    }
    if (proven_sign(value(root.lower)) == before && proven_sign(value(root.upper)) == -before) {
      return true;
    }
  }
  return false;
}

// Equations (3), (4) and (11).
template <typename Real>
FilterVerdict LinearFilter<Real>::inside(const RootBracket<Real>& root) const {
  const Real t = root.lower;
  const double width = rounded(root.upper - root.lower) + 4.0 * roundoff_of<Real>;
  const double unit = 128.0 * roundoff_of<Real> + 25.0 * width;
  const Vector x = x_.at(t);
  const Vector y = y_.at(t);
  const Vector z = z_.at(t);
  const bool face = kind_ == LinearKind::vertex_face;
  const Vector n = face ? cross(minus(y, x), minus(z, x)) : cross(x, minus(z, y));
  std::size_t k = 0;
  double largest = -1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double relative = std::abs(rounded(n[i])) * size_[i];
    k = relative > largest ? i : k;
    largest = std::max(relative, largest);
  }
  const double bound = unit * size_[(k + 1) % 3] * size_[(k + 2) % 3];
  const int u = sign_beyond(rounded(cross(y, z, k)), bound);
  const int v = sign_beyond(rounded(cross(x, z, k)), bound);
  const int w = sign_beyond(rounded(cross(x, y, k)), bound);
  const int fourth = face ? u : sign_beyond(rounded(cross(minus(z, x), minus(y, x), k)), bound);
  const int second = face ? -v : v;
  const int third = face ? w : -w;
  const int least = std::min({u, second, third, fourth});
  const int greatest = std::max({u, second, third, fourth});
  if (least < 0 && greatest > 0) {
    return FilterVerdict::apart;
  }
  return least == greatest && least != 0 ? FilterVerdict::meet : FilterVerdict::unknown;
}

template <typename Real>
FilterVerdict LinearFilter<Real>::classify(RootBracket<Real>& meeting) const {
  std::array<Real, 4> points;
  const bool monotone = is_monotone();
  const int parts = monotone ? 1 : split_points(points);
  points[0] = Real(0.0);
  points[static_cast<std::size_t>(parts)] = Real(1.0);
  Real begin = points[0];
  int sign_begin = proven_sign(f_[0]);
  for (int i = 1; i <= parts; ++i) {
    const Real end = points[static_cast<std::size_t>(i)];
    const Real at_end = i == parts ? f_[3] : value(end);
    const int sign_end = proven_sign(at_end);
    if (sign_begin == 0 || sign_end == 0) {
      return FilterVerdict::unknown;
    }
    const int one = monotone ? sign_begin : proven_sign(blossom(begin, begin, end));
    const int two = monotone ? sign_end : proven_sign(blossom(begin, end, end));
    if (sign_begin == sign_end) {
      if (one != sign_begin || two != sign_begin) {
        return FilterVerdict::unknown;
      }
    } else {
      // One change of sign whatever the uncertain ones are: from + ? - -, + + ? -.
      if (one != sign_begin && two != sign_end) {
        return FilterVerdict::unknown;
      }
      if (!bracket_root(search(begin, end, sign_begin), begin, end, sign_begin, meeting)) {
        return FilterVerdict::unknown;
      }
      const FilterVerdict verdict = inside(meeting);
      if (verdict != FilterVerdict::apart) {
        return verdict;
      }
    }
    begin = end;
    sign_begin = sign_end;
  }
  return FilterVerdict::apart;
}

template class LinearFilter<double>;
template class LinearFilter<DoubleDouble>;

}  // namespace kairos::ccd
