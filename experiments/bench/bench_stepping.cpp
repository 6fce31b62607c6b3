#include "core/reading/scene_reader.hpp"
#include "experiments/bench/bench.hpp"
#include "experiments/bench/bench_peers.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"

#include <fmt/format.h>

#include <cmath>

namespace kairos::experiments {
namespace {

constexpr double frame = 1.0 / 60.0;         // s
constexpr std::int64_t steps = 1'000'000;    // of a race
constexpr std::int64_t bounces = 1'000'000;  // of a race

/// The thesis' ball over a floor, nothing else: the state, the separating-axis test of 13.1 and
/// the arithmetic of 13.3 to 13.7, as one would write them down for this scene alone.
class BareLoop {
 public:
  std::int64_t run() {
    Vector3 position(0.0, 5.0, 0.0);
    Vector3 velocity = Vector3::Zero();
    Vector3 acceleration = Vector3::Zero();
    for (std::int64_t n = 0; n < steps; ++n) {
      if (overlap_15_axes(position)) {
        velocity -= 2.0 * velocity.dot(normal_) * normal_;
      }
      const Vector3 force = 9.8 * Vector3(0.0, -1.0, 0.0);
      position += velocity * frame;
      velocity += acceleration * frame;
      acceleration = force / mass_;
    }
    sink_ = position.y();
    return steps;
  }

 private:
  /// Two boxes, 15 axes [Gottschalk1996]: 3 + 3 faces and 9 pairs of edges, until one separates.
  [[nodiscard]] bool overlap_15_axes(const Vector3& position) const {
    const Matrix3 R = floor_axes_.transpose() * ball_axes_;
    const Matrix3 A = R.cwiseAbs();
    const Vector3 t = floor_axes_.transpose() * (position - floor_centre_);
    for (int i = 0; i < 3; ++i) {
      if (std::abs(t[i]) > floor_half_[i] + A.row(i).dot(ball_half_)) {
        return false;
      }
    }
    for (int j = 0; j < 3; ++j) {
      if (std::abs(t.dot(R.col(j))) > ball_half_[j] + A.col(j).dot(floor_half_)) {
        return false;
      }
    }
    for (int i = 0; i < 3; ++i) {
      const int i1 = (i + 1) % 3;
      const int i2 = (i + 2) % 3;
      for (int j = 0; j < 3; ++j) {
        const int j1 = (j + 1) % 3;
        const int j2 = (j + 2) % 3;
        const double reach = floor_half_[i1] * A(i2, j) + floor_half_[i2] * A(i1, j) +
                             ball_half_[j1] * A(i, j2) + ball_half_[j2] * A(i, j1);
        if (std::abs(t[i2] * R(i1, j) - t[i1] * R(i2, j)) > reach) {
          return false;
        }
      }
    }
    return true;
  }

  Matrix3 floor_axes_ = Matrix3::Identity();
  Matrix3 ball_axes_ = Matrix3::Identity();
  Vector3 floor_centre_{0.0, -1.0, 0.0};
  Vector3 floor_half_{10.0, 1.0, 10.0};
  Vector3 ball_half_{0.5, 0.5, 0.5};
  Vector3 normal_{0.0, 1.0, 0.0};
  double mass_ = 1.0;
  volatile double sink_ = 0.0;  // so that the loop is not left out
};

/// The same world as a scene: boxes around ball and floor, as in the thesis.
const char* const boxes = R"(
name = "boxes"
summary = "the bounce, everything a box"
bounds = "obb"
G = 9.8
[[body]]
name = "floor"
entity = "wall"
half_extents = [10.0, 1.0, 10.0]
position = [0.0, -1.0, 0.0]
[[body]]
name = "ball"
entity = "ball"
radius = 0.5
mass = 1.0
position = [0.0, 5.0, 0.0]
)";

Contender original(const std::string& name, const Model& model) {
  return {name, [&model] {
            RunChoice choice;
            choice.method = MethodChoice::thesis();
            choice.frames = FixedFrames{frame};
            choice.duration = frame * static_cast<double>(steps);
            Recorder nobody;
            return simulate(model, choice, nobody).cost.steps;
          }};
}

Contender event_driven(const Model& model) {
  return {"kairos: event-driven, closed-form", [&model] {
            const double whole = 2.0 * std::sqrt(2.0 * 4.5 / 9.8) * static_cast<double>(bounces);
            // One frame: nobody looks in between.
            const RunChoice choice{.frames = FixedFrames{whole}, .duration = whole};
            Recorder nobody;
            return simulate(model, choice, nobody).cost.impacts;
          }};
}

}  // namespace

void bench_stepping(int rounds) {
  const Model bounce(read_scene(find_scene("bounce")));
  const Model boxed(parse_scene(boxes, "boxes"));
  BareLoop bare;
  std::vector<Contender> contenders = {
      {"bare loop: box on box, 15 axes", [&bare] { return bare.run(); }},
      original("kairos: original, box on box", boxed),
      original("kairos: original, bounce", bounce)};
  if (has_ode()) {
    contenders.push_back({"ODE: dWorldStep", [] { return ode_bounce(steps, frame); }});
  }
  print_race(fmt::format("A ball bounces on a floor, {} steps of 1/60 s", steps), "step",
             race(contenders, rounds));
  print_race(fmt::format("The same, from impact to impact, {} bounces", bounces), "impact",
             race({event_driven(bounce)}, rounds));
}

}  // namespace kairos::experiments
