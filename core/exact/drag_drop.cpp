#include "core/exact/precondition.hpp"
#include "core/forces/drag.hpp"

#include <cmath>

namespace kairos {
inline namespace core {
namespace exact {
namespace {

/// A ball that falls from rest onto a floor and bounces there, through air at rest whose drag grows
/// with the square of its speed. With u = sqrt(m g/k), k = rho Cd A/2, the speed at which drag
/// carries it: falling for s from rest it has fallen u^2/g ln cosh(g s/u) at speed u tanh(g s/u);
/// thrown up at v it rises u^2/(2g) ln(1 + v^2/u^2) in u/g atan(v/u) [Timmerman1999].
class DragDrop : public ExactMotion {
 public:
  DragDrop(BodyIndex ball, const BodyState& start, long double gap, long double g, long double u,
           long double e)
      : ball_(ball), start_(start), gap_(gap), g_(g), u_(u), e_(e) {}

  [[nodiscard]] std::optional<double> impact_time(std::int64_t k) const override {
    if (k < 1 || k > most_bounces) {
      return std::nullopt;
    }
    Bounce bounce = first();
    for (std::int64_t i = 1; i < k; ++i) {
      bounce = next(bounce);
    }
    return static_cast<double>(bounce.time);
  }

  [[nodiscard]] std::optional<BodyState> state(BodyIndex body, Instant t) const override {
    const long double time = seconds(t);
    Bounce bounce = first();
    if (body != ball_) {
      return std::nullopt;
    }
    if (time <= bounce.time) {
      return at(gap_ - fallen(time), -u_ * std::tanh(g_ * time / u_));
    }
    for (std::int64_t k = 1; k < most_bounces; ++k) {
      const Bounce then = next(bounce);
      if (time <= then.time) {
        return in_flight(bounce, time - bounce.time);
      }
      bounce = then;
    }
    return std::nullopt;  // too near to rest to be told by counting
  }

 private:
  static constexpr std::int64_t most_bounces = 10000;
  struct Bounce {
    long double time;   ///< s
    long double speed;  ///< at which it meets the floor, m/s
  };

  [[nodiscard]] long double fallen(long double s) const {
    return u_ * u_ / g_ * std::log(std::cosh(g_ * s / u_));
  }
  /// From rest at this height: how long it falls, and at which speed it arrives.
  [[nodiscard]] Bounce fall(long double height) const {
    const long double decay = std::exp(-2.0L * g_ * height / (u_ * u_));
    return {u_ / g_ * std::acosh(std::exp(g_ * height / (u_ * u_))), u_ * std::sqrt(1.0L - decay)};
  }
  [[nodiscard]] long double apex(long double speed) const {
    return u_ * u_ / (2.0L * g_) * std::log1p(speed * speed / (u_ * u_));
  }
  [[nodiscard]] long double rise_time(long double speed) const {
    return u_ / g_ * std::atan(speed / u_);
  }
  [[nodiscard]] Bounce first() const { return fall(gap_); }
  [[nodiscard]] Bounce next(const Bounce& b) const {
    const Bounce down = fall(apex(e_ * b.speed));
    return {b.time + rise_time(e_ * b.speed) + down.time, down.speed};
  }

  /// `s` after a bounce.
  [[nodiscard]] BodyState in_flight(const Bounce& b, long double s) const {
    const long double speed = e_ * b.speed;
    const long double top = rise_time(speed);
    if (s >= top) {
      return at(apex(speed) - fallen(s - top), -u_ * std::tanh(g_ * (s - top) / u_));
    }
    const long double v = u_ * std::tan(g_ * (top - s) / u_);
    return at(apex(speed) - apex(v), v);
  }
  [[nodiscard]] BodyState at(long double height, long double velocity) const {
    BodyState s = start_;
    s.pose.position.y() = static_cast<double>(start_.pose.position.y() - gap_ + height);
    s.twist.linear.y() = static_cast<double>(velocity);
    return s;
  }

  BodyIndex ball_;
  BodyState start_;
  long double gap_;  ///< m
  long double g_;    ///< m/s^2
  long double u_;    ///< terminal speed, m/s
  long double e_;
};

std::unique_ptr<const ExactMotion> solve(const Scene& scene) {
  const std::vector<BodyIndex> balls = free_bodies(scene);
  need(balls.size() == 1 && scene.bodies.size() == 2 && scene.forces.size() == 1, scene,
       "one free ball, one floor and one force");
  const Body& ball = scene.bodies[balls.front()];
  const Body& floor = scene.bodies[1 - balls.front()];
  const auto* drag = dynamic_cast<const QuadraticDrag*>(scene.forces.front().force.get());
  need(drag != nullptr && drag->coefficient() > 0.0 && drag->wind().isZero(0.0), scene,
       "quadratic drag in still air");
  const auto* sphere = std::get_if<Sphere>(&ball.shape);
  need(sphere != nullptr && is_floor(floor), scene,
       "a sphere and a floor: a half-space that is a wall at rest with its normal upwards");
  const Vector3 fall = gravity(scene, ball);
  need(fall.y() < 0.0 && ball.initial.twist.linear.isZero(0.0), scene,
       "gravity downwards and a ball that starts at rest");
  const long double gap = static_cast<long double>(ball.initial.pose.position.y()) -
                          sphere->radius - floor.initial.pose.position.y();
  need(gap >= 0.0L, scene, "a ball above the floor");
  const long double g = -fall.y();
  const long double u = std::sqrt(ball.mass * g / drag->coefficient());
  return std::make_unique<const DragDrop>(balls.front(), ball.initial, gap, g, u,
                                          scene.restitution(ball, floor));
}

}  // namespace

ExactSolutionType drag_drop() {
  return {.name = "drag-drop",
          .summary = "a ball falls on a floor through air with quadratic drag",
          .formula = "t_1 = u/g acosh(exp(g H/u^2)), u = sqrt(m g/k), k = rho Cd A/2",
          .source = "Timmerman1999",
          .solve = solve};
}

}  // namespace exact
}  // namespace core
}  // namespace kairos
