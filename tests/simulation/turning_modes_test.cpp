// Bodies that turn while they touch, in event-driven runs, against what is known to twelve digits.

#include "core/reading/scene_reader.hpp"
#include "simulation/penetration.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/ledger_check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

using namespace kairos;

namespace {

constexpr double g = 9.8;

std::string head(double duration, const std::string& mu) {
  return fmt::format(
      "duration = {}\nframe = \"1/60\"\nG = {}\nfriction = {}\n"
      "[[body]]\nname = \"floor\"\nentity = \"wall\"\nshape = \"half-space\"\n",
      duration, g, mu);
}

std::string at(const Vector3& p) { return fmt::format("[{}, {}, {}]", p.x(), p.y(), p.z()); }

std::string box(const Vector3& half, const Vector3& p, double e, const std::string& rest) {
  return fmt::format(
      "[[body]]\nname = \"box\"\nentity = \"body\"\nhalf_extents = {}\nmass = 1.0\nrestitution = "
      "{}\nposition = {}\n{}\n",
      at(half), e, at(p), rest);
}

Simulation run(const std::string& text) { return simulate(parse_scene(text, "test.toml"), {}); }

/// It ends, the ledger closes, and no two bodies overlap at any frame.
void check_whole(const Simulation& sim, const std::string& text) {
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  tests::check_explained(sim.result.ledger);
  const Model model(parse_scene(text, "test.toml"));
  const PenetrationProbe probe(model);
  for (std::size_t k = 0; k < sim.trajectory.frame_times().size(); ++k) {
    CHECK_FALSE(probe.first(sim.trajectory.frame_state(k)));
  }
  CHECK(sim.result.ledger.line(EnergyLine::friction) <= 0.0);
  CHECK(sim.result.ledger.line(EnergyLine::impact_friction) <= 1e-15);
}

/// Events with a velocity that jumps, by their times.
std::vector<Event> impacts(const Simulation& sim) {
  std::vector<Event> found;
  for (const Event& event : sim.trajectory.events()) {
    if (event.kind == EventKind::impact) {
      found.push_back(event);
    }
  }
  return found;
}

/// Standing on its lower edge at +x, turned about it by `angle`.
std::string rocking(double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return head(6.0, "inf") + box({0.1, 0.4, 0.1}, {-0.1 * c + 0.4 * s, 0.1 * s + 0.4 * c, 0.0}, 0.0,
                                fmt::format("axis_angle = [0, 0, 1, {}]", -angle));
}

}  // namespace

// The gap at which corners strike, 1e-10 of the box, shows in times as that over 0.08 m/s: 2e-10 s,
// and adds up over the impacts.
TEST_CASE("turning 8: a box rocks from edge to edge and comes to rest", "[turning][reference]") {
  const std::string text = rocking(0.1);
  const auto sim = run(text);
  check_whole(sim, text);
  const std::vector<Event> hits = impacts(sim);
  REQUIRE(hits.size() > 20);
  CHECK(std::abs(hits[0].time.seconds - 0.264848439164) <= 1e-9);
  CHECK(std::abs(hits[1].time.seconds - 0.711263621508) <= 1e-8);
  CHECK(std::abs(hits[10].time.seconds - 2.98013354213) <= 1e-8);
  const double before = hits[0].before_a.twist.angular.norm();
  const double after = hits[0].after_a.twist.angular.norm();
  CHECK(std::abs(before - 0.830944233655) <= 1e-9);
  CHECK(std::abs(after / before - 0.911764705882) <= 1e-9);
  // It rests at 4.57374056133: what rocks below the height that counts as rest is not followed.
  CHECK(std::abs(hits.back().time.seconds - 4.57374056133) <= 2e-3);
  CHECK(sim.result.state[1].twist.angular == Vector3(0, 0, 0));
}

TEST_CASE("turning: a tilted box that is dropped lands, and comes to rest", "[turning]") {
  for (const double e : {0.0, 0.3, 0.6}) {
    for (const char* const mu : {"0", "0.5"}) {
      CAPTURE(e, mu);
      const std::string text =
          head(4.0, mu) + box({0.3, 0.2, 0.4}, {0, 1, 0}, e,
                              "axis_angle = [1, 0.5, 2, 0.7]\nvelocity = [1, 0, 0.5]");
      const auto sim = run(text);
      check_whole(sim, text);
      const BodyState& end = sim.result.state[1];
      CHECK(std::abs(end.twist.linear.y()) <= 1e-9);
      const bool rubs = std::string(mu) != "0";
      CHECK((!rubs || end.twist.linear.norm() + end.twist.angular.norm() <= 1e-9));
    }
  }
}

TEST_CASE("turning 1: a tall block that slides tips where friction is more than b/h",
          "[turning][reference]") {
  const std::string text =
      head(4.0, "0.3") + box({0.1, 0.4, 0.1}, {0, 0.4, 0}, 0.0, "velocity = [3, 0, 0]");
  const auto sim = run(text);
  check_whole(sim, text);
  double most = 0.0;
  for (std::size_t k = 0; k < sim.trajectory.frame_times().size(); ++k) {
    most = std::max(most, std::abs(sim.trajectory.frame_state(k)[1].twist.angular.z()));
  }
  CHECK(most > 0.1);
  // It slides against mu N throughout: when it stops does not depend on N where that is the weight.
  CHECK(sim.result.state[1].twist.linear == Vector3(0, 0, 0));
}

TEST_CASE("turning: a ball that strikes a resting box off its centre sets it rocking",
          "[turning]") {
  const auto sim = run(head(0.7, "0.3") + box({0.5, 0.5, 0.5}, {0, 0.5, 0}, 0.6, "") +
                       "[[body]]\nname = \"ball\"\nentity = \"ball\"\nradius = 0.5\nmass = 1.0\n"
                       "position = [0.2, 3, 0.1]\n");
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  tests::check_explained(sim.result.ledger);
}
