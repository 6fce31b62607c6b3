#pragma once

#include "core/motion.hpp"
#include "integrators/island_ode.hpp"

#include <span>
#include <vector>

namespace kairos::integrators {

/// Dense output for any method on an `IslandOde`: Hermite interpolation through nodes at which the
/// flat state y and its rate y' are known (the ends of the step and, for high orders, times
/// between).
///
/// With n nodes, position has (p, v, a) at the ends and (p, v) between: degree 2n+1, error
/// O(h^(2n+2)); velocity has (v, a) at all: degree 2n-1, error O(h^2n). Quaternion and angular
/// velocity likewise. So n nodes serve a method of order 2n; cubic Hermite of positions alone would
/// leave velocity one order behind. Bodies under constant force get their parabola instead.
class HermiteMotion {
 public:
  /// Space for `nodes` nodes of a system of `size` components; allocates.
  void resize(std::size_t nodes, std::size_t size);
  /// Forgets the nodes and begins a step at `start`.
  void begin(Instant start) {
    start_ = start;
    used_ = 0;
  }
  /// The next node, at local time s; the first must be at 0. Write y and y' to its arrays.
  struct Node {
    double* y;
    double* rate;
  };
  Node add(double s);
  /// Takes back all nodes but the first `nodes`.
  void truncate(std::size_t nodes) { used_ = nodes; }
  /// Data of a node that was added.
  [[nodiscard]] const double* y(std::size_t node) const { return &values_[2 * node * size_]; }
  [[nodiscard]] const double* rate(std::size_t node) const {
    return &values_[(2 * node + 1) * size_];
  }
  [[nodiscard]] std::size_t nodes() const { return used_; }
  [[nodiscard]] double time(std::size_t node) const { return times_[node]; }
  [[nodiscard]] Node node(std::size_t node) {
    double* const first = &values_[2 * node * size_];
    return {first, first + size_};
  }

  /// `orientations`: of the bodies that do not rotate.
  void motions(const IslandOde& ode, bool constant_acceleration,
               std::span<const Quaternion> orientations, std::span<Motion> out) const;

  void persist(Archive& archive) {
    const std::size_t size = size_;
    archive(start_, size_, used_, times_, values_);
    archive.require(size_ == size && used_ <= times_.size());
  }

 private:
  void translation(std::size_t offset, Motion& motion) const;
  void rotation(std::size_t offset, Motion& motion) const;

  Instant start_;
  std::size_t size_ = 0;
  std::size_t used_ = 0;
  std::vector<double> times_;
  std::vector<double> values_;  ///< y and y' of each node
};

}  // namespace kairos::integrators
