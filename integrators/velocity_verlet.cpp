#include "integrators/velocity_verlet.hpp"

#include "integrators/accelerations.hpp"
#include "integrators/constant_force.hpp"
#include "integrators/dense_output.hpp"

#include <algorithm>
#include <vector>

namespace kairos::integrators {
namespace {

class VelocityVerlet final : public Stepper {
 public:
  [[nodiscard]] StepperInfo info() const override { return velocity_verlet_info; }
  [[nodiscard]] std::string refuses(const Island& /*island*/) const override { return {}; }
  [[nodiscard]] std::int64_t evaluations() const override { return accelerations_.evaluations(); }

  void start(const Island& island, Instant t, std::span<const BodyState> states) override {
    accelerations_.resize(states.size());
    next_.assign(states.size(), {});
    last_.assign(states.size(), {});
    for (std::size_t i = 0; i < states.size(); ++i) {
      last_[i] = {states[i], states[i], {}, {}, island.inertia[i].rotates};
    }
    start_ = t;
    h_ = 0.0;
    primed_ = false;
  }

  void restart(const Island& /*island*/, Instant /*t*/,
               std::span<const BodyState> /*states*/) override {
    primed_ = false;
  }

  StepResult step(const Island& island, Instant t, double h, std::span<BodyState> states) override {
    if (!primed_) {
      accelerations_.evaluate(island, t, states, next_);
    }
    for (std::size_t i = 0; i < states.size(); ++i) {
      last_[i].before = states[i];
      last_[i].first = next_[i];
      drift(last_[i], h, states[i]);
    }
    accelerations_.evaluate(island, t + h, states, next_);
    for (std::size_t i = 0; i < states.size(); ++i) {
      last_[i].second = next_[i];
      kick(last_[i], h, states[i]);
      last_[i].after = states[i];
    }
    primed_ = true;
    start_ = t;
    h_ = h;
    return {.advanced = h, .error = 0.0, .ok = true, .reason = {}};
  }

  void dense_output(std::span<Motion> motions) const override {
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const Record& record = last_[i];
      Motion& motion = motions[i];
      motion.start = start_;
      motion.duration = h_;
      motion.error_radius = 0.0;
      parabola(motion, record.before.pose.position, record.before.twist.linear,
               record.first.linear);
      if (record.first.linear != record.second.linear) {
        motion.velocity.resize(2);
        motion.velocity[2] = (record.second.linear - record.first.linear) / (2.0 * h_);
      }
      dense_rotation(record, motion);
    }
  }

  bool replay(const Island& island, double s, std::span<const BodyState> before,
              std::span<ReplayedStep> after) const override {
    return replay_parabola(island, s, before, after);
  }

  bool persist(Archive& archive) override {
    archive(accelerations_, next_, last_, start_, h_, primed_);
    return true;
  }

 private:
  struct Record {
    BodyState before, after;
    Acceleration first, second;  ///< at the start and at the end of the step
    bool rotates = false;

    void persist(Archive& archive) { archive(before, after, first, second, rotates); }
  };

  // Moves to the end of the step, with the velocities that the second evaluation may need.
  static void drift(const Record& record, double h, BodyState& state) {
    for (int axis = 0; axis < 3; ++axis) {
      const Coordinate<double> next = parabola_step<double>(
          state.pose.position[axis], state.twist.linear[axis], record.first.linear[axis], h);
      state.pose.position[axis] = next.position;
      state.twist.linear[axis] = next.velocity;
    }
    if (record.rotates) {
      const Vector3 middle = state.twist.angular + record.first.angular * (0.5 * h);
      state.pose.orientation = rotate(middle * h, state.pose.orientation);
      state.twist.angular += record.first.angular * h;
    }
  }

  static void kick(const Record& record, double h, BodyState& state) {
    const Twist& before = record.before.twist;
    state.twist.linear = before.linear + (record.first.linear + record.second.linear) * (0.5 * h);
    if (record.rotates) {
      state.twist.angular =
          before.angular + (record.first.angular + record.second.angular) * (0.5 * h);
    }
  }

  void dense_rotation(const Record& record, Motion& motion) const {
    const BodyState& before = record.before;
    if (!record.rotates) {
      fixed_rotation(motion, before.pose.orientation);
      return;
    }
    const Vector3& w0 = before.twist.angular;
    const Vector3& w1 = record.after.twist.angular;
    const bool steady = record.first.angular.isZero(0.0) && record.second.angular.isZero(0.0);
    // A cubic cannot follow a step that turns far: there the mid-step rate is the better guide.
    const bool coarse = std::max(w0.norm(), w1.norm()) * h_ > 1.0;
    if (steady || coarse) {
      constant_rate_rotation(motion, before.pose.orientation,
                             w0 + record.first.angular * (0.5 * h_));
    } else {
      cubic_rotation(motion, h_, before, record.after);
    }
    motion.angular_velocity.resize(2);
    motion.angular_velocity[0] = w0;
    motion.angular_velocity[1] = record.first.angular;
    motion.angular_velocity[2] = (record.second.angular - record.first.angular) / (2.0 * h_);
  }

  Accelerations accelerations_;
  std::vector<Acceleration> next_;
  std::vector<Record> last_;
  Instant start_;
  double h_ = 0.0;
  bool primed_ = false;  ///< `next_` holds the accelerations at the end of the last step
};

}  // namespace

std::unique_ptr<Stepper> make_velocity_verlet(const StepperOptions& /*options*/) {
  return std::make_unique<VelocityVerlet>();
}

}  // namespace kairos::integrators
