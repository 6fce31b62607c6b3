#include "core/error.hpp"
#include "core/reading/scene_reader.hpp"
#include "experiments/output/broadcast.hpp"
#include "experiments/physworld/story.hpp"
#include "experiments/thesis/frames.hpp"
#include "experiments/thesis/thesis_figure.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kairos::experiments::thesis {
namespace {

const char* const captions[] = {
    "All three balls are travelling downwards, the red slightly to the right.",
    "Red and blue collide. Green goes into the anti-gravity well.",
    "Blue collides with the floor. Green slows down, stops and starts to move upwards.",
    "Blue, still moving up, collides with the wall. Green comes out of the well.",
    "Red bounces off the floor and collides with blue: blue up, red down.",
    "Red bounces off the edge of the floor.",
    "Red, moving slightly left, enters the well and sends green up and left.",
    "After a few seconds green comes into the field of vision again.",
    "Green collides with the conveyor, is given a push to the right and rises."};

struct Telling {
  Story story;
  Footage footage;
};

Telling tell(const MethodChoice& method) {
  const Model model(read_scene(find_scene("physworld")));
  StoryRecorder story;
  FootageRecorder footage;
  Broadcast both({&story, &footage});
  (void)simulate(model, {.method = method}, both);
  return {story.story(), footage.footage()};
}

const MethodChoice events{"event-driven", "auto", "certified", "thesis"};

/// Adds to a caption the times at which the original has its other events.
std::string with_times(const std::string& caption, int frame, double shown, const Story& story) {
  std::string more;
  for (const Told& moment : story.moments) {
    if (moment.frame == frame && frame > 1 && std::abs(moment.time - shown) > 0.3) {
      more += fmt::format("{}{}: {:.2f} s", more.empty() ? "" : "; ", moment.what, moment.time);
    }
  }
  return more.empty() ? caption : fmt::format("{} ({})", caption, more);
}

Storyboard board_of(Telling original, Telling exact) {
  Storyboard board;
  board.original = std::move(original.footage);
  board.event_driven = std::move(exact.footage);
  for (std::size_t i = 0; i < std::size(captions); ++i) {
    board.frames.push_back(
        {with_times(captions[i], static_cast<int>(i) + 1, original.story.frames[i], original.story),
         original.story.frames[i], exact.story.frames[i], "", ""});
  }
  board.options = {.camera = Camera{{17.0, -20.0, 72.0}, {17.0, -25.0, 20.0}, 54.0},
                   .width = 400,
                   .height = 300,
                   .boxes = false};
  return board;
}

void tell_moments(const Story& original, const Story& exact, FigureData& data) {
  Table& table = data.table("moments", {{"frame", "", "of the nine"},
                                        {"moment", "", "what the caption says"},
                                        {"original", "s", "when, original"},
                                        {"event_driven", "s", "when, event-driven"}});
  for (std::size_t i = 0; i < original.moments.size() && i < exact.moments.size(); ++i) {
    table.rows.push_back({static_cast<std::int64_t>(original.moments[i].frame),
                          std::string(original.moments[i].what), original.moments[i].time,
                          exact.moments[i].time});
  }
}

/// The first impact of the ball with the belt, and where the ball is at the end.
class BeltWatch : public Recorder {
 public:
  void event(const Event& event) override {
    if (event.kind == EventKind::impact) {
      ++impacts;
      if (impacts == 1) {
        after = (event.a == 1 ? event.after_a : event.after_b).twist.linear;
      }
    }
  }
  void frame(const Frame& frame) override {
    lowest = std::min(lowest, frame.bodies[1].pose.position.y());
  }
  int impacts = 0;
  double lowest = 1.0;
  Vector3 after = Vector3::Zero();
};

/// Records what the belt of 13.6 does to balls of different masses: the scene `conveyor`.
void tell_belt(FigureData& data) {
  Table& table = data.table("belt", {{"mass", "kg", "of the ball"},
                                     {"method", "", "scheme and impact law"},
                                     {"vy", "m/s", "upwards, after the first hit"},
                                     {"vx", "m/s", "along the belt, after the first hit"},
                                     {"hits", "", "in 3 s"},
                                     {"outcome", "", "in 3 s"}});
  const std::pair<const char*, MethodChoice> methods[] = {
      {"original, thesis", MethodChoice::thesis()},
      {"event-driven, thesis", events},
      {"event-driven, newton", MethodChoice{}}};
  std::int64_t swallowed = 0;
  std::int64_t turned_in = 0;
  for (const double mass : {1.0, 5.0, 9.9, 10.1, 20.0, 200.0}) {
    for (const auto& [name, method] : methods) {
      const Model model(
          read_scene(find_scene("conveyor"), {{"body.ball.mass", fmt::format("{}", mass)}}));
      BeltWatch watch;
      const RunResult result = simulate(model, {.method = method}, watch);
      const bool fell = watch.lowest < -0.3;
      if (method.scheme == "original") {
        swallowed += fell ? 1 : 0;
        turned_in += watch.after.y() < 0.0 ? 1 : 0;
      }
      // "still approaching: the impact law ..." says what it is before the colon.
      const std::string outcome =
          result.status == RunStatus::stopped
              ? "stopped: " + result.reason.substr(0, result.reason.find(':'))
              : (fell ? "swallowed" : "bounces");
      table.rows.push_back({mass, std::string(name), watch.after.y(), watch.after.x(),
                            static_cast<std::int64_t>(watch.impacts), outcome});
    }
  }
  data.count("swallowed", swallowed, "of six masses that fall through the belt, original");
  data.count("turned_in", turned_in, "of six masses that the first hit turns inwards, original");
}

void measure(FigureData& data) {
  Telling original = tell(MethodChoice::thesis());
  Telling exact = tell(events);
  for (const Story* story : {&original.story, &exact.story}) {
    if (!story->complete) {
      throw InputError("scenes/physworld.def", 0, "",
                       fmt::format("does not tell ch. 8.1: {}", story->missing));
    }
  }
  tell_moments(original.story, exact.story, data);
  tell_belt(data);
  data.value("first", original.story.moments.front().time, "s", "of the first collision", 3);
  data.value("last", original.story.moments.back().time, "s", "of the conveyor, original", 4);
  data.value("last_events", exact.story.moments.back().time, "s", "event-driven", 4);
  data.count("moments", static_cast<std::int64_t>(exact.story.moments.size()), "told in order");
  tell_frames(board_of(std::move(original), std::move(exact)), data);
}

std::string draw(const std::string& folder) {
  return draw_frames(board_of(tell(MethodChoice::thesis()), tell(events)), folder);
}

}  // namespace

ThesisFigure physworld() {
  return {
      .name = "ch8.1",
      .chapter = "8",
      .title = "Chapter 8.1: vrphysicsapp in the flesh",
      .shows = "Nine frames of three balls, two walls, an anti-gravity pad and a conveyor.",
      .how =
          "scenes/physworld.def, of which the thesis keeps the pad's five lines; places, "
          "velocities and sizes were found by kairos physworld, such that the nine frames of "
          "{moments} moments "
          "that the captions tell come in order under both schemes. Left the original scheme, "
          "right "
          "event-driven with the thesis' impact law; each frame just after the collision that its "
          "caption tells, in each run. What else a caption tells comes at its own time, added "
          "in brackets (original).",
      .caption =
          "The nine frames, from {first} to the conveyor at {last} (original) and "
          "{last_events} (event-driven).",
      .finding =
          "The balls weigh 20 kg: for lighter ones than the belt's 10 kg the caption "
          "of frame 9 cannot come true by the first hit. 13.6 exchanges, which turns "
          "the ball up already, and then reflects: {turned_in} of six masses in the "
          "table belt are turned into the conveyor, and stay in it: each frame inside, the "
          "exchange turns them outwards and the reflection back in, so that they sink at "
          "(10-m) G h/(2m). {swallowed} of the six is through within 3 s. Event-driven stops at "
          "the first such hit and "
          "says so, since no impact may leave a pair approaching.",
      .script = "thesis.frames",
      .measure = measure,
      .draw = draw};
}

}  // namespace kairos::experiments::thesis
