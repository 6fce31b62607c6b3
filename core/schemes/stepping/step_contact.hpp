#pragma once

#include "core/state.hpp"

namespace kairos {
inline namespace core {

class Archive;

/// One point of a contact in a step of a scheme that steps over contacts. Names that end in _W are
/// in the world frame; other vectors are in the frame of the contact: along the normal (from a to
/// b) and along two tangents.
struct StepContact {
  BodyIndex a = 0, b = 0;
  double gap = 0.0;                       ///< m; negative: penetration
  double restitution = 1.0;               ///< of the pair
  double friction = 0.0;                  ///< of the pair, may be infinite
  Matrix3 frame_W = Matrix3::Identity();  ///< columns: normal, tangents
  Vector3 arm_a_W = Vector3::Zero();      ///< from the origin of a to the point, m
  Vector3 arm_b_W = Vector3::Zero();
  Matrix3 compliance = Matrix3::Zero();  ///< what a unit impulse changes u by, 1/kg
  Vector3 before = Vector3::Zero();      ///< u-: velocity of b against a when the step began, m/s
  Vector3 impulse = Vector3::Zero();     ///< on b, over the step, N s
  Vector3 point_A = Vector3::Zero();     ///< in the frame of a: by this it is known again
  double fastest_approach = 0.0;         ///< since it began, m/s
  bool taken = false;                    ///< a contact of the next step goes on from it
  bool begins = true;                    ///< nothing pressed the pair apart in the last step

  [[nodiscard]] Vector3 normal_W() const { return frame_W.col(0); }
  /// What the next step needs to know of it.
  void persist(Archive& archive);
};

}  // namespace core
}  // namespace kairos
