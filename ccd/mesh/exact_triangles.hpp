#pragma once

#include "ccd/mesh/mesh_pair.hpp"

namespace kairos::ccd {

// Yes or no without an error, for points in whole numbers; degenerate triangles (a segment, a
// point) are what they are: the hull of their corners, which is closed.

/// The side of d on which the plane a, b, c has it: the sign of (b - a) . ((c - a) x (d - a)).
[[nodiscard]] int exact_orientation(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c,
                                    const ExactPoint& d);
/// Do the segments p q and r s have a point in common?
[[nodiscard]] bool exact_segments_touch(const ExactPoint& p, const ExactPoint& q,
                                        const ExactPoint& r, const ExactPoint& s);
/// Does the segment p q have a point in common with a triangle?
[[nodiscard]] bool exact_segment_touches(const ExactPoint& p, const ExactPoint& q,
                                         const ExactCorners& t);
/// Do two triangles have a point in common?
[[nodiscard]] bool exact_triangles_touch(const ExactCorners& a, const ExactCorners& b);
/// Is a triangle a segment or a point?
[[nodiscard]] bool exact_degenerate(const ExactCorners& t);

}  // namespace kairos::ccd
