#include "experiments/thesis/sinking_ball.hpp"

#include "core/reading/scene_reader.hpp"
#include "core/trajectory.hpp"
#include "experiments/run_error.hpp"
#include "simulation/registry.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"

#include <cmath>

namespace kairos::experiments::thesis {
namespace {

constexpr BodyIndex wall = 0;
constexpr BodyIndex ball = 1;

/// The ball's motion in the frame that ends in the first overlap.
Motion sinking_motion(const Scene& scene, const Trajectory& run) {
  const auto detector = find_detector("sat");
  for (std::size_t n = 1; n < run.frame_times().size(); ++n) {
    const State& drawn = run.frame_state(n);
    if (!detector->overlaps(scene.bodies[ball].shape, drawn[ball].pose, scene.bodies[wall].shape,
                            drawn[wall].pose)) {
      continue;
    }
    for (const Motion& motion : run.motions(ball)) {
      if (motion.start == run.frame_times()[n - 1]) {
        return motion;
      }
    }
  }
  throw RunError("figs. 13 and 14: no frame of the run ends inside the wall");
}

}  // namespace

SinkingBall sinking_ball_run() {
  const Scene scene = read_scene(find_scene("bounce"), {{"body.ball.velocity", "[5, 0, 0]"},
                                                        {"body.ball.radius", "0.15"},
                                                        {"body.ball.position", "[0, 1.3, 0]"}});
  RunChoice choice;
  choice.method = MethodChoice::thesis();
  choice.frames = FixedFrames{1.0 / 15.0};
  choice.duration = 1.0;
  const Simulation run = simulate(scene, choice);

  SinkingBall found;
  found.shape = scene.bodies[ball].shape;
  found.radius = bounding_radius(found.shape);
  found.wall = scene.bodies[wall].shape;
  found.wall_pose = scene.bodies[wall].initial.pose;
  found.path = sinking_motion(scene, run.trajectory);
  const Motion resting = Motion::at_rest(found.path.start, found.wall_pose);
  found.impact = find_detector("certified")
                     ->time_of_impact({found.shape, found.path}, {found.wall, resting},
                                      {found.path.start, found.path.duration}, 0.0);
  found.command =
      "kairos run bounce --thesis --frame 1/15 --duration 1 --set body.ball.velocity=[5,0,0] "
      "--set body.ball.radius=0.15 --set body.ball.position=[0,1.3,0]";
  return found;
}

}  // namespace kairos::experiments::thesis
