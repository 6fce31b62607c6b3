#pragma once

#include "core/force.hpp"

namespace kairos {
inline namespace core {

/// A spring with a damper along it, from a point of its first body to a point of its second or, if
/// it is given one body only, to an anchor in the world. The force on the first body is
///
///   F = -(k (L - L0) + c L') n,   n the direction from the other end, L the length.
///
/// With L0 = 0 it is -k times the distance vector, smooth through L = 0. Where n is undefined (two
/// ends in one point) only that part acts. Has a potential, k (L - L0)^2 / 2, where c = 0.
class Spring final : public Force {
 public:
  struct Parameters {
    double stiffness = 0.0;              ///< k, N/m
    double damping = 0.0;                ///< c, N s/m
    double rest_length = 0.0;            ///< L0, m
    Vector3 point_A = Vector3::Zero();   ///< on the first body, its frame, m
    Vector3 point_B = Vector3::Zero();   ///< on the second body, its frame, m
    Vector3 anchor_W = Vector3::Zero();  ///< the other end if there is one body, m
  };
  /// Throws `InputError` for values that are negative or not finite.
  explicit Spring(const Parameters& parameters);

  /// One body or two.
  void add(Instant t, std::span<const BodyState> bodies, std::span<Wrench> wrenches) const override;
  [[nodiscard]] double potential(Instant t, std::span<const BodyState> bodies) const override;
  [[nodiscard]] bool conservative() const override { return parameters_.damping == 0.0; }
  [[nodiscard]] bool involves_rotation() const override {
    return !parameters_.point_A.isZero(0.0) || !parameters_.point_B.isZero(0.0);
  }
  [[nodiscard]] std::string description() const override {
    return conservative()                 ? "spring"
           : parameters_.stiffness == 0.0 ? "damper"
                                          : "spring and damper";
  }

  [[nodiscard]] const Parameters& parameters() const { return parameters_; }

 private:
  struct Ends {
    Vector3 a, b;  ///< world frame, m
    Vector3 rate;  ///< velocity of a against b, m/s
  };
  [[nodiscard]] Ends ends(std::span<const BodyState> bodies) const;

  Parameters parameters_;
};

}  // namespace core
}  // namespace kairos
