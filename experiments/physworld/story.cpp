#include "experiments/physworld/story.hpp"

#include "experiments/metrics/metrics.hpp"

#include <algorithm>
#include <functional>
#include <limits>

namespace kairos::experiments {
namespace {

/// Two moments that a person can tell apart, s.
constexpr double apart = 0.05;

}  // namespace

void StoryRecorder::begin(const Model& model) {
  model_ = &model;
  seen_.clear();
  green_turns_ = -1.0;
  green_inside_ = false;
}

void StoryRecorder::event(const Event& event) {
  const std::string_view a = model_->body(event.a).name;
  const std::string_view b = model_->body(event.b).name;
  if (b == "green" && event.kind == EventKind::field_entered) {
    green_inside_ = true;
  } else if (b == "green" && event.kind == EventKind::field_left) {
    green_inside_ = false;
  }
  seen_.push_back({event.time.seconds, event.kind, a, b, event.before_a.twist.linear,
                   event.after_a.twist.linear, event.before_b.twist.linear,
                   event.after_b.twist.linear, event.before_a.pose.position,
                   event.before_b.pose.position});
}

void StoryRecorder::frame(const Frame& frame) {
  const BodyState& green = frame.bodies[subject_of(*model_, "green")];
  if (green_turns_ < 0.0 && green_inside_ && green.twist.linear.y() > 0.0) {
    green_turns_ = frame.time.seconds;
  }
}

/// Walks through the captions; the first that does not come ends the story.
class StoryRecorder::Teller {
 public:
  explicit Teller(const StoryRecorder& run) : run_(run) {}

  Story tell() {
    (void)(falling() && floor_and_wall() && red_meets_blue() && red_meets_green() && conveyor());
    if (story_.complete) {
      choose_frames();
    }
    return std::move(story_);
  }

 private:
  using Filter = std::function<bool(const Seen&)>;

  /// Time of the first event of the kind between the two after `from`; infinite if there is none.
  const Seen* first(EventKind kind, std::string_view a, std::string_view b, double from) const {
    for (const Seen& seen : run_.seen_) {
      const bool pair = (seen.a == a && seen.b == b) || (seen.a == b && seen.b == a);
      if (seen.kind == kind && pair && seen.time > from) {
        return &seen;
      }
    }
    return nullptr;
  }
  const Seen* impact(std::string_view a, std::string_view b, double from) const {
    return first(EventKind::impact, a, b, from);
  }
  static const Vector3& before(const Seen& seen, std::string_view name) {
    return seen.a == name ? seen.before_a : seen.before_b;
  }
  static const Vector3& after(const Seen& seen, std::string_view name) {
    return seen.a == name ? seen.after_a : seen.after_b;
  }
  /// Whether `a` has impacts between the two times, other than those of the story.
  [[nodiscard]] bool quiet(std::string_view a, double from, double to) const {
    return std::none_of(run_.seen_.begin(), run_.seen_.end(), [&](const Seen& seen) {
      return seen.kind == EventKind::impact && (seen.a == a || seen.b == a) && seen.time > from &&
             seen.time < to;
    });
  }

  /// Within a ball's diameter of the floor's left end.
  [[nodiscard]] bool near_edge(const Vector3& red) const {
    const Model& model = *run_.model_;
    const Body& floor = model.body(subject_of(model, "floor"));
    const double end = floor.initial.pose.position.x() - bounding_box(floor.shape).half_extents.x();
    return red.x() - end < smallest_extent(model.body(subject_of(model, "red")).shape);
  }

  bool say(std::string_view what, int frame, bool told, double time) {
    if (!told) {
      story_.missing = what;
      return false;
    }
    story_.moments.push_back({what, time, frame});
    return true;
  }

  bool falling() {
    const Seen* meet = impact("red", "blue", 0.0);
    const Seen* enters = first(EventKind::field_entered, "agpad", "green", 0.0);
    const Seen* floor = impact("floor", "blue", 0.0);
    const bool there = meet != nullptr && enters != nullptr && floor != nullptr;
    red_blue_ = there ? meet->time : 0.0;
    green_in_ = there ? enters->time : 0.0;
    blue_floor_ = there ? floor->time : 0.0;
    const auto falls = [this](std::string_view name) {
      return run_.model_->body(subject_of(*run_.model_, std::string(name)))
                 .initial.twist.linear.y() < 0.0;
    };
    return say("all three balls travel downwards", 1,
               falls("red") && falls("blue") && falls("green"), 0.0) &&
           say("the red and the blue ball collide", 2,
               there && red_blue_ < blue_floor_ - apart && before(*meet, "red").y() < 0.0,
               red_blue_) &&
           say("the green ball goes into the well", 2, green_in_ < blue_floor_ - apart,
               green_in_) &&
           say("the blue ball collides with the floor", 3, after(*floor, "blue").y() > 0.0,
               blue_floor_);
  }

  bool floor_and_wall() {
    const Seen* wall = impact("wall", "blue", blue_floor_);
    const Seen* leaves = first(EventKind::field_left, "agpad", "green", green_in_);
    turns_ = run_.green_turns_;
    blue_wall_ = wall != nullptr ? wall->time : 0.0;
    green_out_ = leaves != nullptr ? leaves->time : 0.0;
    return say("the green ball turns upwards in the well", 3, turns_ > 0.0, turns_) &&
           say("the blue ball, moving up, hits the wall and goes left", 4,
               wall != nullptr && blue_wall_ > blue_floor_ + apart &&
                   before(*wall, "blue").y() > 0.0 && after(*wall, "blue").x() < 0.0,
               blue_wall_) &&
           say("the green ball comes out of the well", 4,
               leaves != nullptr && green_out_ > turns_ &&
                   std::max(blue_floor_, turns_) < std::max(blue_wall_, green_out_),
               green_out_);
  }

  bool red_meets_blue() {
    const Seen* floor = impact("floor", "red", 0.0);
    const Seen* meet = impact("red", "blue", blue_floor_);
    const double stage = std::max(blue_wall_, green_out_);
    red_blue_again_ = meet != nullptr ? meet->time : 0.0;
    return say("the red ball bounces off the floor", 5,
               floor != nullptr && meet != nullptr && floor->time < red_blue_again_ - apart,
               floor != nullptr ? floor->time : 0.0) &&
           say("red, rising, and blue collide: blue goes up, red down", 5,
               red_blue_again_ > stage + apart && before(*meet, "red").y() > 0.0 &&
                   after(*meet, "blue").y() > 0.0 && after(*meet, "red").y() < 0.0 &&
                   quiet("blue", blue_wall_, red_blue_again_),
               red_blue_again_);
  }

  bool red_meets_green() {
    const Seen* edge = impact("floor", "red", red_blue_again_);
    red_edge_ = edge != nullptr ? edge->time : 0.0;
    const Seen* enters =
        edge != nullptr ? first(EventKind::field_entered, "agpad", "red", 0.0) : nullptr;
    const Seen* meet = edge != nullptr ? impact("red", "green", red_edge_) : nullptr;
    red_green_ = meet != nullptr ? meet->time : 0.0;
    return say("the red ball bounces off the edge of the floor, going left", 6,
               edge != nullptr && after(*edge, "red").x() < 0.0 && after(*edge, "red").y() > 0.0 &&
                   near_edge(edge->a == "red" ? edge->place_a : edge->place_b) &&
                   quiet("red", red_blue_again_, red_edge_),
               red_edge_) &&
           say("the red ball enters the well", 7,
               enters != nullptr && meet != nullptr && enters->time > red_edge_ &&
                   enters->time <= red_green_,
               enters != nullptr ? enters->time : 0.0) &&
           say("red hits green, which goes up and left", 7,
               quiet("red", red_edge_, red_green_) && before(*meet, "red").y() > 0.0 &&
                   after(*meet, "green").x() < 0.0 && after(*meet, "green").y() > 0.0,
               red_green_);
  }

  bool conveyor() {
    const Seen* belt = impact("conveyor", "green", red_green_);
    belt_ = belt != nullptr ? belt->time : 0.0;
    const Seen* out = first(EventKind::field_left, "agpad", "red", red_green_);
    const Seen* bounce = impact("floor", "blue", red_green_);
    story_.complete =
        say("the red ball goes out of the well", 8, out != nullptr && out->time < belt_,
            out != nullptr ? out->time : 0.0) &&
        say("the blue ball bounces off the floor", 8, bounce != nullptr && bounce->time < belt_,
            bounce != nullptr ? bounce->time : 0.0) &&
        say("the green ball falls on the conveyor, a few seconds later", 9,
            belt_ > red_green_ + 1.5 && before(*belt, "green").y() < 0.0, belt_) &&
        say("and rises again, to the right", 9,
            after(*belt, "green").x() > 0.0 && after(*belt, "green").y() > 0.0 &&
                quiet("green", belt_, belt_ + 4.0 * apart),
            belt_);
    return story_.complete;
  }

  /// A frame after the collision of each caption; what else a caption tells comes at its own time.
  void choose_frames() {
    constexpr double frame = 1.0 / 60.0;
    story_.frames = {0.5 * std::min(red_blue_, green_in_),
                     red_blue_ + frame,
                     blue_floor_ + frame,
                     blue_wall_ + frame,
                     red_blue_again_ + frame,
                     red_edge_ + frame,
                     red_green_ + frame,
                     belt_ - 0.25,
                     belt_ + 4.0 * frame};
  }

  const StoryRecorder& run_;
  Story story_;
  double red_blue_ = 0.0;
  double green_in_ = 0.0;
  double blue_floor_ = 0.0;
  double turns_ = 0.0;
  double blue_wall_ = 0.0;
  double green_out_ = 0.0;
  double red_blue_again_ = 0.0;
  double red_edge_ = 0.0;
  double red_green_ = 0.0;
  double belt_ = 0.0;
};

Story StoryRecorder::story() const { return Teller(*this).tell(); }

}  // namespace kairos::experiments
