#pragma once

#include "tests/judge/query.hpp"
#include "tests/judge/real.hpp"

namespace kairos::judge {

/// Two bodies at one instant.
template <typename S>
struct Placed {
  Vector<S> offset;  ///< from the origin of a to that of b, world frame, m
  Axes<S> a;
  Axes<S> b;
};

/// Signed gap of two bodies and the unit normal, from a to b, along which it is measured.
template <typename S>
struct Separation {
  S gap{};
  Vector<S> normal;
};

/// The two bodies t seconds after the start of the window: of the exact numbers that the doubles
/// of the query denote, quaternions normalised, all in S.
template <typename S>
Placed<S> placed(const Query& query, S t);

/// The two bodies at poses that somebody computed.
template <typename S>
Placed<S> placed(const Pose& a, const Pose& b);

/// Greatest gap over the axes of the separating axis theorem, each of length one. Negative: the
/// depth, exactly. Positive: the distance, except of two boxes, where it is a lower bound.
template <typename S>
Separation<S> separation(const Body& a, const Body& b, const Placed<S>& at);

/// The distance of bodies that are apart, with the direction between their nearest points. Two
/// boxes: the least over all pairs of vertex and box, and of edge and edge.
template <typename S>
Separation<S> distance(const Body& a, const Body& b, const Placed<S>& at);

/// Outward normal of a half-space in the world, of length one.
template <typename S>
Vector<S> outward(const Body& half_space, const Axes<S>& axes);

/// How far a reaches along `direction` (unit), m; a half-space: 0 along its normal only.
template <typename S>
S support(const Body& body, const Axes<S>& axes, Vector<S> direction);

}  // namespace kairos::judge
