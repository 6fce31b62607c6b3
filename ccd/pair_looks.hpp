#pragma once

#include "ccd/witness.hpp"

namespace kairos::ccd {

/// Two bodies at one instant of the window, and what separates them there.
struct Look {
  Kinematics k;
  Witness witness;

  [[nodiscard]] double t() const { return k.t; }
  [[nodiscard]] double gap() const { return witness.gap; }
  /// Is the gap at most so many errors (eq. 11)?
  [[nodiscard]] bool within(double errors) const { return witness.gap <= errors * k.error; }
};

/// Two bodies in motion that are looked at, one instant after another. Counts the looks.
class PairLooks {
 public:
  /// The motion must outlive it.
  PairLooks(PairKind kind, const PairMotion& motion) : kind_(kind), motion_(motion) {}

  [[nodiscard]] PairKind kind() const { return kind_; }
  [[nodiscard]] const PairMotion& motion() const { return motion_; }
  [[nodiscard]] double duration() const { return motion_.duration(); }
  [[nodiscard]] int count() const { return count_; }
  /// A question that is not a look and counts as one.
  void count_one() { ++count_; }

  /// Where the bodies are at t, and what separates them.
  [[nodiscard]] Look look(double t);
  /// Is an overlap proven at this look?
  [[nodiscard]] bool overlap_proven(const Look& at) const {
    return proven_overlap(kind_, motion_, at.k, at.witness);
  }
  /// Speed at which the gap closes along the witness, m/s. By bounds for this instant: those of the
  /// steps ahead may be infinite, where a polynomial quaternion comes near zero.
  [[nodiscard]] double approach(const Look& at) const;

  /// How far along a witness they stay apart, s (eq. 9); 0 where they are not apart along it now.
  [[nodiscard]] double step_along(const Kinematics& k, const Witness& witness,
                                  const TurnBounds& bounds, double horizon) const;
  /// How far they stay apart, s: along the witness that turns with the bodies and, where turning
  /// and not approach limits that, also along directions that stay.
  [[nodiscard]] double safe_step(const Kinematics& k, const Witness& witness,
                                 const TurnBounds& bounds, double horizon) const;
  /// How far along any of the axes along which they may be in touch, s: where a body turns about an
  /// edge that stays on a face, the witness of each look closes, and the face's normal does not.
  [[nodiscard]] double step_along_axes(const Look& at, const TurnBounds& bounds,
                                       double horizon) const;
  /// The same beside the hulls of all that spinning bodies pass (eq. 8).
  [[nodiscard]] double step_beside_hulls(const Look& at, const TurnBounds& bounds,
                                         double horizon) const;

 private:
  PairKind kind_;
  const PairMotion& motion_;
  int count_ = 0;
};

}  // namespace kairos::ccd
