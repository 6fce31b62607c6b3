#include "experiments/rally/rally_run.hpp"
#include "experiments/run_error.hpp"
#include "experiments/thesis/frames.hpp"
#include "experiments/thesis/thesis_figure.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kairos::experiments::thesis {
namespace {

/// The view of a player.
const Camera player{{0.9, 1.75, 2.35}, {-0.02, 0.98, 0.15}, 47.0};

Footage run(const Scene& scene, const RunChoice& choice) {
  FootageRecorder recorder;
  (void)simulate(Model(scene), choice, recorder);
  return recorder.footage();
}

RunChoice thesis_choice() { return {.method = MethodChoice::thesis()}; }

/// The first stroke of the rally, as both schemes see it; all that is round collides as its box, as
/// in the thesis.
Storyboard scene_board() {
  const RallyRecording rally = make_rally({.seed = 1999, .strokes = 1});
  Scene scene = rally_scene(rally, {.name = "figure 11"});
  for (Body& body : scene.bodies) {
    body.bounds = Bounds::obb;
  }
  Storyboard board;
  board.original = run(scene, thesis_choice());
  board.event_driven = run(scene, {});
  const double before_hit = rally.strokes.front().hit - 0.07;
  board.frames = {
      {"The table, folded up so that one can play alone; the bounding boxes of the bat "
       "and of the ball.",
       before_hit, before_hit, "", ""}};
  board.options = {.camera = player};
  return board;
}

void measure_scene(FigureData& data) {
  const Storyboard board = scene_board();
  tell_frames(board, data);
  data.count("bodies", static_cast<std::int64_t>(board.original.actors.size()), "in the scene");
}

std::string draw_scene(const std::string& folder) { return draw_frames(scene_board(), folder); }

/// How deep the ball is in the bat in a picture, m.
double depth_at(const Footage& footage, std::size_t picture) {
  double depth = 0.0;
  for (const Overlapping& pair : overlapping(footage, picture)) {
    if (footage.actors[pair.a].entity == "bat" || footage.actors[pair.b].entity == "bat") {
      depth = std::max(depth, pair.depth);
    }
  }
  return depth;
}

std::string depth_note(const Footage& footage, std::size_t picture) {
  const double depth = depth_at(footage, picture);
  return depth > 0.0 ? fmt::format("{:.1f} mm inside", 1000.0 * depth) : "outside";
}

/// On which side of the bat's middle the ball is.
bool before_bat(const Footage& footage, std::size_t picture) {
  const auto find = [&](std::string_view name) {
    std::size_t i = 0;
    while (footage.actors[i].name != name) {
      ++i;
    }
    return footage.pictures[picture].poses[i];
  };
  return find("bat").to_body(find("ball").position).z() < 0.0;
}

/// Whether the ball is outside before picture k, inside in it, and deeper in the next,
/// always on the side that it came from.
bool sinks(const Footage& footage, std::size_t k) {
  return depth_at(footage, k - 1) == 0.0 && depth_at(footage, k) > 0.0 &&
         depth_at(footage, k + 1) > depth_at(footage, k) &&
         before_bat(footage, k - 1) == before_bat(footage, k) &&
         before_bat(footage, k) == before_bat(footage, k + 1);
}

/// The picture in which the hit is found of the stroke in which the ball sinks farthest into the
/// bat until the next; 0 if it does in none. Only where the bat meets the served ball: from then on
/// the schemes go ways of their own.
std::size_t sinking_picture(const Footage& footage, const RallyRecording& rally) {
  constexpr double about = 0.1;  // s
  std::size_t best = 0;
  double farthest = 0.0;
  for (const Stroke& stroke : rally.strokes) {
    const std::size_t last = footage.at(stroke.hit + about);
    for (std::size_t k = footage.at(stroke.hit - about); k < last; ++k) {
      const double more = depth_at(footage, k + 1) - depth_at(footage, k);
      if (sinks(footage, k) && more > farthest) {
        farthest = more;
        best = k;
      }
    }
  }
  return best;
}

/// Three frames running, and how deep the ball is in the bat.
struct Penetration {
  Storyboard board;
  std::vector<double> depths;  ///< of `original`, m
  std::uint64_t seed = 0;      ///< of the rally
};

/// A rally with a bat as heavy as the ball.
Scene equal_masses(const RallyRecording& rally) {
  RallyMethod method{.name = "figure 12"};
  method.bat_mass = 0.0027;
  return rally_scene(rally, method);
}

constexpr std::uint64_t seeds = 8;  ///< rallies of 24 strokes that are looked through

/// Of the stroke that shows it best: the frame before, the one in which the hit is found, and the
/// next.
Penetration penetration() {
  constexpr std::uint64_t first_seed = 1999;
  Penetration found;
  Storyboard& board = found.board;
  std::size_t k = 0;
  double farthest = 0.0;
  for (std::uint64_t seed = first_seed; seed < first_seed + seeds; ++seed) {
    const RallyRecording rally = make_rally({.seed = seed, .fastest = 5.0});
    Footage footage = run(equal_masses(rally), thesis_choice());
    const std::size_t picture = sinking_picture(footage, rally);
    const double more =
        picture == 0 ? 0.0 : depth_at(footage, picture + 1) - depth_at(footage, picture);
    if (more > farthest) {
      farthest = more;
      k = picture;
      found.seed = seed;
      board.original = std::move(footage);
    }
  }
  if (k == 0) {
    throw RunError("no rally shows the ball sinking into the bat");
  }
  board.event_driven = run(equal_masses(make_rally({.seed = found.seed, .fastest = 5.0})), {});
  const char* captions[] = {"The ball and the bat are headed for a collision.",
                            "The collision is detected, and the ball's velocity changed.",
                            "The ball has moved, but the bat has moved farther."};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t picture = k - 1 + i;
    const double t = board.original.pictures[picture].time;
    board.frames.push_back({captions[i], t, t, depth_note(board.original, picture),
                            depth_note(board.event_driven, board.event_driven.at(t))});
    found.depths.push_back(depth_at(board.original, picture));
  }
  const Vector3 ball = board.original.pictures[k].poses.back().position;
  board.options = {.camera = Camera{ball + Vector3(0.5, 0.08, 0.04), ball, 26.0}};
  return found;
}

void measure_penetration(FigureData& data) {
  const Penetration found = penetration();
  tell_frames(found.board, data);
  Table& table = data.table(
      "depths", {{"frame", "", "number"}, {"depth", "m", "of the ball in the bat, original"}});
  for (std::size_t i = 0; i < found.depths.size(); ++i) {
    table.rows.push_back({static_cast<std::int64_t>(i + 1), number_cell(found.depths[i])});
  }
  data.count("seed", static_cast<std::int64_t>(found.seed), "of the rally");
  data.count("strokes", static_cast<std::int64_t>(24 * seeds), "that were looked through");
  data.value("detected", 1000.0 * found.depths[1], "mm", "depth when the hit is found", 3);
  data.value("after", 1000.0 * found.depths[2], "mm", "depth a frame later", 3);
}

std::string draw_penetration(const std::string& folder) {
  return draw_frames(penetration().board, folder);
}

}  // namespace

ThesisFigure table_tennis_scene() {
  return {.name = "fig11",
          .chapter = "7",
          .title = "Figure 11: the table tennis application",
          .shows =
              "The table, folded to allow a single user to play, with the bounding boxes of "
              "the bat and the ball.",
          .how =
              "The scene table-tennis with all round things in their boxes (bounds = \"obb\"), "
              "rendered from a run of kairos record --seed 1999 just before the first hit.",
          .caption =
              "The {bodies} bodies of the scene table-tennis: left by the original scheme, "
              "right event-driven; boxes as wire.",
          .finding = "The hand is in this picture; in the thesis' it is not. Sizes are ours.",
          .script = "thesis.frames",
          .measure = measure_scene,
          .draw = draw_scene};
}

ThesisFigure bat_and_ball() {
  return {.name = "fig12",
          .chapter = "7",
          .title = "Figure 12: the ball penetrates the bat",
          .shows =
              "Three frames: bat and ball headed for a collision; the collision detected and "
              "the ball's direction reversed; the bat has moved too far and the ball is "
              "inside it.",
          .how =
              "Three frames running of the stroke, of {strokes} at 2 to 5 m/s (found in the rally "
              "of seed "
              "{seed}), in which the ball sinks farthest into the bat after the hit. The bat "
              "is as heavy as the "
              "ball here, so that the exchange of 13.7 gives the ball the bat's own velocity; "
              "left the original scheme, right event-driven at the same times. Where the two "
              "overlap they are drawn translucent, and the depth is printed.",
          .caption =
              "Left, original: {detected} deep where the hit is found, {after} a frame "
              "later. Right, event-driven: never inside.",
          .finding =
              "The drawn frame already shows the ball inside when the collision is found, "
              "and a bat that still speeds up catches the ball that was given its "
              "velocity: {after} a frame later.",
          .script = "thesis.frames",
          .measure = measure_penetration,
          .draw = draw_penetration};
}

}  // namespace kairos::experiments::thesis
