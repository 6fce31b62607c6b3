#pragma once

#include "ccd/linear/exact_polynomial.hpp"
#include "ccd/linear/linear_impact.hpp"

#include <array>
#include <cstddef>

namespace kairos::ccd {

/// A vector that moves linearly, in whole numbers: start, end, and end - start.
struct ExactVector {
  std::array<ExactInteger, 3> start, end, rate;

  [[nodiscard]] ExactPolynomial component(std::size_t k) const { return {start[k], rate[k]}; }
};
[[nodiscard]] ExactVector operator-(const ExactVector& a, const ExactVector& b);
/// Component k of the cross product.
[[nodiscard]] ExactPolynomial cross(const ExactVector& a, const ExactVector& b, std::size_t k);

/// Whether a unit of length may differ between the axes (signs of determinants stay, and numbers
/// are shorter), or is the same in all (lengths are comparable).
enum class AxisUnits { own, common };

/// The four points of a query as seen from the first one, in whole numbers: x to point 1, y to 2, z
/// to 3; equation numbers are those of the README.
class ExactMotion {
 public:
  ExactMotion(const LinearQuery& query, AxisUnits units);

  [[nodiscard]] const ExactVector& x() const { return x_; }
  [[nodiscard]] const ExactVector& y() const { return y_; }
  [[nodiscard]] const ExactVector& z() const { return z_; }
  /// With common units: 2 to this power.
  [[nodiscard]] int unit_exponent() const { return unit_; }
  /// x . (y x z), equation (1); zero where the four points are coplanar.
  [[nodiscard]] ExactPolynomial volume() const;

 private:
  ExactVector x_, y_, z_;
  int unit_ = 0;
};

/// Stage 4 without a separation. The answer to any finite query.
[[nodiscard]] LinearImpact exact_impact(const LinearQuery& query);
/// Stage 4 with a separation > 0.
[[nodiscard]] LinearImpact exact_impact_at_distance(const LinearQuery& query);
/// The sign of the volume at a time in [0, 1].
[[nodiscard]] int exact_volume_sign(const LinearQuery& query, double t);

}  // namespace kairos::ccd
