#pragma once

#include "ccd/advancement.hpp"
#include "experiments/accuracy/reference.hpp"

#include <string>

/// Short ways to write a query, and the one judge of all answers.
namespace kairos::reference {

inline Pose pose(const Vector3& position, const Quaternion& orientation = Quaternion::Identity()) {
  return {position, orientation};
}
inline Box box(double x, double y, double z) { return {Vector3(x, y, z)}; }
inline Quaternion turned(const Vector3& axis, double angle) {
  return rotate(axis.normalized() * angle, Quaternion::Identity());
}
inline Motion moving(const Pose& at, const Vector3& velocity,
                     const Vector3& angular = Vector3::Zero(),
                     const Vector3& acceleration = Vector3::Zero(), double duration = 1.0) {
  return Motion::ballistic({}, duration, at, {velocity, angular}, acceleration);
}

struct Query {
  Shape a, b;
  Motion motion_a, motion_b;
  double duration = 1.0;

  [[nodiscard]] MovingShape moving_a() const { return {a, motion_a}; }
  [[nodiscard]] MovingShape moving_b() const { return {b, motion_b}; }
  [[nodiscard]] Window window() const { return {{}, duration}; }
  [[nodiscard]] TimeOfImpact ask(const ContactDetector& detector, double tolerance = 0.0) const {
    return detector.time_of_impact(moving_a(), moving_b(), window(), tolerance);
  }
  [[nodiscard]] Real separation(Real t) const {
    return reference::separation(moving_a(), t, moving_b(), t);
  }
  [[nodiscard]] Query exchanged() const { return {b, a, motion_b, motion_a, duration}; }
};

/// Roundoff of the reference: 64 long double roundings of the extent and the coordinates.
[[nodiscard]] Real reference_error(const Query& q);

/// Everything that `certified` promises of an answer, against the reference; empty if it keeps it.
[[nodiscard]] std::string broken_promise(const Query& q, const TimeOfImpact& toi,
                                         int samples = 200);

}  // namespace kairos::reference
