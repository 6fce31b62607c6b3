#pragma once

#include "core/contact_detector.hpp"

#include <string>

namespace kairos::judge {

enum class Kind { box, sphere, half_space };

/// One body of a query: p(s) = p + v s + a s^2/2, q(s) = exp(w s/2) q; or, if `polynomial`,
/// p(s) = `course`(s), q(s) = `turn`(s) / |`turn`(s)|. s = `age` + t, t from the start of the
/// window.
struct Body {
  Kind kind = Kind::box;
  Vector3 half_extents = Vector3::Ones();  ///< m; a sphere has its radius in x
  Vector3 position = Vector3::Zero();      ///< m
  Quaternion orientation = Quaternion::Identity();
  Vector3 velocity = Vector3::Zero();      ///< m/s
  Vector3 acceleration = Vector3::Zero();  ///< m/s^2
  Vector3 spin = Vector3::Zero();          ///< angular velocity, world frame, rad/s
  Vector3 normal = Vector3::UnitY();  ///< of a half-space, outward, body frame, unit to rounding
  bool polynomial = false;
  Polynomial<3> course;       ///< m
  Polynomial<4> turn;         ///< (w, x, y, z)
  double error_radius = 0.0;  ///< m
  double age = 0.0;           ///< how long its motion lasts when the window starts, s

  [[nodiscard]] Shape shape() const;
  [[nodiscard]] Motion motion(Instant window_start, double duration) const;
  /// Smallest full extent, m; infinite for a half-space.
  [[nodiscard]] double smallest_extent() const;
  /// Radius of the ball around the origin that holds the shape, m; 0 for a half-space.
  [[nodiscard]] double reach() const;
};

/// Two moving bodies and a window: when do they first touch?
struct Query {
  std::string id;
  std::string family;  ///< the class of the generator that made it
  Body a;
  Body b;
  double duration = 1.0;   ///< s
  double tolerance = 0.0;  ///< m; 0 for the default
  Instant start;           ///< of the window, absolute time

  [[nodiscard]] TimeOfImpact ask(const ContactDetector& detector) const;
  [[nodiscard]] Query exchanged() const;
};

/// The columns of `kairos toi`, and what it has no column for, as a header and as a row.
[[nodiscard]] std::string csv_header();
[[nodiscard]] std::string csv_row(const Query& query);

}  // namespace kairos::judge
