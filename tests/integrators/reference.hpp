#pragma once

#include <array>
#include <cstddef>

namespace kairos::integrators::test {

/// Reference solutions in extended precision by Gragg-Bulirsch-Stoer extrapolation
/// [Hairer1993, II.9]: code that shares nothing with the steppers it judges.
template <std::size_t N>
using Vector = std::array<long double, N>;

/// The modified midpoint rule with n substeps over H.
template <std::size_t N, typename Rhs>
Vector<N> midpoint_rule(const Rhs& f, long double t, const Vector<N>& y, long double H, int n) {
  const long double h = H / n;
  Vector<N> previous = y;
  Vector<N> rate = f(t, y);
  Vector<N> current;
  for (std::size_t i = 0; i < N; ++i) {
    current[i] = y[i] + h * rate[i];
  }
  for (int k = 1; k < n; ++k) {
    rate = f(t + k * h, current);
    for (std::size_t i = 0; i < N; ++i) {
      const long double next = previous[i] + 2 * h * rate[i];
      previous[i] = current[i];
      current[i] = next;
    }
  }
  return current;
}

/// One extrapolated step of order 20.
template <std::size_t N, typename Rhs>
Vector<N> extrapolated_step(const Rhs& f, long double t, const Vector<N>& y, long double H) {
  constexpr int rows = 10;
  std::array<Vector<N>, rows> table;
  for (int row = 0; row < rows; ++row) {
    Vector<N> previous_diagonal = table[0];
    table[0] = midpoint_rule<N>(f, t, y, H, 2 * (row + 1));
    for (int k = 1; k <= row; ++k) {
      const long double ratio = static_cast<long double>(row + 1) / (row + 1 - k);
      const auto column = static_cast<std::size_t>(k);
      const Vector<N> above = previous_diagonal;
      previous_diagonal = table[column];
      for (std::size_t i = 0; i < N; ++i) {
        table[column][i] =
            table[column - 1][i] + (table[column - 1][i] - above[i]) / (ratio * ratio - 1);
      }
    }
  }
  return table[rows - 1];
}

/// y(t1) from y(t0), in `steps` steps.
template <std::size_t N, typename Rhs>
Vector<N> solve(const Rhs& f, long double t0, Vector<N> y, long double t1, int steps) {
  const long double H = (t1 - t0) / steps;
  for (int k = 0; k < steps; ++k) {
    y = extrapolated_step<N>(f, t0 + k * H, y, H);
  }
  return y;
}

}  // namespace kairos::integrators::test
