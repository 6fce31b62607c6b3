// A closed fist holds the ball (7.5), whatever the scheme: it is where the hand is, has no contacts
// until it is released and clear, and what that does to its energy is the hand's work.

#include "core/drives/track.hpp"
#include "core/error.hpp"
#include "core/reading/scene_reader.hpp"
#include "core/scene.hpp"
#include "simulation/registry.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/events.hpp"
#include "tests/simulation/ledger_check.hpp"
#include "tests/temporary_folder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace kairos;
using tests::of_kind;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// The fist closes around a falling ball at 0.25 s, carries it through a plate, and opens at 1 s,
/// while the hand goes on upwards with 1 m/s.
constexpr const char* track =
    "t,x,y,z,gesture\n0,0,0,0,0\n0.25,0,0,0,1\n1,2,0,0,0\n1.5,2,0.5,0,0\n";

const std::string text = R"(
duration = 2.0
frame = 0.015625
[[body]]
name = "plate"
entity = "wall"
half_extents = [0.01, 5, 5]
position = [1, 0, 0]
[[body]]
name = "hand"
entity = "hand"
half_extents = [0.1, 0.05, 0.1]
mass = 1.0
holds = "ball"
drive = {track = "hand.csv"}
[[body]]
name = "ball"
entity = "ball"
radius = 0.02
mass = 2.0
position = [-3, 1, 0]
)";

class Folder {
 public:
  Folder() { folder_.file("hand.csv", track); }
  [[nodiscard]] Scene scene(const std::vector<Override>& overrides = {}) const {
    return parse_scene(text, folder_.path("scene.toml"), overrides);
  }

 private:
  tests::TemporaryFolder folder_;
};

/// Every scheme with an integrator that is exact in flight.
std::vector<RunChoice> choices() {
  std::vector<RunChoice> result;
  for (const auto& scheme : schemes()) {
    if (!scheme->info().integrator.empty()) {
      continue;  // steps over contacts: knows no hands, and refuses them
    }
    result.push_back(
        {.method = {std::string(scheme->info().name), "closed-form", "certified", "newton"}});
  }
  return result;
}

/// Remembers the drawn frames.
class Frames : public Recorder {
 public:
  struct Seen {
    double time;
    BodyState hand, ball;
    bool in_hand;
  };
  void frame(const Frame& frame) override {
    seen.push_back({frame.time.seconds, frame.bodies[1], frame.bodies[2], frame.in_hand[2] != 0});
  }
  void event(const Event& event) override {
    impacts_of_ball += event.kind == EventKind::impact && (event.a == 2 || event.b == 2) ? 1 : 0;
  }
  std::vector<Seen> seen;
  int impacts_of_ball = 0;
};

}  // namespace

TEST_CASE("hand: its closed fist carries the ball, through walls too", "[hand]") {
  const Folder folder;
  const Model model(folder.scene());
  for (const auto& choice : choices()) {
    INFO(choice.method.scheme);
    Frames frames;
    const RunResult result = simulate(model, choice, frames);
    CHECK(result.status == RunStatus::completed);
    CHECK(frames.impacts_of_ball == 0);
    // A frame is drawn before the events of the same instant are taken.
    const bool drawn_first = choice.method.scheme == "event-driven";
    for (const Frames::Seen& f : frames.seen) {
      INFO(f.time);
      if (f.time < 0.25 || (f.time == 0.25 && drawn_first)) {
        CHECK_FALSE(f.in_hand);
        CHECK(f.ball.pose.position.x() == -3.0);
      } else if (f.time < 1.0) {
        CHECK(f.in_hand);
        CHECK(f.ball.pose.position == f.hand.pose.position);
        CHECK(f.ball.twist.linear == f.hand.twist.linear);
      } else {
        // Thrown upwards with the hand's 1 m/s. Roundoff: a few products near 5.
        const double s = f.time - 1.0;
        CHECK((f.ball.pose.position - Vector3(2, s - 4.9 * s * s, 0)).norm() < 64 * eps);
        // The ball falls out of the hand's lower face: 4.9 s^2 = 0.07.
        const bool clear = 4.9 * s * s > 0.07;
        CHECK(f.in_hand == !clear);
      }
    }
  }
}

TEST_CASE("hand: grasps and releases are events, at the tracker's time from event to event",
          "[hand]") {
  const Folder folder;
  for (const auto& choice : choices()) {
    INFO(choice.method.scheme);
    const auto simulation = simulate(folder.scene(), choice);
    const auto grasped = of_kind(simulation.trajectory, EventKind::grasped);
    const auto released = of_kind(simulation.trajectory, EventKind::released);
    REQUIRE(grasped.size() == 1);
    REQUIRE(released.size() == 1);
    CHECK(grasped[0].time.seconds == 0.25);
    CHECK(released[0].time.seconds == 1.0);
    CHECK(grasped[0].a == 1);
    CHECK(grasped[0].b == 2);
  }
  // A frame that does not fall on the sample is late, an event is not.
  auto late = choices().front();
  late.frames = FixedFrames{0.07};
  late.method.scheme = "original";
  CHECK(of_kind(simulate(folder.scene(), late).trajectory, EventKind::released)[0].time.seconds ==
        Approx(1.05));
  late.method.scheme = "event-driven";
  CHECK(of_kind(simulate(folder.scene(), late).trajectory, EventKind::released)[0].time.seconds ==
        1.0);
}

TEST_CASE("hand: what it does to the ball's energy is its work, to the last joule", "[hand]") {
  const Folder folder;
  for (auto choice : choices()) {
    for (const char* integrator : {"closed-form", "thesis-euler", "rk4"}) {
      choice.method.integrator = integrator;
      INFO(choice.method.scheme << " " << integrator);
      const RunResult result = simulate(folder.scene(), choice).result;
      const EnergyLedger& ledger = result.ledger;
      tests::check_explained(ledger);
      // Caught at (1 - 4.9/16) m with speed 9.8/4, let go at y = 0 with 1 m/s.
      if (choice.method.integrator == std::string("closed-form")) {
        CHECK(ledger.line(EnergyLine::conveyor_and_hand) == Approx(1.0 - 2.0 * 9.8).epsilon(1e-13));
      }
    }
  }
}

TEST_CASE("hand: `release` says how much of the hand's velocity is kept", "[hand]") {
  const Folder folder;
  const Scene scene = folder.scene({{"body.hand.release", "0"}});
  for (const auto& choice : choices()) {
    INFO(choice.method.scheme);
    const auto simulation = simulate(scene, choice);
    CHECK(simulation.result.state[2].pose.position.y() == Approx(-4.9).epsilon(1e-13));
  }
}

TEST_CASE("hand: open and clear, it is as solid as a bat", "[hand]") {
  const Folder folder;
  // Caught never: the ball falls on the open hand.
  const Scene scene = folder.scene({{"body.ball.position", "[0, 0.3, 0]"},
                                    {"duration", "0.24"},
                                    {"body.plate.bounds", "\"obb\""}});
  for (const auto& choice : choices()) {
    INFO(choice.method.scheme);
    CHECK(simulate(scene, choice).result.cost.impacts == 1);
  }
}

TEST_CASE("hand: a fist that is closed at the start holds the ball from the start", "[hand]") {
  const Folder folder;
  Scene scene = folder.scene();
  scene.bodies[1].drive = std::make_shared<const Track>(std::vector<TrackSample>{{0.0, {}, true}},
                                                        Track::Options{.gestures = true});
  scene.bodies[1].initial = {};
  scene.bodies[2].initial.pose.position = Vector3::Zero();  // inside the hand: no overlap
  for (const auto& choice : choices()) {
    INFO(choice.method.scheme);
    const auto simulation = simulate(scene, choice);
    CHECK(simulation.result.status == RunStatus::completed);
    CHECK(simulation.result.state[2].pose.position.norm() == 0.0);
  }
}

TEST_CASE("hand: what it cannot hold is refused by name", "[hand][input]") {
  const Folder folder;
  const auto reason = [&](const std::vector<Override>& overrides) -> std::string {
    try {
      const Model model(folder.scene(overrides));
    } catch (const InputError& error) {
      return error.what();
    }
    return "was not refused";
  };
  CHECK(reason({{"body.hand.holds", "\"bal\""}}).find("no \"bal\"") != std::string::npos);
  CHECK(reason({{"body.hand.holds", "\"plate\""}}).find("does not move freely") !=
        std::string::npos);
  CHECK(reason({{"body.hand.holds", "3"}}).find("body.hand.holds") != std::string::npos);
  CHECK(reason({{"body.plate.holds", "\"ball\""}}).find("allowed: for hands") != std::string::npos);
  CHECK(reason({{"body.hand.drive", "{frequency = 1, amplitude = [1, 0, 0]}"}}).find("gesture") !=
        std::string::npos);
}

TEST_CASE("hand: what it lets go of inside a solid stops the run, and says of whom and how deep",
          "[hand]") {
  const std::string scene = R"(
duration = 3.0
frame = 0.25
G = 0.0
[[body]]
name = "floor"
entity = "wall"
shape = "half-space"
[[body]]
name = "ball"
entity = "ball"
radius = 0.1
mass = 1.0
position = [0, 1, 0]
[[body]]
name = "hand"
entity = "hand"
radius = 0.05
mass = 1.0
holds = "ball"
drive = {track = "hand.csv"}
)";
  const tests::TemporaryFolder folder;
  const auto released_at = [&](double height, const char* then, const auto& choice) {
    folder.file("hand.csv",
                "t,x,y,z,gesture\n0,0,1,0,1\n1,0," + std::to_string(height) + ",0,0\n" + then);
    return simulate(parse_scene(scene, folder.path("scene.toml")), choice);
  };
  for (const auto& choice : choices()) {
    INFO(choice.method.scheme);
    for (const char* then : {"1.1,0,-1.1,0,0\n2,5,-1.1,0,0\n", "1.1,0,-0.9,0,0\n2,5,-0.9,0,0\n"}) {
      const auto sim = released_at(-1.0, then, choice);
      INFO(sim.result.reason);
      CHECK(sim.result.status == RunStatus::stopped);
      CHECK(sim.result.end.seconds == 1.0);
      CHECK(sim.result.reason.find("'ball'") != std::string::npos);
      CHECK(sim.result.reason.find("1.1 m inside 'floor'") != std::string::npos);
      // Of the hand itself with the floor the frame-based schemes tell: nobody moves those.
      for (const Event& event : sim.trajectory.events()) {
        CHECK_FALSE((event.kind == EventKind::impact && (event.a == 1 || event.b == 1)));
      }
    }
    // Let go of where it touches the floor, at rest: nothing is wrong.
    const auto laid = released_at(0.1, "1.1,0,1,0,0\n2,5,1,0,0\n", choice);
    INFO(laid.result.reason);
    CHECK(laid.result.status == RunStatus::completed);
  }
}

TEST_CASE("hand: what drifts into a solid before it is clear of the hand stops the run too",
          "[hand]") {
  // Let go of at (0, 0), 0.9 m before the plate, by a large hand that goes on with it.
  const tests::TemporaryFolder folder;
  folder.file("hand.csv",
              "t,x,y,z,gesture\n0,0,0,0,1\n0.5,0.5,0,0,1\n1,1,0,0,0\n2,2,0,0,0\n"
              "3,2,9,0,0\n");
  const Scene scene = parse_scene(
      "duration = 4\nframe = 0.125\nG = 0\n[[body]]\nname = \"plate\"\nentity = \"wall\"\n"
      "shape = \"half-space\"\nnormal = [-1, 0, 0]\nposition = [1.5, 0, 0]\n[[body]]\n"
      "name = \"hand\"\nentity = \"hand\"\nradius = 0.2\nmass = 1\nholds = \"ball\"\n"
      "drive = {track = \"hand.csv\"}\n[[body]]\nname = \"ball\"\nentity = \"ball\"\n"
      "radius = 0.1\nmass = 1\n",
      folder.path("scene.toml"));
  for (const auto& choice : choices()) {
    const auto sim = simulate(scene, choice);
    INFO(choice.method.scheme << ": " << sim.result.reason);
    CHECK(sim.result.status == RunStatus::stopped);
    CHECK(sim.result.reason.find("inside 'plate'") != std::string::npos);
    CHECK(sim.result.end.seconds > 2.0);
  }
}
