#pragma once

#include "core/contacts/friction_forces.hpp"
#include "core/contacts/touch.hpp"

#include <Eigen/Core>

#include <array>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace kairos {
inline namespace core {

/// Bodies that turn while they touch, at one instant.
struct TurningState {
  std::vector<GroupBody> bodies;  ///< by place in the group
  std::vector<BodyState> states;
  std::vector<Twist> loads;    ///< accelerations without contact forces
  std::vector<double> radius;  ///< how far a body reaches from its origin, m
  std::vector<Touch> touches;
  /// They pass on what touches do; null: none. `loads` are with them.
  std::shared_ptr<const GroupJoints> joints{};
  double applied = 0.0;  ///< the largest acceleration that joints took up, m/s^2
};

/// Forces are inside their cones, and what opens does not close, up to this part of the largest
/// load: roundoff of the solve.
inline constexpr double turning_roundoff = 1e-11;
/// Equations that leave more than this part of it contradict each other.
inline constexpr double turning_contradiction = 1e-9;

/// The same where equations contradict each other by so much, as rows of touches that others imply
/// do: forces do not do both. What is let go of the four corners of a face closes by what all four
/// are off, times what turning adds.
inline constexpr double allowed_where(double contradicted) {
  return turning_roundoff + 16.0 * contradicted;
}

/// Contact forces of bodies that turn: of touches that are told what they do.
///
/// The unknowns are the forces at the touches, and the equations that gaps and what sticks have no
/// acceleration (index reduction); sliding friction follows from the normal force. Where touches
/// are redundant (an edge that sticks) the forces are those of least norm; accelerations do not
/// depend on that, but where these slide in several directions.
class TurningForces {
 public:
  struct Solution {
    std::vector<Vector3> force;  ///< by touch, on b, N
    std::vector<Twist> accelerations;
    /// Largest violation of a sign or a cone, or of what opens and would close, in units of the
    /// largest load; <= 0: none.
    double violation = 0.0;
    /// Of the equations, in the same units: more than roundoff if they contradict each other.
    double residual = 0.0;
    /// Rows that the others nearly imply were left out: among redundant touches that slide
    /// accelerations depend on that, and go on so.
    bool nearly = false;

    /// What `violation` may be.
    [[nodiscard]] double allowed() const { return allowed_where(residual); }
  };

  struct Verifying {
    bool nearly = false;  ///< see `Solution`
    /// Where what opens closes by more than this, and than what is allowed, forces are not looked
    /// for, in units of the load.
    double most = std::numeric_limits<double>::infinity();
    /// Which of the rays of the cones carried the load when nearly the same was asked last: they
    /// are tried first, and what carries it now is told. Null: not known.
    std::vector<std::size_t>* carry = nullptr;
  };

  explicit TurningForces(const TurningState& state);

  [[nodiscard]] const std::vector<TouchNow>& now() const { return now_; }
  [[nodiscard]] double load() const { return load_; }
  [[nodiscard]] int solves() const { return solves_; }
  [[nodiscard]] const std::vector<Touch>& touches() const { return state_.touches; }

  /// Which forces are found of those that do the same.
  enum class Which {
    least_norm,
    nearly_least,  ///< of least norm, where rows that the others nearly imply are left out
    some_of_many,  ///< where many touch some, which is faster, else those of least norm
    some           ///< the fastest to find
  };
  /// Forces and accelerations, not verified.
  [[nodiscard]] Solution solve(std::span<const FrictionChoice> choices,
                               Which which = Which::least_norm);
  /// Whether more than two bodies are free to move.
  [[nodiscard]] bool several() const { return free_ > 2; }
  /// `which`, where several bodies are free; else those of least norm.
  [[nodiscard]] Which of_several(Which which) const {
    return several() ? which : Which::least_norm;
  }
  /// The same with its `violation`: forces within the cones are looked for where those of least
  /// norm are not.
  [[nodiscard]] Solution verified(std::span<const FrictionChoice> choices,
                                  const Verifying& options);
  /// Some forces that do what is proposed, for the accelerations.
  [[nodiscard]] Solution moved_by(std::span<const FrictionChoice> choices);
  /// Turns the directions in which touches begin to slide to where they then go, by Newton's
  /// method; false: it does not get there.
  [[nodiscard]] bool turn_to_slip(std::vector<FrictionChoice>& choices);
  /// What projected Gauss-Seidel finds likely, from what is known to slide or to stick.
  [[nodiscard]] std::vector<FrictionChoice> propose(std::span<const FrictionChoice> as_it_moves);

  /// The same from forces that were looked for at all touches at once, to the last digits: among
  /// redundant touches sweeps get there slowly. Empty: they were not found. `halvings`: see
  /// `ContactSweeps::sweep`.
  [[nodiscard]] std::vector<FrictionChoice> propose_at_once(
      std::span<const FrictionChoice> as_it_moves, int halvings);

  /// The same with no more touches than carry the load, where others are redundant: how they share
  /// it is not known, and where they slide in several directions accelerations depend on it.
  [[nodiscard]] std::vector<FrictionChoice> fewest(std::span<const FrictionChoice> choices);
  /// By how much touches that others nearly imply contradict these, in units of the load; 0 where
  /// it is more than touches that are held may.
  [[nodiscard]] double contradiction(std::span<const FrictionChoice> choices);

  /// What follows where normal forces press and hold, or do not and let go: one complementarity
  /// problem, in which what is pressed and sticks does so whatever that takes, and what slides does
  /// so without friction. Exact with none, and with infinite friction of what sticks; empty where
  /// it has no answer.
  [[nodiscard]] std::vector<FrictionChoice> complementary(std::span<const FrictionChoice> as_is);

  /// Acceleration of b along a at touch k, of the gap, and of the surfaces, m/s^2.
  [[nodiscard]] double gap_acceleration(std::size_t k, std::span<const Twist> accelerations) const;
  [[nodiscard]] Vector3 acceleration(std::size_t k, std::span<const Twist> accelerations) const;

 private:
  /// Pivots below this part of the largest one belong to rows that the others imply.
  static constexpr double implied = 1e-11;

  [[nodiscard]] static bool pushes(const FrictionChoice& c) {
    return c.does != FrictionChoice::Does::opens;
  }
  [[nodiscard]] static bool rubs(const FrictionChoice& c) {
    return c.does == FrictionChoice::Does::slides || c.does == FrictionChoice::Does::begins;
  }

  using Vector6 = Eigen::Matrix<double, 6, 1>;
  /// A unit force along `direction` at a touch.
  struct Line {
    std::size_t touch = 0;
    Vector3 direction;
    Vector6 of_a, of_b;  ///< J: what it asks of the velocities
    Vector6 to_a, to_b;  ///< M^-1 J^T: what it gives
    /// What it gives to all bodies, as joints pass it on; empty: there are none.
    Eigen::VectorXd to_all{};
  };
  [[nodiscard]] Line line(std::size_t touch, const Vector3& direction) const;
  /// Along which a touch presses: what slides along its friction as well.
  [[nodiscard]] Line pressing_line(std::size_t touch, const FrictionChoice& choice) const;
  [[nodiscard]] double coupling(const Line& asks, const Line& gives) const;
  [[nodiscard]] Eigen::MatrixXd couplings(std::span<const Line> asks,
                                          std::span<const Line> gives) const;
  /// Accelerations without contact forces, of gaps and surfaces along these, m/s^2.
  [[nodiscard]] Eigen::VectorXd loads_along(std::span<const Line> lines) const;
  void push(const Line& line, double force, std::vector<Twist>& accelerations) const;
  [[nodiscard]] double cone_violation(std::span<const FrictionChoice> choices,
                                      const Solution& found) const;
  [[nodiscard]] double closing(std::span<const FrictionChoice> choices,
                               const Solution& found) const;
  /// Rays that stand for the cones, and what a unit of each gives to the bodies.
  struct Rays {
    std::vector<Line> lines;
    Eigen::MatrixXd gives;       ///< by column, each of length 1
    std::vector<double> length;  ///< by ray, before that
    Eigen::VectorXd asked;
  };
  [[nodiscard]] Rays rays_of(std::span<const FrictionChoice> choices, const Solution& found) const;
  static void put_forces(const Rays& rays, const Eigen::VectorXd& x, Solution& found);
  [[nodiscard]] double nearest_in_cones(std::span<const FrictionChoice> choices, Solution& found,
                                        std::vector<std::size_t>* carry);
  /// Of the accelerations of these touches, the part across their directions, of the load.
  [[nodiscard]] Eigen::VectorXd aside(std::span<const FrictionChoice> choices,
                                      std::span<const std::size_t> begins);
  [[nodiscard]] FrictionChoice turned_by(std::size_t touch, const FrictionChoice& choice,
                                         double angle) const;
  [[nodiscard]] Eigen::VectorXd angles_to_slip(std::span<const FrictionChoice> choices,
                                               std::span<const std::size_t> begins,
                                               const Eigen::VectorXd& across);
  [[nodiscard]] bool held_at_edges(std::span<const FrictionChoice> choices, Solution& found,
                                   std::vector<std::size_t>* carry);
  [[nodiscard]] bool carried_as_before(std::span<const FrictionChoice> choices, Solution& found,
                                       const std::vector<std::size_t>& carry);
  void sweep(std::size_t k, const FrictionChoice& as_is, std::array<double, 3>& force,
             std::vector<Twist>& accelerations) const;

  const TurningState& state_;
  std::vector<TouchNow> now_;
  std::vector<std::array<Line, 3>> lines_;  ///< by touch: normal and two tangents
  std::vector<double> weight_;              ///< by touch: what a unit of its normal force gives
  double load_ = 0.0;
  int free_ = 0;
  int solves_ = 0;
};

}  // namespace core
}  // namespace kairos
