#pragma once

#include "experiments/accuracy/query.hpp"

namespace kairos::reference {

/// When the shapes of a query first touch, in long double, by means that share nothing with ccd:
/// advancement by separation over the greatest speed of any point, then bisection.
struct Truth {
  bool overlapping = false;  ///< at the start
  bool contact = false;      ///< after it: some separation below minus the reference's roundoff
  Real touch = 0;            ///< the gap is positive up to here, and tiny from here on; s
  Real time = 0;             ///< of the contact, s
};

/// Looks for it; `steps` bounds the work of the advancement, behind which dense samples follow.
[[nodiscard]] Truth find_truth(const Query& q, int steps = 4000, int samples = 200);

/// What an answer is worth.
enum class Finding { right, missed, late, wrong };

/// `wrong`: a promise of the bracket is broken: contact by t_hi, a gap within the tolerance at
/// t_lo, overlapping where it is not. What is `undecided` is right unless it is late. A detector
/// that does not prove is late only beyond the tolerance.
[[nodiscard]] Finding judge(const Query& q, const TimeOfImpact& toi, const Truth& truth,
                            double tolerance, bool proves);

}  // namespace kairos::reference
