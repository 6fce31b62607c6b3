#pragma once

#include "ccd/witness.hpp"

namespace kairos::ccd {

/// How long two overlapping bodies, one of them a box at least, are proven to stay so, s, at most
/// `horizon`; 0 where nothing is proven. A point of one body stays inside the other until it
/// crosses one of six faces: boxes that slide in one another are followed as far as the faces
/// reach, where depth over speed would creep (eq. 14).
[[nodiscard]] double common_point(PairKind kind, const PairMotion& motion, const Kinematics& k,
                                  const TurnBounds& turn, const Witness& witness, double horizon);

}  // namespace kairos::ccd
