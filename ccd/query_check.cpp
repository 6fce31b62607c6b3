#include "ccd/query_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace kairos::ccd {
namespace {

constexpr double normal_tolerance = 1e-14;  // roundings of who made it unit, and of the square
constexpr double time_tolerance = 1e-12;
constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double sum_rounding = 1e-12;  // of a sum that others make in another order

[[noreturn]] void refuse(const char* body, const std::string& what) {
  throw std::invalid_argument(fmt::format("contact query: {}{}", body, what));
}

void check_extent(const char* body, double extent) {
  if (!(extent >= least_extent && extent <= greatest_size)) {
    refuse(body, fmt::format("{} is no extent; allowed: from {} to {} (m)", extent, least_extent,
                             greatest_size));
  }
}

void check_hull(const char* body, const Hull& hull) {
  if (hull.core == nullptr || hull.core->vertices.size() < 4) {
    refuse(body, "the hull has no polytope; allowed: what convex_hull returns");
  }
  check_extent(body, hull.core->width);
  check_extent(body, hull.core->radius);
  if (!(hull.rounding >= 0.0 && hull.rounding <= greatest_size)) {
    refuse(body, fmt::format("the rounding is {}; allowed: from 0 to {} (m)", hull.rounding,
                             greatest_size));
  }
}

void check_shape(const char* body, const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    check_extent(body, sphere->radius);
  } else if (const auto* box = std::get_if<Box>(&shape)) {
    for (int k = 0; k < 3; ++k) {
      check_extent(body, box->half_extents[k]);
    }
  } else if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    check_extent(body, capsule->radius);
    check_extent(body, capsule->length);
  } else if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    check_extent(body, cylinder->radius);
    check_extent(body, cylinder->length);
  } else if (const auto* cone = std::get_if<Cone>(&shape)) {
    check_extent(body, cone->radius);
    check_extent(body, cone->height);
  } else if (const auto* hull = std::get_if<Hull>(&shape)) {
    check_hull(body, *hull);
  } else if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    if (mesh->body == nullptr) {
      refuse(body, "the mesh has no triangles; allowed: what solid_body or mesh_in_place makes");
    }
  } else if (const auto* compound = std::get_if<Compound>(&shape)) {
    if (compound->body == nullptr) {
      refuse(body, "the compound has no parts; allowed: what compound_body makes");
    }
  } else {
    const double square = std::get<HalfSpace>(shape).normal_B.squaredNorm();
    if (!(std::abs(square - 1.0) <= normal_tolerance)) {
      refuse(body, fmt::format("the normal has length {}; allowed: 1", std::sqrt(square)));
    }
  }
}

void check_unit(const char* body, double square) {
  // | |q| - 1 | <= tolerance, to first order.
  if (std::abs(square - 1.0) > 2.0 * unit_tolerance && std::isfinite(square)) {
    refuse(body, fmt::format("the quaternion has length {}; allowed: 1 within {}",
                             std::sqrt(square), unit_tolerance));
  }
}

void check_rotation(const char* body, const Motion& motion) {
  const double square = motion.quaternion[0].squaredNorm();
  if (motion.rotation != RotationKind::polynomial) {
    check_unit(body, square);
  } else if (square == 0.0) {
    refuse(body, "the quaternion is 0; allowed: any other polynomial");
  }
}

void check_motion(const char* body, const Motion& motion, const Window& window) {
  if (motion.error_radius < 0.0 || motion.error_radius > greatest_size) {
    refuse(body, fmt::format("the error radius is {}; allowed: from 0 to {} (m)",
                             motion.error_radius, greatest_size));
  }
  check_rotation(body, motion);
  const double s0 = window.start - motion.start;
  const double s1 = s0 + window.duration;
  // Instants are told to their two doubles' last bit, which may be much of a short motion.
  const double instants =
      4.0 * epsilon * epsilon * (std::abs(window.start.seconds) + std::abs(motion.start.seconds));
  const double slack = time_tolerance * (std::abs(s0) + (std::isfinite(s1) ? s1 : 0.0)) + instants;
  if (!(s0 >= -slack) || !(s1 <= motion.duration + slack)) {
    refuse(body, fmt::format("the window is from {} to {} s of a motion that lasts {} s; allowed: "
                             "within the motion",
                             s0, s1, motion.duration));
  }
}

/// sum |c_k| s^k, a bound of the polynomial up to s. High coefficients of short steps may be large
/// without harm; in an endless window the coefficients themselves are checked.
template <int N>
double most_within(const Polynomial<N>& p, double s) {
  double size = 0.0;
  for (int k = p.degree(); k >= 0; --k) {
    size = size * (std::isfinite(s) ? s : 1.0) + p[k].norm();
  }
  return size * (1.0 - sum_rounding);
}

/// Is the motion known, and within `greatest_size`, up to the end of the window?
bool motion_within_range(const Motion& motion, const Window& window) {
  const double end = window.start - motion.start + window.duration;
  const double turning = motion.rotation == RotationKind::polynomial
                             ? most_within(motion.quaternion, end)
                             : motion.rotation_rate.norm();
  return most_within(motion.position, end) <= greatest_size && turning <= greatest_size;
}

}  // namespace

void check_query(const MovingShape& a, const MovingShape& b, const Window& window,
                 double tolerance) {
  if (!(window.duration >= 0.0)) {
    refuse("", fmt::format("the window lasts {} s; allowed: >= 0", window.duration));
  }
  if (!(tolerance >= 0.0)) {
    refuse("", fmt::format("the tolerance is {} m; allowed: >= 0", tolerance));
  }
  check_shape("a: ", a.shape);
  check_shape("b: ", b.shape);
  check_motion("a: ", a.motion, window);
  check_motion("b: ", b.motion, window);
}

bool within_range(const MovingShape& a, const MovingShape& b, const Window& window) {
  return motion_within_range(a.motion, window) && motion_within_range(b.motion, window);
}

void check_poses(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  check_shape("a: ", a);
  check_shape("b: ", b);
  check_unit("a: ", pose_a.orientation.squaredNorm());
  check_unit("b: ", pose_b.orientation.squaredNorm());
}

}  // namespace kairos::ccd
