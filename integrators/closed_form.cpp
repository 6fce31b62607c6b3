#include "integrators/closed_form.hpp"

#include "integrators/accelerations.hpp"
#include "integrators/constant_force.hpp"
#include "integrators/dense_output.hpp"

#include <cmath>
#include <vector>

namespace kairos::integrators {
namespace {

bool is_spherical(const Vector3& moments) {
  return moments.x() == moments.y() && moments.y() == moments.z();
}

class ClosedForm final : public Stepper {
 public:
  [[nodiscard]] StepperInfo info() const override { return closed_form_info; }
  [[nodiscard]] std::int64_t evaluations() const override { return accelerations_.evaluations(); }

  [[nodiscard]] std::string refuses(const Island& island) const override {
    if (!island.constant_acceleration()) {
      return "closed-form needs constant forces; this island has forces that depend on state or "
             "time";
    }
    for (const BodyInertia& inertia : island.inertia) {
      if (inertia.rotates && !is_spherical(inertia.principal)) {
        return "closed-form turns bodies of equal principal moments of inertia only";
      }
    }
    return {};
  }

  void start(const Island& /*island*/, Instant t, std::span<const BodyState> states) override {
    accelerations_.resize(states.size());
    current_.assign(states.size(), {});
    before_.assign(states.begin(), states.end());
    rotates_.assign(states.size(), false);
    start_ = t;
    h_ = 0.0;
  }
  // Every step starts from the states alone.
  void restart(const Island& /*island*/, Instant /*t*/,
               std::span<const BodyState> /*states*/) override {}

  StepResult step(const Island& island, Instant t, double h, std::span<BodyState> states) override {
    accelerations_.evaluate(island, t, states, current_);
    for (std::size_t i = 0; i < states.size(); ++i) {
      before_[i] = states[i];
      rotates_[i] = island.inertia[i].rotates;
      if (std::isfinite(h)) {
        advance(current_[i].linear, rotates_[i], h, states[i]);
      }
    }
    start_ = t;
    h_ = h;
    return {.advanced = h, .error = 0.0, .ok = true, .reason = {}};
  }

  void dense_output(std::span<Motion> motions) const override {
    for (std::size_t i = 0; i < motions.size(); ++i) {
      Motion& motion = motions[i];
      motion.start = start_;
      motion.duration = h_;
      motion.error_radius = 0.0;
      const BodyState& before = before_[i];
      parabola(motion, before.pose.position, before.twist.linear, current_[i].linear);
      if (rotates_[i]) {
        constant_rate_rotation(motion, before.pose.orientation, before.twist.angular);
      } else {
        fixed_rotation(motion, before.pose.orientation);
      }
    }
  }

  bool replay(const Island& island, double s, std::span<const BodyState> before,
              std::span<ReplayedStep> after) const override {
    return replay_parabola(island, s, before, after);
  }

 private:
  static void advance(const Vector3& a, bool rotates, double h, BodyState& state) {
    for (int axis = 0; axis < 3; ++axis) {
      const Coordinate<DoubleDouble> end = parabola_step<DoubleDouble>(
          state.pose.position[axis], state.twist.linear[axis], a[axis], h);
      state.pose.position[axis] = end.position.rounded();
      state.twist.linear[axis] = end.velocity.rounded();
    }
    if (rotates) {
      state.pose.orientation = rotate(state.twist.angular * h, state.pose.orientation);
    }
  }

  Accelerations accelerations_;
  std::vector<Acceleration> current_;
  std::vector<BodyState> before_;
  std::vector<char> rotates_;
  Instant start_;
  double h_ = 0.0;
};

}  // namespace

std::unique_ptr<Stepper> make_closed_form(const StepperOptions& /*options*/) {
  return std::make_unique<ClosedForm>();
}

}  // namespace kairos::integrators
