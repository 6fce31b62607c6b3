#pragma once

#include "core/random.hpp"
#include "tests/judge/query.hpp"

namespace kairos::judge {

/// Which features of two boxes touch.
enum class Feature {
  vertex_face,
  edge_edge,
  edge_face,
  face_face,    ///< one orientation, and turned about the common normal
  same_tilt,    ///< face on face, of exactly one orientation
  edge_vertex,  ///< at the rim: beside it is nothing
  vertex_vertex,
};
inline constexpr std::uint64_t feature_count = 7;

/// Two bodies in touch at some moment, to rounding.
struct Contact {
  Query query;
  Vector3 normal;  ///< unit, from a to b
  Vector3 point;   ///< m
};

/// How the bodies of a contact move when they touch.
struct Approach {
  double closing = 1.0;  ///< speed along the normal at the contact point, m/s; < 0 parts
  double sliding = 0.0;  ///< speed along the surface, m/s
  double spin_a = 0.0;   ///< rad/s
  double spin_b = 0.0;   ///< rad/s
  double gap = 0.0;      ///< how far they are apart along the normal, m; < 0 overlaps
  double pull = 0.0;     ///< relative acceleration along the normal, m/s^2; > 0 parts
  double drift = 0.0;    ///< velocity that both share, m/s
  bool a_moves = false;
};

[[nodiscard]] Vector3 random_half_extents(Random& random, double lowest = 0.1,
                                          double highest = 2.0);
[[nodiscard]] Body random_box(Random& random, double lowest = 0.1, double highest = 2.0);
[[nodiscard]] Body random_sphere(Random& random);
/// A half-space through the origin, tilted anyhow.
[[nodiscard]] Body random_plane(Random& random);

/// Two boxes in touch; `angle`: how far edges or faces are from parallel, rad (0: as the feature).
[[nodiscard]] Contact boxes_in_touch(Random& random, Feature feature, const Body& a, const Body& b);
/// Edges that cross at a sine, in touch.
[[nodiscard]] Contact crossing_edges(Random& random, double sine, const Body& a, const Body& b);
/// b in touch with the half-space, box (face, edge or vertex) or sphere a.
[[nodiscard]] Contact on_plane(Random& random, const Body& plane, const Body& b);
[[nodiscard]] Contact on_ball(Random& random, const Body& a, const Body& ball);
/// Any of the above.
[[nodiscard]] Contact any_contact(Random& random);

/// The query whose bodies touch (or miss each other by `gap`) at `time` of a window.
[[nodiscard]] Query set_moving(Random& random, const Contact& contact, const Approach& approach,
                               double time, double duration);

/// Moves the world: positions by `shift`.
void shift(Query& query, const Vector3& by);
/// Turns the world about the origin.
void turn(Query& query, const Quaternion& by);
/// The body of `query` as it is `seconds` later, as a scheme would hand it on.
void advance(Query& query, double seconds);
/// A unit vector across n.
[[nodiscard]] Vector3 across(Random& random, const Vector3& n);

}  // namespace kairos::judge
