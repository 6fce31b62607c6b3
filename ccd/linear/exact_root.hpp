#pragma once

#include "ccd/linear/exact_polynomial.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace kairos::ccd {

/// A root of a polynomial in [0, 1]: a number itself, or the only root between two numbers. As
/// doubles it is exact (t_lo = t_hi), or strictly between two that are adjacent.
struct ExactRoot {
  Dyadic lower, upper;  ///< equal: the root itself
  int sign_before = 0;  ///< of the polynomial between `lower` and the root
  double t_lo = 0.0, t_hi = 0.0;

  [[nodiscard]] bool is_a_number() const { return t_lo == t_hi; }
};

/// All roots of a polynomial in [0, 1] in ascending order, each once, whatever its multiplicity.
class ExactRoots {
 public:
  static constexpr std::size_t largest_degree = 6;

  /// `p` is not the zero polynomial and of degree at most 6.
  explicit ExactRoots(const ExactPolynomial& p);

  [[nodiscard]] std::size_t size() const { return size_; }
  /// Root i, with `t_lo` and `t_hi` as close as doubles are.
  [[nodiscard]] const ExactRoot& refined(std::size_t i);
  /// The sign of another polynomial at root i.
  [[nodiscard]] int sign_at(std::size_t i, const ExactPolynomial& q);

 private:
  void add(const Dyadic& lower, const Dyadic& upper, int sign_before);
  void isolate(const Variations& whole);
  void refine(ExactRoot& root) const;
  void leave_ends_that_are_roots(ExactRoot& root) const;

  ExactPolynomial p_;  ///< square-free between 0 and 1
  std::array<ExactRoot, largest_degree> roots_;
  std::array<bool, largest_degree> is_refined_{};
  std::size_t size_ = 0;
};

}  // namespace kairos::ccd
