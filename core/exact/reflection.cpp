#include "core/exact/precondition.hpp"

#include <cmath>

namespace kairos {
inline namespace core {
namespace exact {
namespace {

/// A ball that flies straight at the face of a fixed box and comes straight back.
class Reflection : public ExactMotion {
 public:
  Reflection(BodyIndex ball, const BodyState& start, double time, double restitution)
      : ball_(ball), start_(start), time_(time), restitution_(restitution) {}

  [[nodiscard]] std::optional<double> impact_time(std::int64_t k) const override {
    return k == 1 ? std::optional(time_) : std::nullopt;
  }
  [[nodiscard]] std::optional<BodyState> state(BodyIndex body, Instant t) const override {
    if (body != ball_) {
      return std::nullopt;
    }
    const double time = static_cast<double>(seconds(t));
    BodyState s = start_;
    const double before = std::min(time, time_);
    const double after = std::max(0.0, time - time_);
    s.pose.position += (before - restitution_ * after) * start_.twist.linear;
    if (time >= time_) {
      s.twist.linear *= -restitution_;
    }
    return s;
  }

 private:
  BodyIndex ball_;
  BodyState start_;
  double time_;
  double restitution_;
};

/// Whether the ray of the ball's centre meets the inside of the face across `axis`.
bool hits_face(const Vector3& position_B, const Vector3& half_extents, int axis) {
  for (int i = 0; i < 3; ++i) {
    if (i != axis && !(std::abs(position_B[i]) < half_extents[i])) {
      return false;
    }
  }
  return true;
}

std::unique_ptr<const ExactMotion> solve(const Scene& scene) {
  const std::vector<BodyIndex> balls = free_bodies(scene);
  need(balls.size() == 1 && scene.bodies.size() == 2 && scene.forces.empty(), scene,
       "one free ball and one wall, and no forces");
  const Body& ball = scene.bodies[balls.front()];
  const Body& wall = scene.bodies[1 - balls.front()];
  const auto* sphere = std::get_if<Sphere>(&ball.shape);
  const auto* box = std::get_if<Box>(&wall.shape);
  need(sphere != nullptr && box != nullptr && wall.drive == nullptr &&
           wall.entity->physics_type() == PhysicsType::wall,
       scene, "a sphere and a box that is a wall at rest");
  need(ball.G == 0.0, scene, "G = 0");
  const Pose& pose = wall.initial.pose;
  const Vector3 velocity = pose.orientation.conjugate() * ball.initial.twist.linear;
  const Vector3 position = pose.to_body(ball.initial.pose.position);
  int axis = 0;
  const double speed = velocity.cwiseAbs().maxCoeff(&axis);
  need(speed > 0.0 && velocity.cwiseAbs().sum() == speed, scene,
       "a velocity along one axis of the wall");
  const double distance = std::abs(position[axis]) - box->half_extents[axis] - sphere->radius;
  need(distance >= 0.0 && position[axis] * velocity[axis] < 0.0 &&
           hits_face(position, box->half_extents, axis),
       scene, "a ball that flies at a face of the wall");
  return std::make_unique<const Reflection>(balls.front(), ball.initial, distance / speed,
                                            scene.restitution(ball, wall));
}

}  // namespace

ExactSolutionType reflection() {
  return {.name = "reflection",
          .summary = "a ball flies straight at a fixed box and comes straight back",
          .formula = "t_1 = (distance of the surfaces)/v; speed e v afterwards",
          .source = "uniform motion",
          .solve = solve};
}

}  // namespace exact
}  // namespace core
}  // namespace kairos
