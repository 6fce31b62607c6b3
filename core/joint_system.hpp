#pragma once

#include "core/drive.hpp"
#include "core/force.hpp"
#include "core/joint.hpp"

#include <Eigen/Core>

#include <memory>
#include <span>
#include <vector>

namespace kairos {
inline namespace core {

/// The joints of an island: its states have to stay on r(x) = 0.
///
/// Everything comes down to one matrix W = J M^-1 J^T and W l = b: forces (index-reduced, so that
/// r'' = 0), impulses (r' = 0), displacements (r = 0, Newton in the mass metric). W is scaled to a
/// unit diagonal; where joints depend on each other (a loop), its rank is revealed by a complete
/// orthogonal decomposition, and l is that of least norm. Const and shared between threads.
class JointSystem {
 public:
  static constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

  /// A side of a joint as the island sees it.
  struct Side {
    std::size_t place = nowhere;         ///< in the island; `nowhere`: not free
    Pose pose;                           ///< of what never moves
    std::shared_ptr<const Drive> drive;  ///< of what is driven
  };
  struct Placed {
    Joint joint;
    Side a;
    Side b;
  };
  JointSystem(std::vector<Placed> joints, std::vector<BodyInertia> inertia);

  [[nodiscard]] std::size_t rows() const { return row_count_; }
  /// A length of the mechanism, m: what residuals are compared with.
  [[nodiscard]] double size() const { return size_; }
  [[nodiscard]] bool driven() const { return driven_; }
  /// Rows that are independent of each other there.
  [[nodiscard]] std::size_t rank(Instant t, std::span<const BodyState> states) const;

  /// Largest |r|, m; of rows that only turn times the size.
  [[nodiscard]] double residual(Instant t, std::span<const BodyState> states) const;
  /// Largest |r'|, m/s; of rows that only turn times the size.
  [[nodiscard]] double residual_rate(Instant t, std::span<const BodyState> states) const;
  /// Whether they are at a dead centre: rows depend on each other only here, as those of what is
  /// stretched straight between two points, and the motion that is there, or that these wrenches
  /// (of all other forces) begin from rest, is allowed in first order and forbidden in second, by a
  /// self-stress that does work on it [ConnellyWhiteley1996]. Driven sides are not asked.
  [[nodiscard]] bool is_stuck(Instant t, std::span<const BodyState> states,
                              std::span<const Wrench> wrenches) const;
  /// Adds the forces of the joints to `wrenches`, which hold all others.
  void add_forces(Instant t, std::span<const BodyState> states, std::span<Wrench> wrenches) const;
  /// Power of driven sides while their joints carry such wrenches (joints not included), W.
  [[nodiscard]] double driven_power(Instant t, std::span<const BodyState> states,
                                    std::span<const Wrench> wrenches) const;
  /// Positions back to r = 0 to roundoff, nearest as the masses measure; `forces`: the constant
  /// ones, for the books.
  JointProjection project_positions(Instant t, std::span<BodyState> states,
                                    std::span<const Vector3> forces) const;
  /// Velocities back to r' = 0.
  JointProjection project_velocities(Instant t, std::span<BodyState> states) const;

  /// r and r' of every row, for steppers that solve the constraints; `rows` each.
  void residuals(Instant t, std::span<const BodyState> states, std::span<double> r,
                 std::span<double> rates) const;
  /// Adds J^T x to the wrenches, x one number per row.
  void react(Instant t, std::span<const BodyState> states, std::span<const double> x,
             std::span<Wrench> wrenches) const;
  /// The x of the joints (one number per row) where `wrenches` are all other forces.
  void multipliers(Instant t, std::span<const BodyState> states, std::span<const Wrench> wrenches,
                   std::span<double> x) const;

  /// What `pass_on` makes of changes of velocity: six numbers for each body, its linear part first.
  struct Passing {
    Eigen::MatrixXd leaves;  ///< times the changes: those that are left
    Eigen::VectorXd driven;  ///< times the changes: work of driven sides, J; empty: there are none
  };
  [[nodiscard]] Passing passing(Instant t, std::span<const BodyState> states) const;

  /// Changes of velocity by impulses, one per body: replaces those without joints by those that are
  /// left when the joints have passed the impulses on. Returns the work of driven sides, J.
  double pass_on(Instant t, std::span<const BodyState> states, std::span<Twist> changes) const;

 private:
  struct Workspace;
  static Workspace& workspace();
  double pass_on(std::span<Twist> changes, Workspace& work) const;
  void pass_on_all(Eigen::Index n, Eigen::VectorXd& driven, Workspace& work) const;
  void evaluate(Instant t, std::span<const BodyState> states, Workspace& work) const;
  void factor(std::span<const BodyState> states, Workspace& work) const;
  [[nodiscard]] double tolerance(std::span<const BodyState> states) const;
  /// b = r'' of the applied wrenches, solved for the forces; in `work.x`.
  void solve_forces(Instant t, std::span<const BodyState> states, std::span<const Wrench> wrenches,
                    Workspace& work) const;

  std::vector<Placed> joints_;
  std::vector<BodyInertia> inertia_;
  std::size_t row_count_ = 0;
  double size_ = 0.0;
  bool driven_ = false;
};

/// The forces of joints, as the last force of an island: they see what all others do.
class JointForce final : public Force {
 public:
  explicit JointForce(std::shared_ptr<const JointSystem> joints) : joints_(std::move(joints)) {}
  void add(Instant t, std::span<const BodyState> bodies,
           std::span<Wrench> wrenches) const override {
    joints_->add_forces(t, bodies, wrenches);
  }
  /// They do no work on the island; what driven sides do through them is booked by its own formula.
  [[nodiscard]] double potential(Instant, std::span<const BodyState>) const override { return 0.0; }
  [[nodiscard]] bool conservative() const override { return true; }
  [[nodiscard]] std::string description() const override { return "joints"; }
  [[nodiscard]] const JointSystem& joints() const { return *joints_; }

 private:
  std::shared_ptr<const JointSystem> joints_;
};

}  // namespace core
}  // namespace kairos
