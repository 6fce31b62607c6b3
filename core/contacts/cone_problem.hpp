#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace kairos {
inline namespace core {

/// What a touch moves, as a root of couplings: of two touches W is the sum, over the bodies that
/// both move, of the products of their blocks (the second transposed).
struct ConeRoot {
  std::size_t a = 0;  ///< bodies
  std::size_t b = 0;
  Eigen::Matrix<double, 3, 6> of_a = Eigen::Matrix<double, 3, 6>::Zero();  ///< 1/kg^(1/2)
  Eigen::Matrix<double, 3, 6> of_b = Eigen::Matrix<double, 3, 6>::Zero();
};

/// Impulses p at all touches at once: u = W p + q with, by touch, 0 <= u_n, 0 <= p_n, u_n p_n = 0,
/// |p_t| <= mu p_n, and p_t against u_t where that is not 0.
struct ConeProblem {
  Eigen::MatrixXd W;              ///< 3 by touch, symmetric, positive semidefinite, 1/kg
  Eigen::VectorXd q;              ///< rates without impulses, m/s: normal, then two tangents
  std::vector<double> friction;   ///< by touch, >= 0; infinite: rough
  bool holds_along = false;       ///< what is rough has u_t = 0 and any p_t, pressed or not
  std::vector<ConeRoot> roots{};  ///< of W without the compliance, by touch; empty: not known
  Eigen::VectorXd compliance{};   ///< 1/kg, on the diagonal of W; empty: none
};

/// The problem with this compliance, 1/kg, against the impulses p: what a step of the proximal
/// point algorithm solves [Rockafellar1976].
/// @param compliance  3 by touch, the same along all axes of one
[[nodiscard]] ConeProblem held_near(const ConeProblem& problem, const Eigen::VectorXd& p,
                                    const Eigen::VectorXd& compliance);

/// Impulses, and what they are off.
struct ConeImpulses {
  Eigen::VectorXd impulse;  ///< N s, 3 by touch
  double off = 0.0;         ///< m/s: of velocities, or of what impulses do alone; 0: all is kept
};

/// A problem as a function that is zero where all is kept: by touch a projection onto the cone of
/// what it would take [AlartCurnier1991]. It keeps a reference to the problem.
class ConeProjections {
 public:
  explicit ConeProjections(const ConeProblem& problem);

  /// What impulses are off, m/s, 3 by touch.
  [[nodiscard]] Eigen::VectorXd off(const Eigen::VectorXd& p) const;
  /// Newton's step from these impulses, to be taken off them; of those that are as good the
  /// shortest, as touches may be redundant. With a compliance they are not.
  [[nodiscard]] Eigen::VectorXd newton_step(const Eigen::VectorXd& p) const;
  /// Into the cones, which the nearest may miss by what it is off: what opens takes no impulse at
  /// all, and what has no friction none across.
  void make_exact(ConeImpulses& nearest) const;

  /// Friction without a bound holds along the surfaces what nothing presses. What would part
  /// without that has none from here on; whether some does.
  /// @param p         impulses, N s, with which what is rough is held along
  /// @param friction  by touch, what is left of the problem's
  [[nodiscard]] bool let_part(const Eigen::VectorXd& p, std::vector<double>& friction) const;

 private:
  enum class Does { opens, holds_along, sticks, slides };
  [[nodiscard]] Does state(std::size_t k, const Eigen::Vector3d& p, const Eigen::Vector3d& u,
                           const Eigen::Vector3d& z) const;
  /// How what a touch is off changes: with its rates, and with its impulse beside that.
  struct Slope {
    Eigen::Matrix3d rates = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d impulse = Eigen::Matrix3d::Zero();  ///< 1/kg
  };
  [[nodiscard]] std::vector<Slope> slopes(const Eigen::VectorXd& p) const;
  [[nodiscard]] Eigen::MatrixXd change(const std::vector<Slope>& slopes) const;
  [[nodiscard]] std::optional<Eigen::VectorXd> step_by_bodies(const std::vector<Slope>& slopes,
                                                              const Eigen::MatrixXd& J,
                                                              const Eigen::VectorXd& F) const;

  const ConeProblem& of_;
  std::vector<double> felt_;  ///< what an impulse does, 1/kg
};

}  // namespace core
}  // namespace kairos
