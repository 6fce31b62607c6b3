#pragma once

#include "core/contact_detector.hpp"
#include "core/instant.hpp"

namespace kairos {
inline namespace core {

/// Two that touch at t may part there at once, and come together only later, or elsewhere; but
/// where they are as near as coordinates round, no detector can tell. How long they are to be left
/// alone, s: in that time they do not meet, and at its end they are farther apart than rounding. 0:
/// that is not known of them.
///
/// n: a normal that points from `own` to `other`. A plane that turns with `own` separates them at
/// the beginning and at the end. Seen from `own` the points of the other move nearly straight on,
/// and how far the nearest of them is from the plane is then a concave function of time: the plane
/// separates them in between, too. What they curve in that time is less than rounding. What motions
/// may be off by (their error radii) is left out.
[[nodiscard]] double draws_apart(const MovingShape& own, const MovingShape& other, const Vector3& n,
                                 Instant t);

}  // namespace core
}  // namespace kairos
