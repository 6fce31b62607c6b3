#include "ccd/bounds_ahead.hpp"

#include <algorithm>
#include <cassert>

namespace kairos::ccd {
namespace {

/// Length of a piece in steps, and by how much it may be too long.
constexpr double steps_of_piece = 4.0;
constexpr double steps_too_long = 16.0;

}  // namespace

void BoundsAhead::begin(double t, double piece) {
  assert(t >= 0.0 && piece >= 0.0);
  turn_ = motion_.bounds(t, piece);
  assert(turn_.until >= t);
  made_at_ = t;
  used_again_ = false;
}

void BoundsAhead::renew(double t, double last_step) {
  if (motion_.simple()) {
    turn_.until = motion_.duration();
    return;
  }
  const bool too_long = last_step > 0.0 && t + steps_too_long * last_step < turn_.until;
  if (too_long || t >= turn_.until) {
    const double remaining = motion_.duration() - t;
    begin(t, last_step > 0.0 ? std::min(remaining, steps_of_piece * last_step) : remaining);
  } else if (t > made_at_ && !used_again_) {
    // The bend is counted from another time: of d there, and from there to here.
    turn_.bend *= 2.0;
    used_again_ = true;
  }
}

}  // namespace kairos::ccd
