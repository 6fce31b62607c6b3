#pragma once

#include "ccd/pair_looks.hpp"
#include "core/contact_detector.hpp"

namespace kairos::ccd {

/// Gap from below, normal and nearest points of a look, in an answer whose status and bracket are
/// set.
///
/// `whole`: two whole bodies, for whom `t_lo` is moved back until they do not overlap at the poses
/// that anyone computes. Of parts of bodies that is for who puts their answers together.
void tell_contact(PairLooks& pair, const MovingShape& a, const MovingShape& b, const Window& window,
                  bool whole, Look at, TimeOfImpact& answer);

/// sum |c_k| s^k: no coordinate of the curve is larger up to s, m.
[[nodiscard]] double reached(const Polynomial<3>& p, double s);

}  // namespace kairos::ccd
