#pragma once

// How FCL is asked about shapes in motion. Included where FCL was found only.
#include "core/pose.hpp"

#include <fcl/math/motion/interp_motion.h>
#include <fcl/narrowphase/continuous_collision_request.h>

namespace kairos::experiments {

inline fcl::Transform3d transform(const Pose& pose) {
  fcl::Transform3d placed = fcl::Transform3d::Identity();
  placed.linear() = pose.orientation.toRotationMatrix();
  placed.translation() = pose.position;
  return placed;
}

/// Conservative advancement between the poses at both ends; `tolerance` of the time, as a fraction
/// of the window (FCL's own default is 1e-4).
inline fcl::ContinuousCollisionRequestd advancement_request(double tolerance) {
  fcl::ContinuousCollisionRequestd request;
  request.ccd_motion_type = fcl::CCDM_LINEAR;
  request.ccd_solver_type = fcl::CCDC_CONSERVATIVE_ADVANCEMENT;
  request.gjk_solver_type = fcl::GST_LIBCCD;
  request.toc_err = tolerance;
  return request;
}

/// Given two transforms alone, FCL 0.7 does not initialise the point that it turns about.
inline fcl::InterpMotion<double> motion_between(const fcl::Transform3d& start,
                                                const fcl::Transform3d& end) {
  return fcl::InterpMotion<double>(start.linear(), start.translation(), end.linear(),
                                   end.translation(), fcl::Vector3d::Zero());
}

}  // namespace kairos::experiments
