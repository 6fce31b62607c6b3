#pragma once

#include "core/polynomial.hpp"

#include <Eigen/Core>

namespace kairos {
inline namespace core {

/// Work from power at a few times: the polynomial through these, integrated.
struct PowerNodes {
  static constexpr int count = 8;
  /// When the k-th of them is, as a part of the time: those of Chebyshev, 0 <= k < `count`.
  [[nodiscard]] static double at(int k);
  /// The work since the start, J, as the x of a polynomial in time, of powers (W) at these parts of
  /// `duration`, s.
  [[nodiscard]] static Polynomial<3> work(const Eigen::VectorXd& powers, double duration);
};

}  // namespace core
}  // namespace kairos
