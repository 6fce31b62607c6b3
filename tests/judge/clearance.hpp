#pragma once

#include "tests/judge/separation.hpp"

namespace kairos::judge {

/// What rounding in double precision hides of the gap t seconds into the window, m: eight units
/// of roundoff of every length that the gap is a sum of (coordinates with what velocity and
/// acceleration add, extents times the angle turned, and for a half-space the arm times its angle).
[[nodiscard]] double roundoff(const Query& query, double t);

/// Gap at t less the error radii, m, with its sign right: in quad where rounding of `Long` could
/// matter. Two boxes without error radii that are apart: the greatest over the separating axes, a
/// lower bound of the distance.
[[nodiscard]] double exact_gap(const Query& query, Long t);
/// The same at two poses in double precision.
[[nodiscard]] double exact_gap(const Query& query, const Pose& a, const Pose& b);

enum class Finding { clear, contact, unproven };

struct Look {
  Finding finding = Finding::clear;
  Long when = 0;  ///< of the contact, or where the proof gave up, s
};

/// Exact arithmetic in all but name: what quad resolves, and `Long` proves, of `roundoff`.
inline constexpr double exactly = 0x1p-10;

/// A gap to hold the true one against: a share of `roundoff`, at least `floor` (m); above 0 or
/// below. Where the gap is not above `stop`, that is found; that it stays above `prove`, which is
/// less, is proven.
struct Level {
  bool above = false;
  double share = exactly;
  double floor = 0.0;

  [[nodiscard]] Long stop(const Query& query, Long t) const;
  [[nodiscard]] Long prove(const Query& query, Long t) const;
};

/// Is the gap above a level everywhere in [t0, t1]? `contact`: at `when` it is not above `stop`;
/// `clear`: proven to stay above `prove`.
///
/// The proof walks: whatever the unit normal n, the gap along it bounds the distance from below.
/// From an instant on, n stands still, or turns at a constant rate w_n: with a body, or so that it
/// stays across the edges that touch. Then n . offset and each |n . u_i| of a box's axes is at
/// least, or at most, its tangent and x^2/2 times a bound of the second derivative (of a constant
/// spin, |w x n| and |w x u_i| are constant), so that the bound of the gap is concave in x: above
/// the level in between if it is at both ends. Far away the solids of revolution, or balls, are
/// enough.
[[nodiscard]] Look look(const Query& query, Long t0, Long t1, const Level& level,
                        int budget = 20000);

}  // namespace kairos::judge
