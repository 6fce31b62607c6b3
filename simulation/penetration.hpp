#pragma once

#include "core/contact_detector.hpp"
#include "core/model.hpp"
#include "core/neighbourhood.hpp"
#include "core/scheme.hpp"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace kairos {
inline namespace simulation {

/// Two solids that are inside each other.
struct Penetration {
  BodyPair pair;
  double depth = 0.0;  ///< least translation that separates them, m, > 0
};

/// How deep solids are inside each other at one instant, by the exact distance of their shapes and
/// whatever detector a run uses. Pairs without a free body are left alone: nothing could part
/// them.
///
/// Where there are many bodies, only those are asked that a broad phase finds near each other. In a
/// periodic box the nearest images of two bodies are looked at.
///
/// Tolerance (roundoff): what 16 eps times the coordinates and extents can account for is touching
/// and not penetration; a ball at rest on a floor stands at a rounded height.
class PenetrationProbe {
 public:
  /// The model is kept by reference.
  explicit PenetrationProbe(const Model& model);
  explicit PenetrationProbe(Model&& model) = delete;

  /// The deepest of all pairs; the first of equals in the order of `Model::pairs`. What is in a
  /// hand (see `Frame::in_hand`) has no contacts and penetrates nothing.
  [[nodiscard]] std::optional<Penetration> deepest(std::span<const BodyState> bodies,
                                                   std::span<const char> in_hand = {}) const;
  /// How deep two solids are inside each other, m; 0 if they are not, or neither is free.
  [[nodiscard]] double depth(BodyIndex a, const Pose& pose_a, BodyIndex b,
                             const Pose& pose_b) const;
  /// The first pair that penetrates.
  [[nodiscard]] std::optional<Penetration> first(std::span<const BodyState> bodies,
                                                 std::span<const char> in_hand = {}) const;

 private:
  [[nodiscard]] bool finite(BodyIndex i) const;
  [[nodiscard]] bool can_penetrate(BodyIndex a, BodyIndex b) const;
  template <typename Visit>
  void for_each_near_pair(std::span<const BodyState> bodies, const Visit& visit) const;

  const Model& model_;
  std::shared_ptr<const ContactDetector> detector_;
  std::unique_ptr<Neighbourhood> neighbourhood_;  ///< null where the model asks every pair
};

}  // namespace simulation
}  // namespace kairos
