#pragma once

#include "core/archive.hpp"
#include "core/force.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace kairos::integrators {

/// An island as a first-order system y' = f(s, y), y flat, s local time from an epoch: what
/// Runge-Kutta methods and the libraries' solvers see.
///
/// Per body: position (3), velocity (3) and, if it rotates, quaternion w, x, y, z (4) and angular
/// velocity in the world frame (3). Quaternions are integrated in R^4: the flow q' = w q / 2 keeps
/// |q|, forces see q/|q|, so normalising after a step costs no order [Hairer2006, IV.4].
class IslandOde {
 public:
  static constexpr std::size_t position = 0, velocity = 3, quaternion = 6, angular = 10;

  /// Where a body's components start, and whether they include rotation.
  struct Slot {
    std::size_t offset = 0;
    bool rotates = false;
  };

  /// Lays the island out; allocates.
  void layout(const Island& island);
  /// Makes s = 0 of the given island the right-hand side's origin; before every step.
  void bind(const Island& island, Instant epoch) {
    island_ = &island;
    epoch_ = epoch;
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::span<const Slot> slots() const { return slots_; }
  [[nodiscard]] std::int64_t evaluations() const { return evaluations_; }
  void persist(Archive& archive) { archive(evaluations_); }

  void pack(std::span<const BodyState> states, double* y) const;
  /// Normalises quaternions; bodies that do not rotate keep orientation and angular velocity.
  void unpack(const double* y, std::span<BodyState> states) const;
  /// Normalises the quaternions in y.
  void normalize(double* y) const;
  void rhs(double s, const double* y, double* dy);
  /// The rate at states whose wrenches are known.
  void rate(const Island& island, std::span<const BodyState> states,
            std::span<const Wrench> wrenches, double* dy) const;

 private:
  const Island* island_ = nullptr;
  Instant epoch_;
  std::vector<Slot> slots_;
  std::vector<BodyState> states_;  ///< scratch of `rhs`
  std::vector<Wrench> wrenches_;   ///< scratch of `rhs`
  std::size_t size_ = 0;
  std::int64_t evaluations_ = 0;
};

}  // namespace kairos::integrators
