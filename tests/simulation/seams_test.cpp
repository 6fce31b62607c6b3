// What slides or rolls over a level seam between two bodies does not strike the second one's side.

#include "core/random.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/ledger_check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

using namespace kairos;

namespace {

std::string at(const Vector3& p) { return fmt::format("[{}, {}, {}]", p.x(), p.y(), p.z()); }

}  // namespace

TEST_CASE("seams: what slides or rolls from one tile onto the next goes straight on", "[modes]") {
  constexpr std::uint64_t seed = 20261123;
  for (std::uint64_t k = 0; k < 60; ++k) {
    Random random(seed, k);
    const auto pick = [&](std::initializer_list<double> from) {
      return from.begin()[random.below(from.size())];
    };
    const bool round = random.below(3) == 0;
    const double gap = round ? 0.0 : pick({0.0, 0.0, 0.02, 0.1});  // a ball would fall into it
    const double speed = pick({0.5, 1.0, 3.0, 8.0});
    const double friction = round ? pick({0.0, 0.3}) : 0.0;
    const double height = round ? 0.15 : 0.1;
    const Quaternion turn(Eigen::AngleAxisd(pick({0.0, 0.4, 1.3}), Vector3::UnitY()));
    const Eigen::AngleAxisd turned(turn);
    const std::string angle = fmt::format("axis_angle = [0, 1, 0, {}]\n", turned.angle());
    const Vector3 velocity = turn * Vector3(speed, 0.0, round ? 0.0 : pick({0.0, 0.2}));
    const Vector3 start = turn * Vector3(-0.5, height, 0.0);
    std::string text = fmt::format("duration = {}\nframe = 0.05\nG = 9.8\nfriction = {}\n",
                                   std::min(1.2 / speed, 2.0), friction);
    for (const double side : {-1.0, 1.0}) {
      const double x = side < 0.0 ? -1.0 : 1.0 + gap;
      text += fmt::format("[[body]]\nname = \"tile{}\"\nentity = \"wall\"\n", side < 0.0 ? 1 : 2);
      // One in five tiles is a flat end of a plane, in which the other lies flush.
      text += side < 0.0 && k % 5 == 0
                  ? std::string("shape = \"half-space\"\n")
                  : "half_extents = [1, 0.1, 1]\n" + angle +
                        "position = " + at(turn * Vector3(x, -0.1, 0.0)) + "\n";
    }
    text += fmt::format(
        "[[body]]\nname = \"mover\"\nentity = \"body\"\nmass = 1\nposition = {}\n"
        "velocity = {}\nrestitution = {}\n",
        at(start), at(velocity), pick({0.0, 0.5, 1.0}));
    text += round ? "shape = \"sphere\"\nradius = 0.15\nangular_velocity = " +
                        at(Vector3::UnitY().cross(velocity) / height) + "\n"
                  : "half_extents = [0.2, 0.1, 0.2]\n" + angle;
    const Simulation sim = simulate(parse_scene(text, "seam.toml"), {});
    CAPTURE(k, round, gap, speed, friction, sim.result.reason);
    REQUIRE(sim.result.status == RunStatus::completed);
    tests::check_explained(sim.result.ledger);
    CHECK(sim.result.cost.impacts == 0);
    const BodyState& end = sim.result.state.back();
    const Vector3 expected = start + sim.result.end.seconds * velocity;
    // Held gaps are 1e-10 of the size; nothing pushes along the way.
    CHECK((end.pose.position - expected).norm() < 1e-9);
    CHECK((end.twist.linear - velocity).norm() < 1e-9 * speed);
  }
}
