#include "core/reading/scene_reader.hpp"
#include "experiments/thesis/stage_trace.hpp"
#include "experiments/thesis/thesis_figure.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"

#include <algorithm>

namespace kairos::experiments::thesis {
namespace {

/// Runs a scene, follows the stages, and keeps those of the frame in which something is handled.
StageTrace traced(FigureData& data, const Scene& scene, const RunChoice& choice) {
  StageTrace trace;
  const Model model(scene);
  const RunResult result = simulate(model, choice, trace);
  trace.add_transitions(data);
  trace.add_frame(data, trace.first_impact());
  data.count("frames", result.cost.frames, "frames drawn");
  data.count("impacts", result.cost.impacts, "pairs handled");
  data.count("frame", trace.first_impact(), "the frame whose stages are shown");
  return trace;
}

void measure_original(FigureData& data) {
  RunChoice choice;
  choice.method = MethodChoice::thesis();
  choice.duration = 10.0;
  (void)traced(data, read_scene(find_scene("bounce")), choice);
  data.text("command", "kairos run bounce --thesis", "the run");
}

void measure_substepped(FigureData& data) {
  RunChoice choice;
  choice.method = MethodChoice::thesis();
  choice.method.scheme = "substepped";
  choice.duration = 0.25;
  const StageTrace trace = traced(data, read_scene(find_scene("bullet")), choice);
  const auto& entries = trace.entries();
  const auto in_frame = [&](Stage stage) {
    return std::count_if(entries.begin(), entries.end(), [&](const StageTrace::Entry& entry) {
      return entry.frame == trace.first_impact() && entry.stage == stage;
    });
  };
  double full = 0.0;
  double last = 0.0;
  double before = 0.0;
  for (const StageTrace::Entry& entry : entries) {
    if (entry.frame == trace.first_impact() && entry.stage == Stage::advance) {
      full = full == 0.0 ? entry.fraction : full;
      last = entry.fraction - before;
      before = entry.fraction;
    }
  }
  data.count("substeps", in_frame(Stage::advance), "substeps of the frame that is shown");
  data.count("handled", in_frame(Stage::handle), "times that the pair is handled in that frame");
  data.count("restricted", in_frame(Stage::restrict_movement), "of them restricted");
  data.value("fraction", full, "", "of the frame that a restricted substep takes");
  data.value("last", last, "", "of the frame that the last substep takes");
  data.text("command", "kairos run bullet --thesis --scheme substepped", "the run");
}

}  // namespace

ThesisFigure flow_of_events() {
  return {.name = "fig07",
          .chapter = "4",
          .title = "Figure 7: the flow of events in CoRgi",
          .shows =
              "Draw the scene, detect (and handle) collisions, calculate new positions, and "
              "again (4.1).",
          .how =
              "The scheme `original` tells a recorder each stage that it goes through while it "
              "runs `{command}`. Boxes are stages, arrows are transitions that happened, with how "
              "often.",
          .caption =
              "Stages of `original` over {frames} frames with {impacts} collisions, as traced; "
              "right: those of frame {frame}, in which the ball meets the floor.",
          .finding =
              "As drawn in the thesis: one detection a frame, before anything moves. What "
              "happens between two frames, nothing looks at.",
          .script = "thesis.fig07",
          .measure = measure_original};
}

ThesisFigure improved_flow_of_events() {
  return {
      .name = "fig15",
      .chapter = "9",
      .title = "Figure 15: an improved flow of events",
      .shows =
          "Movements beyond a threshold are scaled back, which lets a fraction f of the "
          "frame pass; collisions are detected there; again, until the fractions make a "
          "frame (9.1.1.2.2).",
      .how =
          "The same trace of the scheme `substepped` while it runs `{command}`, a bullet at a "
          "thin wall. The threshold is half of the smallest sum of two extents.",
      .caption =
          "Stages of `substepped` over {frames} frames, as traced; below: the fractions of "
          "frame {frame}, in which the bullet meets the wall. {substeps} substeps, "
          "{restricted} of them restricted to {fraction} of the frame.",
      .finding =
          "The frame ends on a substep of {last} of a frame instead of {fraction}. The bullet, "
          "reflected just before, is still inside at its end, and a reflection has no approach "
          "test: it is handled {handled} times in this frame and turned back in. This is how the "
          "cure, taken literally, lets balls through; at which speeds and thresholds, the "
          "experiment substeps shows.",
      .script = "thesis.fig15",
      .measure = measure_substepped};
}

}  // namespace kairos::experiments::thesis
