#include "core/contacts/turning_books.hpp"

#include "core/power_nodes.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <tuple>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

using Does = FrictionChoice::Does;

class Books {
 public:
  Books(TurningWay& way, TurningStep& step) : way_(way), step_(step) {}

  /// Power of the contact forces at 8 nodes, and the polynomials through it, integrated.
  void book() {
    constexpr int nodes = PowerNodes::count;
    Eigen::MatrixXd of_body =
        Eigen::MatrixXd::Zero(nodes, static_cast<Eigen::Index>(way_.group.bodies.size()));
    Eigen::MatrixXd leaks = of_body;
    Eigen::MatrixXd of_driver = of_body;
    Eigen::MatrixXd of_pair = Eigen::MatrixXd::Zero(nodes, body_pairs());
    Eigen::MatrixXd of_belt = of_pair;
    Eigen::MatrixXd of_surface = of_pair;
    for (int j = 0; j < nodes; ++j) {
      power_at(PowerNodes::at(j) * step_.duration, of_body.row(j), of_pair.row(j), of_belt.row(j),
               of_surface.row(j), leaks.row(j), of_driver.row(j));
    }
    const auto integrated = [&](const Eigen::VectorXd& powers) {
      return PowerNodes::work(powers, step_.duration);
    };
    for (Eigen::Index i = 0; i < of_body.cols(); ++i) {
      step_.worked.push_back(integrated(of_body.col(i)));
    }
    for (Eigen::Index p = 0; p < of_pair.cols(); ++p) {
      step_.rubbed.push_back(integrated(of_pair.col(p)));
      for (const auto& [powers_of, axis] : {std::pair{&of_belt, 1}, {&of_surface, 2}}) {
        if (!powers_of->col(p).isZero(0.0)) {
          const Polynomial<3> work = integrated(powers_of->col(p));
          for (int k = 0; k <= work.degree(); ++k) {
            step_.rubbed.back()[k][axis] = work[k].x();
          }
        }
      }
    }
    for (Eigen::Index i = 0; i < of_body.cols(); ++i) {
      step_.leaked.push_back(integrated(leaks.col(i)));
      step_.driven.push_back(of_driver.col(i).isZero(0.0) ? Polynomial<3>()
                                                          : integrated(of_driver.col(i)));
    }
    if (way_.free.size() == 1) {
      leak_of_one();
    }
  }

 private:
  /// How many pairs of bodies touch.
  [[nodiscard]] Eigen::Index body_pairs() const {
    std::size_t count = 0;
    for (const TurningPair& pair : way_.group.pairs) {
      count = std::max(count, pair.of + 1);
    }
    return static_cast<Eigen::Index>(count);
  }

  /// Of one free body: the difference of what is told, so that it closes the ledger to the last
  /// bit.
  void leak_of_one() {
    Polynomial<3>& leaked = step_.leaked[way_.free[0]];
    leaked = step_.worked[way_.free[0]];
    for (const auto& work : step_.rubbed) {
      for (int k = 0; k <= work.degree(); ++k) {
        leaked[k].x() -= work[k].sum();
      }
    }
  }

  template <typename Bodies, typename Pairs>
  void power_at(double s, Bodies of_body, Pairs of_pair, Pairs of_belt, Pairs of_surface,
                Bodies leaks, Bodies of_driver) {
    const TurningState state = way_.mode.implicit ? way_.touching_at(s) : way_.at(s);
    const std::vector<TouchNow> touches = touches_of(state);
    const auto choices = directed(way_.mode, touches, way_.slow);
    // Of forces that are redundant those inside their cones rub.
    const std::vector<Vector3> force =
        way_.mode.implicit
            ? carried_forces(way_.group, way_.mode, touches)
            : TurningForces(state)
                  .verified(choices, {.nearly = way_.mode.forces.nearly, .carry = &way_.carry})
                  .force;
    for (std::size_t k = 0; k < state.touches.size(); ++k) {
      const Touch& touch = state.touches[k];
      const TouchNow& now = touches[k];
      const auto power = [&](std::size_t i, const Vector3& point) {
        const BodyState& at = state.states[i];
        return force[k].dot(at.twist.at(point, at.pose.position));
      };
      const double on_a = -power(touch.a, now.point_a);
      const double on_b = power(touch.b, now.point_b);
      for (const auto& [i, on] : {std::pair{touch.a, on_a}, {touch.b, on_b}}) {
        if (!(way_.group.inertia[i].mass > 0.0)) {
          of_surface[static_cast<Eigen::Index>(touch.pair)] -= on;
        }
      }
      of_body[static_cast<Eigen::Index>(touch.a)] += on_a;
      of_body[static_cast<Eigen::Index>(touch.b)] += on_b;
      double rubbed = 0.0;
      double carried = 0.0;
      if (!touch.belt.isZero(0.0)) {
        const Vector3 along = force[k] - now.normal * now.normal.dot(force[k]);
        carried = -along.dot(touch.belt);
        of_belt[static_cast<Eigen::Index>(touch.pair)] += carried;
      }
      const bool slides = choices[k].does == Does::slides || choices[k].does == Does::begins;
      // What sticks at the end of an implicit step may have slid in it.
      const bool may_slide = way_.mode.implicit && choices[k].does != Does::opens;
      if (may_slide || (slides && !choices[k].direction.isZero(0.0))) {
        const Vector3 along = force[k] - now.normal * now.normal.dot(force[k]);
        rubbed = std::min(along.dot(now.velocity), 0.0);
      }
      of_pair[static_cast<Eigen::Index>(touch.pair)] += rubbed;
      const std::size_t first = way_.group.inertia[touch.a].mass > 0.0 ? touch.a : touch.b;
      leaks[static_cast<Eigen::Index>(first)] += on_a + on_b - (rubbed + carried);
    }
    const auto joints = way_.mode.implicit && drives_joints()
                            ? group_joints(way_.group.mechanisms, way_.t + s, state.states)
                            : state.joints;
    if (joints != nullptr && joints->driven()) {
      const Eigen::VectorXd power = joints->driven_work(given(state, touches, force));
      for (Eigen::Index m = 0; m < power.size(); ++m) {
        of_driver[static_cast<Eigen::Index>(joints->first_of(static_cast<std::size_t>(m)))] +=
            power[m];
      }
    }
  }

  [[nodiscard]] bool drives_joints() const {
    return std::any_of(
        way_.group.mechanisms.begin(), way_.group.mechanisms.end(),
        [](const GroupMechanism& m) { return m.joints != nullptr && m.joints->driven(); });
  }

  /// What contact forces give to the bodies, six numbers for each, as if there were no joints.
  static Eigen::VectorXd given(const TurningState& state, const std::vector<TouchNow>& touches,
                               const std::vector<Vector3>& force) {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(6 * state.bodies.size()));
    for (std::size_t k = 0; k < state.touches.size(); ++k) {
      const Touch& touch = state.touches[k];
      const TouchNow& now = touches[k];
      for (const auto& [i, point, sign] :
           {std::tuple{touch.a, now.point_a, -1.0}, {touch.b, now.point_b, 1.0}}) {
        const GroupBody& body = state.bodies[i];
        const Vector3 on = sign * force[k];
        const auto at = static_cast<Eigen::Index>(6 * i);
        out.segment<3>(at) += body.inverse_mass * on;
        out.segment<3>(at + 3) += body.inverse_inertia * (point - body.position).cross(on);
      }
    }
    return out;
  }

  TurningWay& way_;
  TurningStep& step_;
};

}  // namespace

void book_turning_step(TurningWay& way, TurningStep& step) { Books(way, step).book(); }

}  // namespace core
}  // namespace kairos
