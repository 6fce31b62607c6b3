#include "core/joints/constrained_stepper.hpp"

#include "core/archive.hpp"
#include "core/circular.hpp"
#include "core/joint_system.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace kairos {
inline namespace core {
namespace {

/// A stand-in for joint forces: they depend on velocities, and have no potential.
class VelocityForce final : public Force {
 public:
  void add(Instant, std::span<const BodyState>, std::span<Wrench>) const override {}
  [[nodiscard]] double potential(Instant, std::span<const BodyState>) const override { return 0.0; }
  [[nodiscard]] bool conservative() const override { return false; }
  [[nodiscard]] std::string description() const override { return "the force of a joint"; }
};

/// Adds the cubic that has these values and slopes at 0 and h.
template <int Dim>
void bend(Polynomial<Dim>& p, double h, const typename Polynomial<Dim>::Value& d0,
          const typename Polynomial<Dim>::Value& r0, const typename Polynomial<Dim>::Value& d1,
          const typename Polynomial<Dim>::Value& r1) {
  if (d0.isZero(0.0) && r0.isZero(0.0) && d1.isZero(0.0) && r1.isZero(0.0)) {
    return;
  }
  p.resize(std::max(p.degree(), 3));
  p[0] += d0;
  p[1] += r0;
  p[2] += (3.0 * (d1 - d0) / h - 2.0 * r0 - r1) / h;
  p[3] += (2.0 * (d0 - d1) / h + r0 + r1) / (h * h);
}

/// Adds the straight line that has these values at 0 and h.
void tilt(Polynomial<3>& p, double h, const Vector3& d0, const Vector3& d1) {
  if (d0.isZero(0.0) && d1.isZero(0.0)) {
    return;
  }
  p.resize(std::max(p.degree(), 1));
  p[0] += d0;
  p[1] += (d1 - d0) / h;
}

Vector4 as_vector(const Quaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }

/// From the quaternion of a motion (of any length) to an orientation: nearest of its multiples.
Vector4 correction(const Vector4& from, const Quaternion& to) {
  const Vector4 target = as_vector(to);
  const double length = from.norm();
  return (from.dot(target) < 0.0 ? -length : length) * target - from;
}

Vector3 rotation_between(const Quaternion& from, const Quaternion& to) {
  Quaternion turn = to * from.conjugate();
  if (turn.w() < 0.0) {
    turn.coeffs() = -turn.coeffs();
  }
  const double sine = turn.vec().norm();
  return sine > 0.0 ? Vector3(2.0 * arc_tangent(sine, turn.w()) / sine * turn.vec())
                    : Vector3(Vector3::Zero());
}

class ConstrainedStepper final : public Stepper {
 public:
  ConstrainedStepper(std::unique_ptr<Stepper> inner, double most_drift)
      : inner_(std::move(inner)), most_drift_(most_drift) {}

  [[nodiscard]] StepperInfo info() const override { return inner_->info(); }
  [[nodiscard]] std::string refuses(const Island& island) const override {
    static const VelocityForce velocity_force;
    Island probe = island;
    probe.forces.push_back(&velocity_force);
    return inner_->refuses(probe);
  }
  [[nodiscard]] std::int64_t evaluations() const override { return inner_->evaluations(); }

  void start(const Island& island, Instant t, std::span<const BodyState> states) override {
    begin_at(states);
    inner_->start(island, t, states);
  }
  void restart(const Island& island, Instant t, std::span<const BodyState> states) override {
    begin_at(states);
    inner_->restart(island, t, states);
  }

  StepResult step(const Island& island, Instant t, double h, std::span<BodyState> states) override {
    if (anew_) {
      own_.assign(states.begin(), states.end());
      inner_->restart(island, t, own_);
      anew_ = false;
    }
    before_.assign(states.begin(), states.end());
    StepResult result = inner_->step(island, t, h, own_);
    if (!result.ok) {
      return result;
    }
    h_ = result.advanced;
    std::copy(own_.begin(), own_.end(), states.begin());
    const JointSystem& joints = *island.joints;
    const Instant end = t + h_;
    const double drift = joints.residual(end, states);
    if (drift > joints.size()) {
      result.ok = false;
      result.reason =
          "a step ends farther off the joints than they are long; a shorter step may help";
      return result;
    }
    const JointProjection positions = joints.project_positions(end, states, island.constant_force);
    if (!positions.converged) {
      result.ok = false;
      result.reason = "the joints fit no position within reach; a shorter step may help";
      return result;
    }
    const JointProjection velocities = joints.project_velocities(end, states);
    result.projection = {velocities.velocity, velocities.driven, positions.position, true};
    after_.assign(states.begin(), states.end());
    anew_ = !info().variable_order || drift > most_drift_ * joints.size();
    return result;
  }

  void dense_output(std::span<Motion> motions) const override {
    inner_->dense_output(motions);
    for (std::size_t k = 0; k < motions.size(); ++k) {
      bend_to_states(motions[k], before_[k], after_[k]);
    }
  }

  bool persist(Archive& archive) override {
    archive(own_, before_, after_, h_, anew_);
    return inner_->persist(archive);
  }

 private:
  void begin_at(std::span<const BodyState> states) {
    own_.assign(states.begin(), states.end());
    before_ = after_ = own_;
    anew_ = false;
  }

  /// A motion that begins and ends nearly where it should, to where it should.
  void bend_to_states(Motion& motion, const BodyState& before, const BodyState& after) const {
    const double h = h_;
    const Vector3 v0 = before.twist.linear - motion.velocity[0];
    const Vector3 v1 = after.twist.linear - motion.velocity(h);
    bend<3>(motion.position, h, before.pose.position - motion.position[0], v0,
            after.pose.position - motion.position(h), v1);
    motion.position[0] = before.pose.position;
    tilt(motion.velocity, h, v0, v1);
    if (motion.rotation == RotationKind::fixed) {
      return;
    }
    tilt(motion.angular_velocity, h, before.twist.angular - motion.angular_velocity[0],
         after.twist.angular - motion.angular_velocity(h));
    if (motion.rotation == RotationKind::constant_rate) {
      motion.quaternion[0] = as_vector(before.pose.orientation);
      motion.rotation_rate = rotation_between(before.pose.orientation, after.pose.orientation) / h;
      return;
    }
    const Vector4 none = Vector4::Zero();
    bend<4>(motion.quaternion, h, correction(motion.quaternion[0], before.pose.orientation), none,
            correction(motion.quaternion(h), after.pose.orientation), none);
  }

  std::unique_ptr<Stepper> inner_;
  double most_drift_;              ///< of a multistep method's own states, relative to the size
  std::vector<BodyState> own_;     ///< of the stepper, not put back
  std::vector<BodyState> before_;  ///< of the last step, as they are told
  std::vector<BodyState> after_;
  double h_ = 0.0;
  bool anew_ = false;  ///< the stepper begins at what is told with the next step
};

}  // namespace

std::unique_ptr<Stepper> make_constrained(std::unique_ptr<Stepper> stepper, const Island& island,
                                          double most_drift) {
  if (island.joints == nullptr || stepper == nullptr || stepper->holds_joints()) {
    return stepper;
  }
  return std::make_unique<ConstrainedStepper>(std::move(stepper), most_drift);
}

}  // namespace core
}  // namespace kairos
