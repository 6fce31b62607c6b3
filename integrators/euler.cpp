#include "integrators/euler.hpp"

#include "integrators/accelerations.hpp"
#include "integrators/constant_force.hpp"
#include "integrators/dense_output.hpp"

#include <vector>

namespace kairos::integrators {
namespace {

enum class Variant { thesis, current, symplectic };

template <Variant variant>
constexpr const StepperInfo& info_of() {
  if constexpr (variant == Variant::thesis) {
    return thesis_euler_info;
  } else if constexpr (variant == Variant::current) {
    return explicit_euler_info;
  } else {
    return symplectic_euler_info;
  }
}

template <Variant variant>
class Euler final : public Stepper {
 public:
  [[nodiscard]] StepperInfo info() const override { return info_of<variant>(); }
  [[nodiscard]] std::string refuses(const Island& /*island*/) const override { return {}; }
  [[nodiscard]] std::int64_t evaluations() const override { return accelerations_.evaluations(); }

  void start(const Island& island, Instant t, std::span<const BodyState> states) override {
    accelerations_.resize(states.size());
    fresh_.assign(states.size(), {});
    memory_.assign(states.size(), {});
    last_.assign(states.size(), {});
    for (std::size_t i = 0; i < states.size(); ++i) {
      last_[i] = {states[i], states[i].twist, {}, island.inertia[i].rotates};
    }
    start_ = t;
    h_ = 0.0;
  }

  // Nothing to forget: the thesis never resets its acceleration, the others have no memory.
  void restart(const Island& /*island*/, Instant /*t*/,
               std::span<const BodyState> /*states*/) override {}

  StepResult step(const Island& island, Instant t, double h, std::span<BodyState> states) override {
    accelerations_.evaluate(island, t, states, fresh_);
    for (std::size_t i = 0; i < states.size(); ++i) {
      Record& record = last_[i];
      record.before = states[i];
      record.used = variant == Variant::thesis ? memory_[i] : fresh_[i];
      advance_translation(record.used.linear, h, states[i]);
      if (record.rotates) {
        advance_rotation(record.used.angular, h, states[i]);
      }
      record.after_twist = states[i].twist;
      if constexpr (variant == Variant::thesis) {
        memory_[i] = fresh_[i];
      }
    }
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
      const BodyState& before = record.before;
      const Vector3& slope =
          variant == Variant::symplectic ? record.after_twist.linear : before.twist.linear;
      straight_line(motion, before.pose.position, slope, before.twist.linear, record.used.linear);
      if (record.rotates) {
        dense_rotation(record, motion);
      } else {
        fixed_rotation(motion, before.pose.orientation);
      }
    }
  }

  bool replay(const Island& island, double s, std::span<const BodyState> before,
              std::span<ReplayedStep> after) const override {
    if (!island.constant_acceleration()) {
      return false;
    }
    for (std::size_t i = 0; i < before.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        const DoubleDouble a = exact_acceleration(
            island.constant_force[i][axis], island.inertia[i].mass, last_[i].used.linear[axis]);
        const DoubleDouble p = before[i].pose.position[axis];
        const DoubleDouble v = before[i].twist.linear[axis];
        if constexpr (variant == Variant::symplectic) {
          store(symplectic_step<DoubleDouble>(p, v, v + a * DoubleDouble(h_), a, s), axis,
                after[i]);
        } else {
          store(euler_step<DoubleDouble>(p, v, a, s), axis, after[i]);
        }
      }
    }
    return true;
  }

  bool persist(Archive& archive) override {
    archive(accelerations_, memory_, last_, start_, h_);
    return true;
  }

 private:
  struct Record {
    BodyState before;
    Twist after_twist;
    Acceleration used;
    bool rotates = false;

    void persist(Archive& archive) { archive(before, after_twist, used, rotates); }
  };

  static void advance_translation(const Vector3& a, double h, BodyState& state) {
    for (int axis = 0; axis < 3; ++axis) {
      double& p = state.pose.position[axis];
      double& v = state.twist.linear[axis];
      const Coordinate<double> next =
          variant == Variant::symplectic
              ? symplectic_step<double>(p, v, v + a[axis] * h, a[axis], h)
              : euler_step<double>(p, v, a[axis], h);
      p = next.position;
      v = next.velocity;
    }
  }

  static void advance_rotation(const Vector3& a, double h, BodyState& state) {
    const Vector3 before = state.twist.angular;
    state.twist.angular += a * h;
    const Vector3& w = variant == Variant::symplectic ? state.twist.angular : before;
    state.pose.orientation = rotate(w * h, state.pose.orientation);
  }

  void dense_rotation(const Record& record, Motion& motion) const {
    const Vector3& w =
        variant == Variant::symplectic ? record.after_twist.angular : record.before.twist.angular;
    constant_rate_rotation(motion, record.before.pose.orientation, w);
    motion.angular_velocity.resize(1);
    motion.angular_velocity[0] = record.before.twist.angular;
    motion.angular_velocity[1] = record.used.angular;
  }

  Accelerations accelerations_;
  std::vector<Acceleration> fresh_;
  std::vector<Acceleration> memory_;  ///< the thesis' lagged accelerations
  std::vector<Record> last_;
  Instant start_;
  double h_ = 0.0;
};

}  // namespace

std::unique_ptr<Stepper> make_thesis_euler(const StepperOptions& /*options*/) {
  return std::make_unique<Euler<Variant::thesis>>();
}
std::unique_ptr<Stepper> make_explicit_euler(const StepperOptions& /*options*/) {
  return std::make_unique<Euler<Variant::current>>();
}
std::unique_ptr<Stepper> make_symplectic_euler(const StepperOptions& /*options*/) {
  return std::make_unique<Euler<Variant::symplectic>>();
}

}  // namespace kairos::integrators
