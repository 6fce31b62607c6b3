#include "core/trajectory.hpp"
#include "experiments/thesis/sinking_ball.hpp"
#include "experiments/thesis/thesis_figure.hpp"
#include "simulation/registry.hpp"

namespace kairos::experiments::thesis {
namespace {

void measure(FigureData& data) {
  const SinkingBall ball = sinking_ball_run();
  const Motion& path = ball.path;
  Table& positions = data.table("positions", {{"position", "", "1, 2 or 3 as in the thesis"},
                                              {"t", "s", "time"},
                                              {"x", "m", "centre of the ball, to the right"},
                                              {"y", "m", "centre of the ball, upwards"},
                                              {"gap", "m", "between ball and wall"}});
  const auto detector = find_detector("certified");
  const auto add = [&](std::int64_t number, double s) {
    const Pose pose = path.pose(s);
    const double gap = detector->overlap(ball.shape, pose, ball.wall, ball.wall_pose).gap;
    positions.rows.push_back(
        {number, (path.start + s).seconds, pose.position.x(), pose.position.y(), gap});
    return gap;
  };
  const double before = add(1, 0.0);
  const double touching = add(2, ball.impact.t_lo);
  const double depth = -add(3, path.duration);

  data.value("radius", ball.radius, "m", "of the ball");
  data.value("frame", path.duration, "s", "one rendered frame");
  data.value("gap", before, "m", "gap at position 1");
  data.value("depth", depth, "m", "penetration at position 3, as it is drawn");
  data.value("t1", path.start.seconds, "s", "time of position 1", 6);
  data.value("t2", (path.start + ball.impact.t_lo).seconds, "s", "time of position 2", 10);
  data.value("t3", path.end().seconds, "s", "time of position 3", 6);
  data.value("bracket", ball.impact.t_hi - ball.impact.t_lo, "s",
             "width of the proven bracket around the time of impact", 2);
  data.value("touching", touching, "m", "gap at position 2", 2);
  data.value("late", path.duration - ball.impact.t_lo, "s", "from the contact to its detection");
  data.text("command", ball.command, "the run");
}

}  // namespace

ThesisFigure sinking_ball() {
  return {.name = "fig13",
          .chapter = "9",
          .title = "Figure 13: the ball penetrates into the wall",
          .shows =
              "A ball moves down and to the right. In one frame it is at position 1, in the "
              "next at position 3, inside the wall; the collision should have been detected at "
              "position 2 (9.1.1.1).",
          .how =
              "Positions 1 and 3 are two successive frames of the run `{command}`, the last "
              "without contact and the first that overlaps. Position 2 is the time of impact "
              "that the detector `certified` gives for that run's own motion between them.",
          .caption =
              "Measured: position 1 at {t1}, {gap} above the wall; position 2 at {t2}, gap "
              "{touching}; position 3 at {t3}, drawn {depth} inside the wall.",
          .finding =
              "The contact lies {late} before the frame in which the thesis' stepping sees "
              "it. `certified` brackets it to {bracket} and proves that there is no earlier "
              "one.",
          .script = "thesis.fig13",
          .measure = measure};
}

}  // namespace kairos::experiments::thesis
