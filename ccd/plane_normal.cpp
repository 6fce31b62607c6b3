#include "ccd/plane_normal.hpp"

namespace kairos::ccd {
namespace {

Exact negative(Exact x) { return {-x.value, -x.lost}; }

/// a / b: a first quotient, and what is left over it.
Exact quotient(Exact a, Exact b) {
  const double first = a.value / b.value;
  const Exact rest = sum(a, negative(product(b, {first, 0.0})));
  return two_sum(first, rest.value / b.value);
}

/// R(q) |q|^2, an entry: of w w + x x - y y - z z, 2 (x y - w z) and their like.
Exact entry(const Vector4& q, int i, int k) {
  const auto times = [&q](int r, int c) { return two_product(q[r], q[c]); };
  if (i == k) {
    const int l = (i + 1) % 3;
    const int m = (i + 2) % 3;
    return sum(sum(times(0, 0), times(i + 1, i + 1)),
               negative(sum(times(l + 1, l + 1), times(m + 1, m + 1))));
  }
  const int other = 3 - i - k;
  const Exact turn = times(0, other + 1);
  const bool cyclic = (i + 1) % 3 == k;
  const Exact half = sum(times(i + 1, k + 1), cyclic ? negative(turn) : turn);
  return {2.0 * half.value, 2.0 * half.lost};
}

}  // namespace

PlaneNormal::PlaneNormal(const Vector3& normal_B, const Vector4& q)
    : high_(normal_B), low_(Vector3::Zero()) {
  if (q[1] == 0.0 && q[2] == 0.0 && q[3] == 0.0) {
    return;
  }
  Exact square{0.0, 0.0};
  for (int i = 0; i < 4; ++i) {
    square = sum(square, two_product(q[i], q[i]));
  }
  for (int i = 0; i < 3; ++i) {
    Exact component{0.0, 0.0};
    for (int k = 0; k < 3; ++k) {
      component = sum(component, product(entry(q, i, k), {normal_B[k], 0.0}));
    }
    const Exact n = quotient(component, square);
    high_[i] = n.value;
    low_[i] = n.lost;
  }
}

bool PlaneNormal::is_axis(int& axis) const {
  return high_.cwiseAbs().maxCoeff(&axis) == 1.0 && (high_.array() != 0.0).count() == 1 &&
         low_.isZero(0.0);
}

double PlaneNormal::height(const Vector3& x, const Vector3& y) const {
  Vector difference;
  for (int i = 0; i < 3; ++i) {
    const Exact d = two_sum(x[i], -y[i]);
    difference.high[i] = d.value;
    difference.low[i] = d.lost;
  }
  return height_of(difference);
}

double PlaneNormal::height_of(const Vector& x) const {
  Exact total{0.0, 0.0};
  for (int i = 0; i < 3; ++i) {
    total = sum(total, product({high_[i], low_[i]}, {x.high[i], x.low[i]}));
  }
  return total.value + total.lost;
}

}  // namespace kairos::ccd
