#pragma once

#include "experiments/accuracy/query.hpp"

namespace kairos::reference {

/// Classes of difficulty; a query is repeated from its class, kinds of shapes and seed.
enum class Difficulty {
  straight,     ///< parabolas, nothing turns
  turning,      ///< up to 3 rad/s about each axis
  spinning,     ///< up to 60 rad/s about each axis
  scaled,       ///< sizes from 1e-9 to 1e9 m
  far_away,     ///< 1e6 m from the origin
  all_turning,  ///< half-spaces turn as well
  polynomial,   ///< degree 5, quaternion polynomials of degree 4
  thin,         ///< one extent of each box is 1e-6 of the others
  unequal,      ///< the first is 1e-9 to 1e-3 of the size of the second
};
inline constexpr int difficulties = 9;
inline constexpr const char* difficulty_names[] = {"straight",   "turning",  "spinning",
                                                   "scaled",     "far-away", "all-turning",
                                                   "polynomial", "thin",     "unequal"};

struct ShapeKinds {
  int a, b;  ///< 0 sphere, 1 box, 2 half-space
};
inline constexpr ShapeKinds shape_kinds[] = {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}};

/// A ball, a box or a half-space of about this size.
[[nodiscard]] Shape random_shape(Random& random, int kind, double size);
/// Turns a ballistic motion into one of degree 5 with a quaternion of degree 4.
void roughen(Random& random, Motion& motion, double size);
[[nodiscard]] Query random_query(Difficulty difficulty, ShapeKinds kinds, std::uint64_t seed);

}  // namespace kairos::reference
