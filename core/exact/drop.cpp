#include "core/exact/precondition.hpp"

#include <cmath>

namespace kairos {
inline namespace core {
namespace exact {
namespace {

/// A ball over a floor under constant gravity. With gap h, speed v upwards and gravity g it meets
/// the floor first at t_1 = (v + u)/g, u = sqrt(v^2 + 2 g h), and leaves it with e^k u after the
/// k-th impact: t_k = t_1 + (2u/g) sum_{j=1}^{k-1} e^j. For e < 1 the sum ends at e/(1-e): Zeno.
class Drop : public ExactMotion {
 public:
  Drop(BodyIndex ball, const BodyState& start, double floor, double radius, double g, double e)
      : ball_(ball),
        start_(start),
        rest_height_(static_cast<long double>(floor) + radius),
        gap_(start.pose.position.y() - rest_height_),
        g_(g),
        e_(e),
        impact_speed_(std::sqrt(speed() * speed() + 2.0L * g_ * gap_)),
        first_(v_equals_zero() ? std::sqrt(2.0L * gap_ / g_) : (speed() + impact_speed_) / g_) {}

  [[nodiscard]] std::optional<double> impact_time(std::int64_t k) const override {
    return k < 1 ? std::nullopt : std::optional(static_cast<double>(time_of(k)));
  }

  [[nodiscard]] std::optional<double> rest_time() const override {
    return e_ == 1.0L ? std::nullopt : std::optional(static_cast<double>(end_of_bounces()));
  }

  [[nodiscard]] std::optional<BodyState> state(BodyIndex body, Instant t) const override {
    if (body != ball_) {
      return std::nullopt;
    }
    BodyState s = start_;
    const long double time = seconds(t);
    s.pose.position +=
        static_cast<double>(time) * Vector3(start_.twist.linear.x(), 0.0, start_.twist.linear.z());
    const auto [height, velocity] = vertical(time);
    s.pose.position.y() = static_cast<double>(rest_height_ + height);
    s.twist.linear.y() = static_cast<double>(velocity);
    return s;
  }

 private:
  struct Vertical {
    long double height;
    long double velocity;
  };

  [[nodiscard]] long double speed() const { return start_.twist.linear.y(); }
  [[nodiscard]] bool v_equals_zero() const { return speed() == 0.0L; }
  [[nodiscard]] long double flight() const { return 2.0L * impact_speed_ / g_; }
  [[nodiscard]] long double end_of_bounces() const { return first_ + flight() * e_ / (1.0L - e_); }

  [[nodiscard]] long double time_of(std::int64_t k) const {
    const auto bounces = static_cast<long double>(k - 1);
    const long double sum =
        e_ == 1.0L ? bounces : e_ * (1.0L - std::pow(e_, bounces)) / (1.0L - e_);
    return first_ + flight() * sum;
  }

  [[nodiscard]] Vertical vertical(long double time) const {
    if (time <= first_) {
      return {gap_ + (speed() - 0.5L * g_ * time) * time, speed() - g_ * time};
    }
    long double bounce = 0.0L;
    long double begun = 0.0L;
    if (e_ == 1.0L) {
      bounce = std::floor((time - first_) / flight());
      begun = first_ + bounce * flight();
    } else {
      if (time >= end_of_bounces()) {
        return {0.0L, 0.0L};
      }
      // From e^b = what is left of the geometric sum.
      const long double left = 1.0L - (time - first_) * (1.0L - e_) / (flight() * e_);
      bounce = std::max(0.0L, std::floor(std::log(left) / std::log(e_)));
      begun = time_of(static_cast<std::int64_t>(bounce) + 1);
    }
    const long double up = e_ == 1.0L ? impact_speed_ : impact_speed_ * std::pow(e_, bounce + 1.0L);
    const long double s = time - begun;
    return {(up - 0.5L * g_ * s) * s, up - g_ * s};
  }

  BodyIndex ball_;
  BodyState start_;
  long double rest_height_;
  long double gap_;
  long double g_;
  long double e_;
  long double impact_speed_;
  long double first_;
};

std::unique_ptr<const ExactMotion> solve(const Scene& scene) {
  const std::vector<BodyIndex> balls = free_bodies(scene);
  need(balls.size() == 1 && scene.bodies.size() == 2 && scene.forces.empty(), scene,
       "one free ball and one floor, and no other forces");
  const Body& ball = scene.bodies[balls.front()];
  const Body& floor = scene.bodies[1 - balls.front()];
  const auto* sphere = std::get_if<Sphere>(&ball.shape);
  need(sphere != nullptr, scene, "a sphere");
  need(is_floor(floor), scene,
       "a floor: a half-space that is a wall at rest with its normal upwards");
  const Vector3 fall = gravity(scene, ball);
  need(fall.y() < 0.0, scene, "gravity downwards");
  const double y = floor.initial.pose.position.y();
  need(ball.initial.pose.position.y() - sphere->radius >= y, scene, "a ball above the floor");
  return std::make_unique<const Drop>(balls.front(), ball.initial, y, sphere->radius, -fall.y(),
                                      scene.restitution(ball, floor));
}

double restitution(const Scene& scene) {
  return scene.bodies.size() == 2 ? scene.restitution(scene.bodies[0], scene.bodies[1]) : 1.0;
}

}  // namespace

ExactSolutionType elastic_drop() {
  return {.name = "elastic-drop",
          .summary = "a ball over a floor, restitution 1",
          .formula = "t_k = (2k-1) sqrt(2H/g) from rest at gap H",
          .source = "uniform acceleration",
          .solve = [](const Scene& scene) {
            need(restitution(scene) == 1.0, scene, "restitution 1");
            return solve(scene);
          }};
}

ExactSolutionType inelastic_drop() {
  return {.name = "inelastic-drop",
          .summary = "a ball over a floor, restitution e < 1: rests after infinitely many bounces",
          .formula = "rest at sqrt(2H/g) (1+e)/(1-e) from rest at gap H",
          .source = "uniform acceleration, a geometric sum (Zeno)",
          .solve = [](const Scene& scene) {
            need(restitution(scene) < 1.0, scene, "a restitution below 1");
            return solve(scene);
          }};
}

}  // namespace exact
}  // namespace core
}  // namespace kairos
