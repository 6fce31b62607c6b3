// Scenes in which impacts accumulate, or bodies stay in touch: event-driven says so and ends, and
// does not say so of what is finite. None of them may take more than a moment.

#include "core/reading/scene_reader.hpp"
#include "simulation/penetration.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/ledger_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

using namespace kairos;

namespace {

Simulation run(const std::string& text, const RunChoice& choice = {}) {
  return simulate(parse_scene(text, "test.toml"), choice);
}

std::string plane(const std::string& name, const std::string& normal,
                  const std::string& position = "[0, 0, 0]") {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"wall\"\nshape = \"half-space\"\nnormal = {}\nposition = "
      "{}\n",
      name, normal, position);
}

std::string ball(const std::string& name, double radius, double e, const std::string& position,
                 const std::string& velocity = "[0, 0, 0]", double mass = 1.0) {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"ball\"\nradius = {}\nmass = {}\nrestitution = "
      "{}\nposition = {}\nvelocity = {}\n",
      name, radius, mass, e, position, velocity);
}

std::string cube(const std::string& name, double half, double e, const std::string& position,
                 const std::string& rest = "") {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"body\"\nhalf_extents = [{}, {}, {}]\nmass = "
      "1.0\nrestitution = {}\nposition = {}\n{}\n",
      name, half, half, half, e, position, rest);
}

}  // namespace

TEST_CASE("a ball that slides down against a stopper comes to rest there", "[accumulation]") {
  const std::string text = "duration = 10\nG = 9.81\n" +
                           plane("plane", "[0.3420201433256687, 0.9396926207859084, 0]") +
                           plane("stopper", "[-1, 0, 0]", "[1, 0, 0]") +
                           ball("ball", 0.1, 0.0, "[-0.9657979856674331, 0.48038801151379357, 0]");
  const auto sim = run(text);
  INFO(sim.result.reason);
  CHECK(sim.result.status == RunStatus::completed);
  CHECK(sim.result.state[2].twist.linear == Vector3(0, 0, 0));
  CHECK(std::abs(sim.result.state[2].pose.position.x() - 0.9) <= 1e-9);
  tests::check_explained(sim.result.ledger);
}

TEST_CASE("a ball that slides over an obtuse edge onto another plane goes on", "[accumulation]") {
  // From 45 degrees to level, without restitution: what is normal to the level plane is lost.
  const std::string text = "duration = 2\nG = 10\n" + plane("slope", "[1, 1, 0]") +
                           plane("level", "[0, 1, 0]") + ball("ball", 0.1, 0.0, "[-1, 1.3, 0]");
  const auto sim = run(text);
  INFO(sim.result.reason);
  CHECK(sim.result.status == RunStatus::completed);
  CHECK(sim.result.state[2].pose.position.x() > 0.5);
  CHECK(std::abs(sim.result.state[2].pose.position.y() - 0.1) <= 1e-9);
}

/// All go on as one, with the momentum that they brought.
void check_together(const Simulation& sim, std::int64_t most_impacts) {
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  CHECK(sim.result.cost.impacts <= most_impacts);
  CHECK(sim.result.ledger.line(EnergyLine::zeno_completion) < 0.0);
  tests::check_explained(sim.result.ledger);
  Vector3 before = Vector3::Zero();
  Vector3 after = Vector3::Zero();
  for (BodyIndex i = 0; i < sim.result.state.size(); ++i) {
    before += sim.trajectory.motions(i).front().twist(0.0).linear;
    after += sim.result.state[i].twist.linear;
    const Vector3 apart = sim.result.state[i].twist.linear - sim.result.state[0].twist.linear;
    CHECK(apart.norm() <= 1e-14 * (1.0 + after.norm()));
  }
  CHECK((after - before).norm() <= 1e-13 * (1.0 + before.norm()));
}

TEST_CASE("three free balls collapse: found before relative velocities round to zero",
          "[accumulation]") {
  const auto text = [](double e) {
    const double own = std::sqrt(e);
    return "duration = 200\nframe = 2\nG = 0\n" + ball("a", 0.05, own, "[0, 0, 0]", "[1, 0, 0]") +
           ball("b", 0.05, own, "[1, 0, 0]", "[0.05, 0, 0]") +
           ball("c", 0.05, own, "[2, 0, 0]", "[-1, 0, 0]");
  };
  for (const double e : {1e-6, 0.01, 0.05}) {
    CAPTURE(e);
    check_together(run(text(e)), 50);
  }
  for (const double e : {0.075, 0.5, 1.0}) {  // above 7 - 4 sqrt(3)
    CAPTURE(e);
    const auto sim = run(text(e));
    INFO(sim.result.reason);
    CHECK(sim.result.status == RunStatus::completed);
  }
}

TEST_CASE("four free balls collapse, wherever they are going together", "[accumulation]") {
  for (const double drift : {0.0, 3.0, -300.0}) {
    const double own = std::sqrt(0.15);
    std::string text = "duration = 10\nframe = 2\nG = 0\n";
    for (int k = 0; k < 4; ++k) {
      text += ball(fmt::format("b{}", k), 0.05, own, fmt::format("[{}, 0, 0]", k),
                   fmt::format("[{}, 0, 0]", 1.0 - 2.0 * k / 3.0 + drift));
    }
    CAPTURE(drift);
    check_together(run(text), 120);
  }
}

TEST_CASE("a collapse that is as good as over holds no ball in the air", "[accumulation]") {
  // A ball goes on over the one below it, which a heavy one squeezes: its way along the surface is
  // not short because the collapse ends soon.
  const Simulation sim = run(
      "duration = 1.0\nframe = 0.07016015481961253\nG = 9.8\n" + plane("floor", "[0, 1, 0]") +
      ball("low", 0.2560236975890136, 0.9114078598607384, "[0, 0.2560236975890173, 0]") +
      ball("heavy", 0.2560236975890136, 0.619922288551173, "[0, 0.7680710927670518, 0]",
           "[0, 0, 0]", 954.1045225895784) +
      ball("high", 0.3223983172974174, 1.0, "[0, 1.346493107653491, 0]",
           "[0.9452236659396526, -0.5946669101050519, 0.8950491986957052]", 188.88144978170737));
  tests::check_explained(sim.result.ledger);
  double lowest = 1e300;  // it bounces on the floor and comes up again
  for (std::size_t k = 0; k < sim.trajectory.frame_times().size(); ++k) {
    lowest = std::min(lowest, sim.trajectory.frame_state(k)[3].pose.position.y());
  }
  CAPTURE(sim.result.reason, lowest);
  REQUIRE(sim.result.status == RunStatus::completed);
  CHECK(lowest < 0.5);
}

TEST_CASE("a finite sequence of impacts is not called infinite", "[accumulation]") {
  // A wall, a ball, and one of 100^k times its mass: floor(pi 10^k) impacts [Galperin2003].
  for (const auto& [mass, digits] : {std::pair{1e6, 3141}, std::pair{1e8, 31415}}) {
    const std::string text = "duration = 20\nframe = 20\nG = 0\n" + plane("wall", "[1, 0, 0]") +
                             ball("small", 0.05, 1.0, "[1, 0, 0]") +
                             ball("big", 0.05, 1.0, "[2, 0, 0]", "[-1, 0, 0]", mass);
    const auto sim = run(text);
    INFO(sim.result.reason);
    CHECK(sim.result.status == RunStatus::completed);
    CHECK(sim.result.cost.impacts == digits);
  }
}

TEST_CASE("pi to six digits by impacts", "[accumulation][slow]") {
  const std::string text = "duration = 20\nframe = 20\nG = 0\n" + plane("wall", "[1, 0, 0]") +
                           ball("small", 0.05, 1.0, "[1, 0, 0]") +
                           ball("big", 0.05, 1.0, "[2, 0, 0]", "[-1, 0, 0]", 1e10);
  const auto sim = run(text);
  INFO(sim.result.reason);
  CHECK(sim.result.status == RunStatus::completed);
  CHECK(sim.result.cost.impacts == 314159);
}

TEST_CASE("an elastic ball in air that damps it comes to rest", "[accumulation]") {
  const auto sim = run("duration = 3\n" + plane("floor", "[0, 1, 0]") +
                       ball("ball", 0.125, 1.0, "[0, 0.25, 0]", "[0, 0, 0]", 1e-3) +
                       "[[force]]\nkind = \"linear-drag\"\ncoefficient = 0.1\n");
  INFO(sim.result.reason);
  CHECK(sim.result.status == RunStatus::completed);
  CHECK(sim.result.state[1].twist.linear.norm() == 0.0);
  CHECK(std::abs(sim.result.state[1].pose.position.y() - 0.125) <= 1e-10);
  tests::check_explained(sim.result.ledger);
}

TEST_CASE("balls that a damped spring presses together come to rest in touch", "[accumulation]") {
  const std::string text = "duration = 4\nframe = 0.1\nG = 0\n" +
                           ball("a", 0.25, 0.5, "[0, 0, 0]", "[0, 0, 0]", 0.1) +
                           ball("b", 0.5, 0.5, "[2, 0, 0]", "[0, 0, 0]", 0.5) +
                           "[[force]]\nkind = \"spring\"\nstiffness = 100.0\ndamping = 0.5\nbodies "
                           "= [\"a\", \"b\"]\nrest_length = 0.5\n";
  const Simulation sim = run(text);
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  tests::check_explained(sim.result.ledger);
  const Model model(parse_scene(text, "test.toml"));
  CHECK_FALSE(PenetrationProbe(model).first(sim.result.state));
  // About the middle of both, which stays where it is.
  const double a = sim.result.state[0].pose.position.x();
  const double b = sim.result.state[1].pose.position.x();
  CHECK(std::abs(b - a - 0.75) < 1e-9);
  CHECK(std::abs(0.1 * a + 0.5 * b - 1.0) < 1e-9);
  CHECK(std::abs(sim.result.state[0].twist.linear.x()) < 1e-12);
}

TEST_CASE("a ball between walls that close on it: the time is told at which no room is left",
          "[accumulation]") {
  // One wall comes at 1 m/s; 0.8 m are left for the ball.
  const std::string text =
      "duration = 2\nframe = 0.1\nG = 0\n" + plane("wall", "[1, 0, 0]") +
      plane("press", "[-1, 0, 0]", "[1, 0, 0]") +
      "[body.drive]\namplitude = [-1, 0, 0]\nfrequency = " + fmt::format("{}", 0.5 / M_PI) + "\n" +
      ball("ball", 0.1, 1.0, "[0.5, 0, 0]", "[0.1, 0, 0]");
  const auto sim = run(text);
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::stopped);
  CHECK(sim.result.reason.find("close on 'ball': no room is left at t = 0.92") !=
        std::string::npos);  // sin t = 0.8
  CHECK(sim.result.cost.impacts < 10'000);
}

TEST_CASE("no room is left for a ball that lies on one of two walls, either", "[accumulation]") {
  // A press comes down on a ball of 2 m on the floor, where friction holds it.
  const std::string text =
      "duration = 2\nframe = 0.1\nG = 9.8\n" + plane("floor", "[0, 1, 0]") + "friction = 0.3\n" +
      plane("press", "[0, -1, 0]", "[0, 2.8, 0]") + "friction = 0.3\n" +
      "[body.drive]\namplitude = [0, -1, 0]\nfrequency = " + fmt::format("{}", 0.5 / M_PI) + "\n" +
      ball("ball", 1.0, 0.25, "[0, 1, 0]", "[0, 0, 0.1]") + "friction = 0.3\n";
  const auto sim = run(text);
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::stopped);
  CHECK(sim.result.reason.find("close on 'ball': no room is left at t = 0.92") !=
        std::string::npos);  // sin t = 0.8
}

TEST_CASE("more events in a frame than are allowed stop the run, and the bound can be moved",
          "[accumulation]") {
  const auto text = [](double speed) {
    return "duration = 1\nframe = 0.1\nG = 0\n" + plane("left", "[1, 0, 0]") +
           plane("right", "[-1, 0, 0]", "[1, 0, 0]") +
           ball("ball", 0.25, 1.0, "[0.5, 0, 0]", fmt::format("[{}, 0, 0]", speed));
  };
  // 200 impacts a frame.
  CHECK(run(text(1e3), {.max_events = 210}).result.status == RunStatus::completed);
  const auto few = run(text(1e3), {.max_events = 190});
  CHECK(few.result.status == RunStatus::stopped);
  CHECK(few.result.cost.impacts == 190);
  CHECK(few.result.reason.starts_with("too many events: more than 190 in one frame"));
  CHECK(few.result.reason.find("--max-events") != std::string::npos);
  const auto mad = run(text(1e12));
  INFO(mad.result.reason);
  CHECK(mad.result.status == RunStatus::stopped);
  CHECK(mad.result.cost.impacts <= 1'000'001);
}

TEST_CASE("no impact acts across a gap: what is undecided far from touch is looked at again",
          "[accumulation]") {
  struct Spin {
    double duration, speed, rate;
  };
  for (const auto& [duration, speed, rate] : {Spin{10.0, 0.2, 1e5}, Spin{1000.0, 0.002, 600.0}}) {
    // The face of a cube that turns about x meets the wall flat: after 1.5 m.
    const std::string text =
        fmt::format("duration = {}\nframe = {}\nG = 0\n", duration, duration / 100.0) +
        plane("wall", "[-1, 0, 0]", "[2, 0, 0]") +
        cube("cube", 0.5, 1.0, "[0, 0, 0]",
             fmt::format("velocity = [{}, 0, 0]\nangular_velocity = [{}, 0, 0]", speed, rate));
    const auto sim = run(text);
    INFO(sim.result.reason);
    CHECK(sim.result.status == RunStatus::completed);
    REQUIRE(sim.trajectory.events().size() == 1);
    const Event& impact = sim.trajectory.events().front();
    CHECK(std::abs(impact.contact.gap) <= 1e-8);
    CHECK(std::abs(impact.time.seconds * speed / 1.5 - 1.0) <= 1e-8);
  }
}

TEST_CASE("a ball that slides along a wall in touch: frames change nothing, and no impact is told",
          "[accumulation][invariance]") {
  const auto events = [](const char* frame) {
    const auto sim = run(fmt::format("duration = 2\nframe = {}\nG = 9.8\n", frame) +
                         plane("wall", "[-1, 0, 0]", "[2, 0, 0]") + plane("floor", "[0, 1, 0]") +
                         ball("ball", 0.5, 1.0, "[1.5, 2.5, 1]", "[0, 1, 0]"));
    INFO(sim.result.reason);
    CHECK(sim.result.status == RunStatus::completed);
    CHECK(sim.result.cost.impacts == 1);
    std::vector<Instant> times;
    for (const Event& event : sim.trajectory.events()) {
      times.push_back(event.time);
    }
    return times;
  };
  const std::vector<Instant> times = events("\"1/60\"");
  for (const char* frame : {"0.001", "0.1", "0.5", "2.0"}) {
    CAPTURE(frame);
    CHECK(events(frame) == times);
  }
}

TEST_CASE("a ball that slides off a block: where the origin is changes roundoff only",
          "[accumulation][invariance]") {
  // It comes to the edge 1 s after the start, and leaves it: v^2 > g r.
  const auto leaves = [](double x, double y, double z) {
    const auto sim =
        run(fmt::format("duration = 1.5\nframe = 0.015625\nG = 9.8\n[[body]]\nname = "
                        "\"block\"\nentity = \"wall\"\nhalf_extents = [2, 0.5, 2]\nposition = [{}, "
                        "{}, {}]\n",
                        x, y - 0.5, z) +
            ball("ball", 0.125, 0.0, fmt::format("[{}, {}, {}]", x + 0.75, y + 0.75, z),
                 "[0, 0, 2]", 2.0));
    INFO(sim.result.reason);
    CHECK(sim.result.status == RunStatus::completed);
    REQUIRE(sim.trajectory.events().size() == 3);
    const Event& end = sim.trajectory.events().back();
    CHECK(end.kind == EventKind::contact_ends);
    return end.time.seconds;
  };
  CHECK(std::abs(leaves(0.0, 0.0, 0.0) - 1.0) <= 1e-15);
  CHECK(std::abs(leaves(64.0, -32.0, 16.0) - 1.0) <= 1e-13);  // eps of the coordinates, at 2 m/s
  CHECK(std::abs(leaves(3.7, -100.3, 17.1) - 1.0) <= 1e-13);
}

// On a slanted line they are off it by roundoff, and slide along each other when they have met:
// nothing presses them, so that they go on by themselves, and no faster than as one.
TEST_CASE("balls that collapse in free flight go on side by side", "[accumulation]") {
  const double c = std::cos(0.7049);
  const double s = std::sin(0.7049);
  std::string text = "duration = 5.0\nframe = 0.125\nG = 0\n";
  const std::array speeds{3.0056, 1.3357, 0.28837, -1.41246, -3.00553};
  double momentum = 0.0;
  for (std::size_t k = 0; k < speeds.size(); ++k) {
    const double x = 8.626137551934007 * static_cast<double>(k);
    text += ball(fmt::format("ball-{}", k), 0.8626137551934007, 0.25452043560445264,
                 fmt::format("[{}, 0.3, {}]", x * c, x * s),
                 fmt::format("[{}, 0, {}]", speeds[k] * c, speeds[k] * s));
    momentum += speeds[k];
  }
  const auto sim = run(text);
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  tests::check_explained(sim.result.ledger);
  CHECK(sim.result.ledger.line(EnergyLine::zeno_completion) < 0.0);
  for (const BodyState& ball : sim.result.state) {
    const double along = c * ball.twist.linear.x() + s * ball.twist.linear.z();
    CHECK(std::abs(along - momentum / 5.0) <= 1e-9);
  }
}
