#include "integrators/closed_form.hpp"

#include "core/archive.hpp"
#include "core/memoryless_stepper.hpp"
#include "integrators/accelerations.hpp"
#include "integrators/constant_force.hpp"
#include "integrators/dense_output.hpp"
#include "integrators/free_top.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace kairos::integrators {
namespace {

/// How one body moves in the current step.
struct Leg {
  BodyState before;
  Vector3 acceleration = Vector3::Zero();
  bool rotates = false;
  bool tumbles = false;          ///< its angular velocity is not constant
  double bounding_radius = 0.0;  ///< m
  std::unique_ptr<FreeTop> top;  ///< null until it has tumbled: most never do

  void persist(Archive& archive) {
    archive(before, acceleration, rotates, tumbles, bounding_radius);
    FreeTop whole = top ? *top : FreeTop();
    archive(whole);
    if (archive.reading() && tumbles) {
      top = std::make_unique<FreeTop>(whole);
    }
  }
};

/// Steady: what the gyroscopic term changes is roundoff of the rate itself (about a principal
/// axis).
bool is_steady(const BodyInertia& inertia, const BodyState& state) {
  const double w = state.twist.angular.norm();
  const double change = angular_acceleration(inertia, state, Vector3::Zero()).norm();
  return change <= 16.0 * std::numeric_limits<double>::epsilon() * w * w;
}

class ClosedForm final : public MemorylessStepper {
 public:
  [[nodiscard]] StepperInfo info() const override { return closed_form_info; }
  [[nodiscard]] std::int64_t evaluations() const override { return evaluations_; }

  [[nodiscard]] std::string refuses(const Island& island) const override {
    if (!island.constant_acceleration()) {
      return "closed-form needs constant forces; this island has forces that depend on state or "
             "time";
    }
    return {};
  }

  void start(const Island& island, Instant t, std::span<const BodyState> states) override {
    legs_ = std::vector<Leg>(states.size());
    for (std::size_t i = 0; i < states.size(); ++i) {
      legs_[i].rotates = island.inertia[i].rotates;
      legs_[i].bounding_radius = island.inertia[i].bounding_radius;
    }
    restart(island, t, states);
  }

  void restart(const Island& /*island*/, Instant /*t*/,
               std::span<const BodyState> /*states*/) override {
    fresh_ = true;
  }

  [[nodiscard]] std::optional<Vector3> fall(const Vector3& force, double mass) override {
    ++evaluations_;
    return force / mass;
  }

  StepResult step(const Island& island, Instant t, double h, std::span<BodyState> states) override {
    ++evaluations_;
    if (fresh_) {
      if (const std::string_view reason = begin(island, t, states); !reason.empty()) {
        return {.advanced = 0.0, .error = 0.0, .ok = false, .reason = reason};
      }
    }
    start_ = t;
    h_ = std::min(h, longest_);
    for (std::size_t i = 0; i < states.size(); ++i) {
      Leg& leg = legs_[i];
      leg.before = states[i];
      leg.acceleration = island.constant_force[i] / island.inertia[i].mass;
      if (std::isfinite(h_)) {
        advance(leg, states[i]);
      }
    }
    return {.advanced = h_, .error = 0.0, .ok = true, .reason = {}};
  }

  void dense_output(std::span<Motion> motions) const override {
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const Leg& leg = legs_[i];
      Motion& motion = motions[i];
      motion.start = start_;
      motion.duration = h_;
      motion.error_radius = 0.0;
      parabola(motion, leg.before.pose.position, leg.before.twist.linear, leg.acceleration);
      const Quaternion& q = leg.before.pose.orientation;
      if (!leg.rotates) {
        fixed_rotation(motion, q);
      } else if (!leg.tumbles) {
        constant_rate_rotation(motion, q, leg.before.twist.angular);
      } else {
        tumble(leg, motion);
      }
    }
  }

  bool replay(const Island& island, double s, std::span<const BodyState> before,
              std::span<ReplayedStep> after) const override {
    return replay_parabola(island, s, before, after);
  }

  bool persist(Archive& archive) override {
    archive(legs_, epoch_, start_, h_, longest_, fresh_, evaluations_);
    return true;
  }

 private:
  // The constants of free rotation, from here until the next jump of the state; or why there are
  // none.
  std::string_view begin(const Island& island, Instant t, std::span<const BodyState> states) {
    epoch_ = t;
    longest_ = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < states.size(); ++i) {
      Leg& leg = legs_[i];
      leg.tumbles = leg.rotates && !is_steady(island.inertia[i], states[i]);
      if (leg.tumbles) {
        if (leg.top == nullptr) {
          leg.top = std::make_unique<FreeTop>();
        }
        *leg.top = FreeTop(island.inertia[i], states[i].pose.orientation, states[i].twist.angular);
        if (!leg.top->resolved()) {
          return "closed-form: a body turns about its middle axis but for less than doubles "
                 "resolve";
        }
        longest_ = std::min(longest_, leg.top->segment());
      }
    }
    fresh_ = false;
    return {};
  }

  void advance(const Leg& leg, BodyState& state) const {
    for (int axis = 0; axis < 3; ++axis) {
      const Coordinate<DoubleDouble> end = parabola_step<DoubleDouble>(
          state.pose.position[axis], state.twist.linear[axis], leg.acceleration[axis], h_);
      state.pose.position[axis] = end.position.rounded();
      state.twist.linear[axis] = end.velocity.rounded();
    }
    if (leg.tumbles) {
      const FreeTop::Rotation rotation = leg.top->at((start_ + h_) - epoch_);
      state.pose.orientation = rotation.orientation;
      state.twist.angular = rotation.angular_velocity;
    } else if (leg.rotates) {
      state.pose.orientation = rotate(state.twist.angular * h_, state.pose.orientation);
    }
  }

  // Two unit quaternions e apart turn a point at distance r to places at most 2 r e apart; another
  // factor of 2 normalises the polynomial; 64 eps covers the rounding of its nodes.
  void tumble(const Leg& leg, Motion& motion) const {
    leg.top->fit(start_ - epoch_, h_, motion);
    // A motion starts at the state bit for bit: the fit is moved by its roundoff, to the state's
    // side of the quaternions.
    const Vector4 q = as_vector(leg.before.pose.orientation);
    if (q.dot(motion.quaternion[0]) < 0.0) {
      for (int k = 0; k <= motion.quaternion.degree(); ++k) {
        motion.quaternion[k] = -motion.quaternion[k];
      }
    }
    motion.quaternion[0] = q;
    motion.angular_velocity[0] = leg.before.twist.angular;
    motion.error_radius = leg.bounding_radius * (4.0 * leg.top->fit_error(h_) +
                                                 64.0 * std::numeric_limits<double>::epsilon());
  }

  std::vector<Leg> legs_;
  Instant epoch_, start_;
  double h_ = 0.0;
  double longest_ = std::numeric_limits<double>::infinity();  ///< s, of a step
  bool fresh_ = true;
  std::int64_t evaluations_ = 0;
};

}  // namespace

std::unique_ptr<Stepper> make_closed_form(const StepperOptions& /*options*/) {
  return std::make_unique<ClosedForm>();
}

}  // namespace kairos::integrators
