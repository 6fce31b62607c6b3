#pragma once

#include "core/contacts/cone_newton.hpp"
#include "core/contacts/contact_system.hpp"

#include <Eigen/Core>

#include <array>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace kairos {
inline namespace core {

/// Where two bodies touch, as impulses see it.
struct SweptTouch {
  std::size_t a = 0;  ///< places among the bodies
  std::size_t b = 0;
  Vector3 normal = Vector3::Zero();  ///< unit, from a to b, world frame
  Vector3 point_a = Vector3::Zero();
  Vector3 point_b = Vector3::Zero();
  double friction = 0.0;  ///< Coulomb's; infinite: rough
};

/// What impulses at touches are of.
enum class SweptFor {
  impact,       ///< at an instant
  instant,      ///< forces at an instant, as impulses of a second
  step,         ///< forces on the average of a step
  last_resort,  ///< the same; where nothing settles, rough touches hold along their surfaces
};

/// Impulses at all touches at once that push and never pull, within the cones of friction, after
/// which nothing approaches and what is pressed does not part: touch by touch, all others as they
/// are, again and again [Moreau1988, Jourdan1998]; where that hardly moves, at all touches at once
/// (`cone_at_once`). In a step over many touches it tries what follows if each goes on parting,
/// sliding or sticking as sweeps have found: one linear system. Joints pass on what touches do; a
/// touch whose normal they block is left alone.
class ContactSweeps {
 public:
  using Vector6 = Eigen::Matrix<double, 6, 1>;

  /// `joints`: of the bodies; null: none.
  ContactSweeps(std::span<const GroupBody> bodies, std::span<const SweptTouch> touches,
                std::shared_ptr<const GroupJoints> joints = nullptr);

  struct Swept {
    std::vector<Vector3> impulse;     ///< by touch, on b, N s
    std::vector<Vector6> velocities;  ///< by body: linear and angular, m/s and rad/s
    double changed = 0.0;             ///< by the last sweep, m/s
    int solves = 0;                   ///< of one touch each
  };
  /// Sweeps until one changes no velocity by more than `settled`, m/s, or there were very many.
  /// @param velocities  of the bodies without impulses
  /// @param rates  what is added to the rates, by touch: along the normal and two tangents that
  ///               `axes` tells, m/s; empty: nothing
  /// @param begin  impulses to begin with, by touch, N s; empty: none
  /// @param halvings  the most sweeps are halved so many times
  [[nodiscard]] Swept sweep(std::vector<Vector6> velocities, std::span<const Vector3> rates,
                            std::span<const Vector3> begin, double settled, bool rubs,
                            SweptFor what = SweptFor::impact, int halvings = 0) const;

  [[nodiscard]] double friction(std::size_t touch) const { return blocks_[touch].friction; }
  void set_friction(std::size_t touch, double mu) { blocks_[touch].friction = mu; }

  /// Rows: normal and tangents of a touch.
  [[nodiscard]] const Eigen::Matrix3d& axes(std::size_t touch) const { return blocks_[touch].axes; }
  /// Along these: velocity of b against a.
  [[nodiscard]] Vector3 rate(std::size_t touch, const std::vector<Vector6>& velocities) const;
  /// Adds what an impulse (or a force) at a touch does to velocities (or accelerations).
  void push(std::size_t touch, const Vector3& impulse, std::vector<Vector6>& velocities) const;
  /// What driven sides of joints do while these pass on such impulses, by touch, J.
  [[nodiscard]] double driven_work(std::span<const Vector3> impulses) const;

 private:
  using Matrix36 = Eigen::Matrix<double, 3, 6>;
  using Matrix63 = Eigen::Matrix<double, 6, 3>;
  struct Block {
    std::size_t a = 0;
    std::size_t b = 0;
    Eigen::Matrix3d axes;
    Matrix36 of_a, of_b;      ///< J
    Matrix63 to_a, to_b;      ///< M^-1 J^T
    Matrix36 root_a, root_b;  ///< J M^(-1/2)
    Matrix3 W;
    double friction = 0.0;
    /// M^-1 J^T of all bodies, as joints pass it on; empty: there are none.
    Eigen::Matrix<double, Eigen::Dynamic, 3> to_all{};
    std::array<bool, 3> blocked{};  ///< joints do, along these axes

    [[nodiscard]] bool presses() const { return !blocked[0]; }
  };
  void pass_on(std::span<const GroupBody> bodies, const SweptTouch& touch, Block& block) const;
  double sweep_once(std::span<const Vector3> rates, bool rubs, double share,
                    std::vector<Vector3>& along, std::vector<Vector6>& velocities) const;
  double settle_at_once(const std::vector<Vector6>& free, std::span<const Vector3> rates,
                        double settled, bool rubs, AtOnce way, std::vector<Vector3>& along,
                        std::vector<Vector6>& velocities) const;
  double solve_as_found(const std::vector<Vector6>& free, std::span<const Vector3> rates, bool rubs,
                        bool anew, std::vector<Vector3>& along,
                        std::vector<Vector6>& velocities) const;
  [[nodiscard]] static Matrix3 between(const Block& asks, const Block& gives);
  /// What a unit of impulses at one touch does to the rates of another, along their axes.
  [[nodiscard]] Matrix3 coupling(std::size_t asks, std::size_t gives) const;
  [[nodiscard]] Vector3 rate_of(std::size_t touch, const std::vector<Vector6>& velocities,
                                std::span<const Vector3> rates) const;
  void push_all(std::span<const Vector3> along, std::vector<Vector6>& velocities) const;
  static void push_along(const Block& block, const Vector3& impulse, std::vector<Vector6>& v);

  std::vector<Block> blocks_;
  std::shared_ptr<const GroupJoints> joints_;
};

/// Linear and angular, as sweeps take them.
[[nodiscard]] inline ContactSweeps::Vector6 stacked(const Twist& v) {
  return (ContactSweeps::Vector6() << v.linear, v.angular).finished();
}

}  // namespace core
}  // namespace kairos
