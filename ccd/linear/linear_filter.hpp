#pragma once

#include "ccd/linear/linear_impact.hpp"
#include "core/double_double.hpp"

#include <array>

namespace kairos::ccd {

enum class FilterVerdict : std::uint8_t { apart, meet, unknown };

/// Where the volume has one root, and no other since the start: f(lower) has the sign `before`,
/// proven, and f(upper) the other one.
template <typename Real>
struct RootBracket {
  Real lower = 0.0, upper = 0.0;
  int before = 0;
};

/// The volume of the four points, equation (1), by its scaled Bernstein coefficients (2), computed
/// in `Real`, double or `DoubleDouble`; with the bounds (9) and (11) on what rounding did.
template <typename Real>
class LinearFilter {
 public:
  explicit LinearFilter(const LinearQuery& query);

  /// False where numbers are too large or too small for the bounds to hold: nothing else is asked
  /// then.
  [[nodiscard]] bool in_range() const { return in_range_; }
  /// F_0, T_1, T_2, F_3 of equation (2), each off by at most `error_bound`, as is every value of f.
  [[nodiscard]] const std::array<Real, 4>& coefficients() const { return f_; }
  [[nodiscard]] double error_bound() const { return error_; }
  /// True: they are proven to stay further apart than the separation of the query.
  [[nodiscard]] bool never_coplanar(double separation) const;
  /// Whether they meet, without a separation; where, if so.
  [[nodiscard]] FilterVerdict classify(RootBracket<Real>& meeting) const;
  /// Brackets the one root of f near t within another bracket; false if rounding hides it.
  [[nodiscard]] bool bracket_root(const Real& near, const Real& begin, const Real& end, int before,
                                  RootBracket<Real>& root) const;

 private:
  using Vector = std::array<Real, 3>;
  struct Moving {
    Vector start, end;
    [[nodiscard]] Vector at(const Real& t) const;
  };

  [[nodiscard]] Moving between(const LinearQuery& query, std::size_t from, std::size_t to) const;
  void find_coefficients();
  [[nodiscard]] Real value(const Real& t) const;
  [[nodiscard]] Real slope(const Real& t) const;
  [[nodiscard]] Real blossom(const Real& a, const Real& b, const Real& c) const;
  [[nodiscard]] int proven_sign(const Real& f) const;
  [[nodiscard]] bool is_monotone() const;
  [[nodiscard]] int split_points(std::array<Real, 4>& points) const;
  [[nodiscard]] Real search(const Real& begin, const Real& end, int before) const;
  [[nodiscard]] FilterVerdict inside(const RootBracket<Real>& root) const;

  LinearKind kind_;
  Moving x_, y_, z_;
  std::array<double, 3> size_{};  ///< m_k: the largest magnitude of any component k
  std::array<Real, 4> f_;         ///< F_0, 3 f_1, 3 f_2, F_3
  double error_ = 0.0;            ///< E, equation (9)
  bool in_range_ = false;
};

extern template class LinearFilter<double>;
extern template class LinearFilter<DoubleDouble>;

}  // namespace kairos::ccd
