#include "core/exact/precondition.hpp"
#include "core/forces/spring.hpp"

#include <cmath>

namespace kairos {
inline namespace core {
namespace exact {
namespace {

/// A ball on a spring of length 0, with or without a wall that it hits elastically. About the
/// equilibrium each coordinate swings as cos(w t); along the wall's normal the phase runs from
/// -c to c, cos c = (distance of the wall)/(amplitude), and starts again at each impact.
class Oscillator : public ExactMotion {
 public:
  struct Wall {
    Vector3 normal;
    long double distance;  ///< of the touching ball's centre from the equilibrium, along it, m
  };
  Oscillator(BodyIndex ball, const BodyState& start, const Vector3& equilibrium, long double rate,
             const std::optional<Wall>& wall)
      : ball_(ball), start_(start), equilibrium_(equilibrium), rate_(rate), wall_(wall) {
    if (wall) {
      const long double u = wall->normal.dot(start.pose.position - equilibrium);
      const long double v = wall->normal.dot(start.twist.linear) / rate;
      amplitude_ = std::hypot(u, v);
      phase_ = std::atan2(-v, u);
      turn_ = amplitude_ > std::abs(wall->distance) ? std::acos(wall->distance / amplitude_) : 0.0L;
    }
  }

  [[nodiscard]] std::optional<double> impact_time(std::int64_t k) const override {
    if (k < 1 || turn_ == 0.0L) {
      return std::nullopt;
    }
    const auto later = static_cast<long double>(k - 1);
    return static_cast<double>((turn_ - phase_ + 2.0L * turn_ * later) / rate_);
  }

  [[nodiscard]] std::optional<BodyState> state(BodyIndex body, Instant t) const override {
    if (body != ball_) {
      return std::nullopt;
    }
    const long double angle = rate_ * seconds(t);
    BodyState s = start_;
    for (int axis = 0; axis < 3; ++axis) {
      const long double u = start_.pose.position[axis] - equilibrium_[axis];
      const long double v = start_.twist.linear[axis] / rate_;
      s.pose.position[axis] =
          static_cast<double>(equilibrium_[axis] + u * std::cos(angle) + v * std::sin(angle));
      s.twist.linear[axis] =
          static_cast<double>(rate_ * (v * std::cos(angle) - u * std::sin(angle)));
    }
    if (turn_ > 0.0L && phase_ + angle > turn_) {
      reflect(s, angle);
    }
    return s;
  }

 private:
  void reflect(BodyState& s, long double angle) const {
    const long double since = std::fmod(phase_ + angle + turn_, 2.0L * turn_) - turn_;
    const auto u = static_cast<double>(amplitude_ * std::cos(since));
    const auto v = static_cast<double>(-rate_ * amplitude_ * std::sin(since));
    const Vector3& n = wall_->normal;
    s.pose.position += n * (u - n.dot(s.pose.position - equilibrium_));
    s.twist.linear += n * (v - n.dot(s.twist.linear));
  }

  BodyIndex ball_;
  BodyState start_;
  Vector3 equilibrium_;
  long double rate_;  ///< sqrt(k/m), rad/s
  std::optional<Wall> wall_;
  long double amplitude_ = 0.0L;  ///< along the normal, m
  long double phase_ = 0.0L;      ///< at the start
  long double turn_ = 0.0L;       ///< c; 0: never hits
};

std::unique_ptr<const ExactMotion> solve(const Scene& scene) {
  const std::vector<BodyIndex> balls = free_bodies(scene);
  need(balls.size() == 1 && scene.bodies.size() <= 2 && scene.forces.size() == 1, scene,
       "one free ball, at most one wall, and one force");
  const Body& ball = scene.bodies[balls.front()];
  const auto* spring = dynamic_cast<const Spring*>(scene.forces.front().force.get());
  need(spring != nullptr && spring->conservative() && spring->parameters().rest_length == 0.0 &&
           spring->parameters().stiffness > 0.0 && !spring->involves_rotation(),
       scene, "a spring without damping, of length 0, from the ball's centre to an anchor");
  const double k = spring->parameters().stiffness;
  const Vector3 equilibrium =
      spring->parameters().anchor_W + gravity(scene, ball) * (ball.mass / k);
  std::optional<Oscillator::Wall> wall;
  if (scene.bodies.size() == 2) {
    const Body& other = scene.bodies[1 - balls.front()];
    const auto* sphere = std::get_if<Sphere>(&ball.shape);
    need(sphere != nullptr && is_plane(other), scene, "a sphere and a half-space at rest");
    need(scene.restitution(ball, other) == 1.0, scene, "restitution 1");
    const Pose& plane = other.initial.pose;
    const Vector3 normal = half_space_normal(std::get<HalfSpace>(other.shape), plane);
    wall = {normal,
            static_cast<long double>(normal.dot(plane.position - equilibrium)) + sphere->radius};
  }
  return std::make_unique<const Oscillator>(balls.front(), ball.initial, equilibrium,
                                            std::sqrt(static_cast<long double>(k) / ball.mass),
                                            wall);
}

}  // namespace

ExactSolutionType oscillator() {
  return {.name = "oscillator",
          .summary = "a ball on a spring, which may hit a wall elastically",
          .formula = "from rest at amplitude A, wall at d: t_k = (2k-1) acos(d/A) sqrt(m/k)",
          .source = "harmonic motion",
          .solve = solve};
}

}  // namespace exact
}  // namespace core
}  // namespace kairos
