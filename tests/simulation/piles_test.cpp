// Many bodies that come to rest on each other with friction: what forces at an instant do not tell.

#include "core/random.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/penetration.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/ledger_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

using namespace kairos;

namespace {

constexpr double radius = 0.05;

/// Balls in layers, askew, over the floor of a bin.
std::string bin(int count, double half, std::uint64_t seed, double duration) {
  std::string text = fmt::format(
      "name = \"bin\"\nduration = {}\nframe = \"1/60\"\nG = 9.8\nfriction = 0.3\n", duration);
  const auto wall = [&](const char* name, const std::string& at, const std::string& normal) {
    text += fmt::format(
        "[[body]]\nname = \"{}\"\nentity = \"wall\"\nshape = \"half-space\"\nposition = [{}]\n"
        "normal = [{}]\n",
        name, at, normal);
  };
  wall("floor", "0, 0, 0", "0, 1, 0");
  wall("left", fmt::format("{}, 0, 0", -half), "1, 0, 0");
  wall("right", fmt::format("{}, 0, 0", half), "-1, 0, 0");
  wall("back", fmt::format("0, 0, {}", -half), "0, 0, 1");
  wall("front", fmt::format("0, 0, {}", half), "0, 0, -1");
  constexpr double pitch = 0.115;
  const int row = static_cast<int>((2.0 * half - 0.02) / pitch);
  Random random(seed);
  for (int k = 0; k < count; ++k) {
    const int layer = k / (row * row);
    const double x = -half + 0.07 + (k % row) * pitch + random.uniform(-0.005, 0.005);
    const double z = -half + 0.07 + (k / row % row) * pitch + random.uniform(-0.005, 0.005);
    const double y = 0.1 + 0.125 * layer + random.uniform(0.0, 0.01);
    text += fmt::format(
        "[[body]]\nname = \"ball-{}\"\nentity = \"ball\"\nradius = {}\nmass = 1.0\n"
        "restitution = 0.6\nposition = [{}, {}, {}]\n",
        k, radius, x, y, z);
  }
  return text;
}

Vector3 centre(const Simulation& sim, Instant t, BodyIndex i) {
  return sim.trajectory.at(i, t).pose.position;
}

/// At random times no two balls overlap, and none a wall, by the distances of their centres.
void check_apart(const Simulation& sim, int count, double half, double duration, int times) {
  Random random(7);
  double least = 1.0;
  for (int k = 0; k < times; ++k) {
    const Instant t{random.uniform(0.0, duration), 0.0};
    std::vector<Vector3> at;
    for (int i = 0; i < count; ++i) {
      at.push_back(centre(sim, t, static_cast<BodyIndex>(5 + i)));
      const Vector3& p = at.back();
      least = std::min({least, p.y() - radius, half - std::abs(p.x()) - radius,
                        half - std::abs(p.z()) - radius});
      for (int j = 0; j < i; ++j) {
        least = std::min(least, (p - at[static_cast<std::size_t>(j)]).norm() - 2.0 * radius);
      }
    }
  }
  // Positions are told by polynomials of the size of the bin: a few of its roundoffs.
  CHECK(least >= -1e-15);
}

void check_pile(int count, double half, std::uint64_t seed, int times) {
  constexpr double duration = 3.0;
  CAPTURE(count, seed);
  const auto sim = simulate(parse_scene(bin(count, half, seed, duration), "bin.toml"), {});
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  tests::check_explained(sim.result.ledger);
  CHECK(sim.result.ledger.line(EnergyLine::friction) <= 0.0);
  for (std::size_t i = 5; i < sim.result.state.size(); ++i) {
    CHECK(sim.result.state[i].twist.linear == Vector3(0, 0, 0));
    CHECK(sim.result.state[i].twist.angular == Vector3(0, 0, 0));
  }
  // Of some 400 J steps are off by less than a millionth: they are of first order, and short.
  CHECK(std::abs(sim.result.ledger.line(EnergyLine::truncation)) <= 1e-6 * 4.0 * count);
  check_apart(sim, count, half, duration, times);
}

}  // namespace

TEST_CASE("piles: ten balls in a bin come to rest, with friction", "[piles]") {
  check_pile(10, 0.15, 1, 200);
}

TEST_CASE("piles: more balls in a bin come to rest, with friction", "[piles][slow]") {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    check_pile(10, 0.15, seed, 200);
    check_pile(40, 0.25, seed, 200);
  }
}

TEST_CASE("piles: a hundred balls in a bin, at ten thousand random times", "[piles][slow]") {
  check_pile(100, 0.25, 1, 10'000);
}

TEST_CASE("piles: a row of balls in touch that a heavy one comes into, inelastic, goes on",
          "[piles]") {
  const std::string text = [] {
    std::string out = "duration = 1.0\nframe = \"1/60\"\nG = 0\n";
    double x = 0.0;
    char name = 'a';
    for (const auto& [r, m, e] : {std::tuple{0.2, 540.0, 1.0},
                                  {0.1, 0.5, 0.4},
                                  {0.1, 1.0, 0.6},
                                  {0.05, 0.01, 0.3},
                                  {0.1, 2.0, 0.5}}) {
      x += r;
      out += fmt::format(
          "[[body]]\nname = \"{}\"\nentity = \"ball\"\nradius = {}\nmass = {}\nrestitution = "
          "{}\nposition = [{}, 0, 0]\nvelocity = [{}, 0, 0]\n",
          name++, r, m, e, x, m == 540.0 ? 1.0 : 0.0);
      x += r;
    }
    return out;
  }();
  const auto sim = simulate(parse_scene(text, "row.toml"), {});
  INFO(sim.result.reason);
  REQUIRE(sim.result.status == RunStatus::completed);
  tests::check_explained(sim.result.ledger);
  double momentum = 0.0;
  const double mass[] = {540.0, 0.5, 1.0, 0.01, 2.0};
  for (std::size_t i = 0; i < 5; ++i) {
    momentum += mass[i] * sim.result.state[i].twist.linear.x();
    // Whoever is behind is no faster than who is before it.
    CHECK((i == 0 || sim.result.state[i].twist.linear.x() >=
                         sim.result.state[i - 1].twist.linear.x() - 1e-12));
  }
  CHECK(std::abs(momentum - 540.0) <= 540.0 * 1e-13);
}
