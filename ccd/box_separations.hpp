#pragma once

#include "ccd/relative_boxes.hpp"

namespace kairos::ccd {

/// All fifteen separations of two boxes at once, branch-free, four lanes at a time (the fourth
/// repeats the first). Results do not depend on how wide the machine's registers are: sums are
/// made in the same order and nothing is contracted.
struct BoxSeparations {
  double face_a[4];           ///< along the face normals of a, m
  double face_b[4];           ///< along those of b, m
  double edge[3][4];          ///< [j][i]: along e_i x (axis j of b), unnormalised, m
  double sine_squared[3][4];  ///< [j][i]: squared length of that cross product
};

void box_separations(const RelativeBoxes& boxes, BoxSeparations& all);

}  // namespace kairos::ccd
