#pragma once

#include "core/pose.hpp"

#include <string_view>

namespace kairos {
inline namespace core {

/// What is known of two shapes in a window.
enum class ToiStatus {
  separated,    ///< no contact in the window (proven, if the detector proves)
  impact,       ///< contact by t_hi; none before t_lo
  overlapping,  ///< the shapes overlap at the start of the window already
  /// Nothing is proven beyond t_lo. `gap` there within the tolerance: rounding hides whether they
  /// touch in [t_lo, t_hi]; if it is a start in touch (t_lo 0), they slide. A greater gap: the work
  /// that a query may take is done, and t_hi is t_lo. In both cases a query that begins at t_hi
  /// goes on from there.
  undecided,
};
/// The word for it in the output of `kairos toi`.
[[nodiscard]] std::string_view to_string(ToiStatus status);

/// When two moving shapes first touch. Times are local: seconds from the start of the window.
struct TimeOfImpact {
  ToiStatus status = ToiStatus::separated;
  double t_lo = 0.0;                    ///< no contact in [0, t_lo), s
  double t_hi = 0.0;                    ///< contact by t_hi (impact); where the search stopped, s
  double gap = 0.0;                     ///< distance at t_lo, from below, m (0 when overlapping)
  Vector3 normal = Vector3::Zero();     ///< unit, from a to b, world frame, at t_lo
  Vector3 witness_a = Vector3::Zero();  ///< nearest point of a at t_lo, world frame, m
  Vector3 witness_b = Vector3::Zero();  ///< nearest point of b at t_lo, world frame, m
  int evaluations = 0;                  ///< gap or distance evaluations: the counted cost
};

/// Two shapes at one instant.
struct Overlap {
  bool overlapping = false;
  /// Signed gap along `normal`: the distance when apart, minus the penetration depth (the least
  /// translation that separates) when overlapping, m.
  double gap = 0.0;
  Vector3 normal = Vector3::Zero();  ///< unit, from a to b, world frame
  Vector3 point = Vector3::Zero();   ///< centroid of the contact patch, world frame, m
};

}  // namespace core
}  // namespace kairos
