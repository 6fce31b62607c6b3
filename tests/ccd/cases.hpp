#pragma once

#include "ccd/certified.hpp"
#include "experiments/accuracy/random_query.hpp"
#include "tests/catch.hpp"

#include <numbers>

/// What the tests of the "cases that broke others" share.
namespace kairos::reference {

inline const double pi = std::numbers::pi;
inline const auto certified = ccd::make_certified();
inline const Vector3 zero = Vector3::Zero();

/// The answer of `certified`, after a look at all its promises, and that a and b may be exchanged.
inline TimeOfImpact kept(const Query& q, int samples = 200) {
  const TimeOfImpact toi = q.ask(*certified);
  CAPTURE(std::string(to_string(toi.status)), toi.t_lo, toi.t_hi, toi.gap, toi.evaluations);
  CHECK(broken_promise(q, toi, samples) == "");
  const TimeOfImpact other = q.exchanged().ask(*certified);
  CHECK(other.status == toi.status);
  return toi;
}

inline Motion still(const Pose& at) { return moving(at, zero); }
/// A cube of half extent 1 at rest at the origin.
inline Query against_unit_cube(const Shape& b, const Motion& motion_b) {
  return {box(1, 1, 1), b, still(pose(zero)), motion_b, 1.0};
}

}  // namespace kairos::reference
