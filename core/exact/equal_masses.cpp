#include "core/exact/precondition.hpp"

#include <algorithm>
#include <cmath>

namespace kairos {
inline namespace core {
namespace exact {
namespace {

/// Equal elastic balls on a line exchange their velocities: in coordinates from which the balls'
/// own lengths are taken away they pass through each other, and only their order counts.
class EqualMasses : public ExactMotion {
 public:
  struct Ghost {
    double x;  ///< reduced coordinate at t = 0, m
    double v;  ///< m/s
  };

  EqualMasses(const Scene& scene, std::vector<BodyIndex> order, const Vector3& axis)
      : order_(std::move(order)), axis_(axis) {
    const Body* previous = nullptr;
    double length = 0.0;
    origin_ = scene.bodies[order_.front()].initial.pose.position;
    for (const BodyIndex i : order_) {
      const Body& body = scene.bodies[i];
      if (previous != nullptr) {
        length += radius(*previous) + radius(body);
      }
      const double x = axis_.dot(body.initial.pose.position - origin_);
      offsets_.push_back(length);
      ghosts_.push_back({x - length, axis_.dot(body.initial.twist.linear)});
      starts_.push_back(body.initial);
      previous = &body;
    }
    find_impacts();
  }

  static double radius(const Body& body) { return std::get<Sphere>(body.shape).radius; }

  [[nodiscard]] std::optional<double> impact_time(std::int64_t k) const override {
    if (k < 1 || k > static_cast<std::int64_t>(impacts_.size())) {
      return std::nullopt;
    }
    return impacts_[static_cast<std::size_t>(k - 1)];
  }

  [[nodiscard]] std::optional<BodyState> state(BodyIndex body, Instant t) const override {
    const auto found = std::find(order_.begin(), order_.end(), body);
    if (found == order_.end()) {
      return std::nullopt;
    }
    const auto rank = static_cast<std::size_t>(found - order_.begin());
    const double time = static_cast<double>(seconds(t));
    std::vector<Ghost> now = ghosts_;
    for (Ghost& ghost : now) {
      ghost.x += ghost.v * time;
    }
    std::sort(now.begin(), now.end(), [](const Ghost& a, const Ghost& b) {
      return a.x < b.x || (a.x == b.x && a.v < b.v);
    });
    BodyState s = starts_[rank];
    s.pose.position = origin_ + (now[rank].x + offsets_[rank]) * axis_;
    s.twist.linear = now[rank].v * axis_;
    return s;
  }

 private:
  void find_impacts() {
    for (std::size_t i = 0; i < ghosts_.size(); ++i) {
      for (std::size_t j = i + 1; j < ghosts_.size(); ++j) {
        const double closing = ghosts_[i].v - ghosts_[j].v;
        if (closing > 0.0) {
          impacts_.push_back((ghosts_[j].x - ghosts_[i].x) / closing);
        }
      }
    }
    std::sort(impacts_.begin(), impacts_.end());
  }

  std::vector<BodyIndex> order_;  ///< along the line
  Vector3 axis_;
  Vector3 origin_ = Vector3::Zero();
  std::vector<double> offsets_;
  std::vector<Ghost> ghosts_;
  std::vector<BodyState> starts_;
  std::vector<double> impacts_;
};

/// The direction of the line through the first two balls.
Vector3 line(const Scene& scene, const std::vector<BodyIndex>& balls) {
  const auto position = [&scene, &balls](std::size_t i) -> const Vector3& {
    return scene.bodies[balls[i]].initial.pose.position;
  };
  const Vector3 along = position(1) - position(0);
  need(along.norm() > 0.0, scene, "balls at different places");
  return along.normalized();
}

/// Whether v lies along the axis, to roundoff of its own size and that of `scale`.
bool parallel(const Vector3& v, const Vector3& axis, double scale) {
  constexpr double roundoff = 1e-14;
  return (v - axis.dot(v) * axis).norm() <= roundoff * std::max(scale, v.norm());
}

std::unique_ptr<const ExactMotion> solve(const Scene& scene) {
  std::vector<BodyIndex> balls = free_bodies(scene);
  need(balls.size() >= 2 && balls.size() == scene.bodies.size() && scene.forces.empty(), scene,
       "free balls only, two or more, and no forces");
  const Vector3 axis = line(scene, balls);
  const Body& first = scene.bodies[balls.front()];
  for (const BodyIndex i : balls) {
    const Body& ball = scene.bodies[i];
    need(std::holds_alternative<Sphere>(ball.shape), scene, "spheres");
    need(ball.mass == first.mass, scene, "equal masses");
    need(ball.restitution == 1.0, scene, "restitution 1");
    need(ball.G == 0.0, scene, "G = 0");
    const Vector3 arm = ball.initial.pose.position - first.initial.pose.position;
    need(parallel(arm, axis, ball.initial.pose.position.norm()) &&
             parallel(ball.initial.twist.linear, axis, 0.0),
         scene, "all positions and velocities on one line");
  }
  std::sort(balls.begin(), balls.end(), [&](BodyIndex a, BodyIndex b) {
    return axis.dot(scene.bodies[a].initial.pose.position) <
           axis.dot(scene.bodies[b].initial.pose.position);
  });
  return std::make_unique<const EqualMasses>(scene, std::move(balls), axis);
}

}  // namespace

ExactSolutionType equal_masses() {
  return {.name = "equal-masses",
          .summary = "equal elastic balls on a line, Newton's cradle among them",
          .formula = "velocities are permuted; impacts where undisturbed paths cross",
          .source = "conservation of momentum and energy",
          .solve = solve};
}

}  // namespace exact
}  // namespace core
}  // namespace kairos
