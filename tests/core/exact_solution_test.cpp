// Exact solutions against the numbers of the literature, and against themselves.

#include "core/exact_solution.hpp"

#include "core/error.hpp"
#include "core/reading/scene_reader.hpp"
#include "tests/catch.hpp"
#include "tests/locations.hpp"

#include <cmath>

using namespace kairos;

namespace {

const std::string scenes = tests::source_path("scenes/");

/// A ball of radius 0.1 dropped from a gap H.
std::unique_ptr<const ExactMotion> drop(const std::string& name, const std::string& H,
                                        const std::string& g, const std::string& e) {
  return solve_exactly(parse_scene(
      "G = " + g + "\n[[body]]\nname = \"floor\"\nentity = \"wall\"\nshape = \"half-space\"\n" +
          "position = [0, -0.1, 0]\n[[body]]\nname = \"ball\"\nentity = \"ball\"\nradius = 0.1\n" +
          "mass = 1\nposition = [0, " + H + ", 0]\nrestitution = " + e +
          "\n[exact]\nsolution = \"" + name + "\"",
      ""));
}

}  // namespace

TEST_CASE("elastic drop: the k-th impact is at (2k-1) sqrt(2H/g)", "[exact]") {
  const auto exact = drop("elastic-drop", "4.9", "9.81", "1");
  CHECK(*exact->impact_time(1) == Approx(0.9994901860).epsilon(1e-10));
  for (const std::int64_t k : {1, 2, 10, 1000000}) {
    const double expected = (2.0 * static_cast<double>(k) - 1.0) * std::sqrt(2.0 * 4.9 / 9.81);
    // Roundoff of the formula in double.
    CHECK(*exact->impact_time(k) == Approx(expected).epsilon(1e-15));
  }
  CHECK_FALSE(exact->impact_time(0).has_value());
  CHECK_FALSE(exact->rest_time().has_value());
  CHECK_FALSE(exact->state(0, Instant{}).has_value());
  // Energy is the same at any time, the height periodic.
  const double period = 2.0 * *exact->impact_time(1);
  for (const double t : {0.0, 0.3, 1.0, 2.0, 77.7, 1e5}) {
    const BodyState s = *exact->state(1, Instant{t});
    const double energy = 0.5 * s.twist.linear.squaredNorm() + 9.81 * s.pose.position.y();
    INFO(t);
    CHECK(energy == Approx(9.81 * 4.9).epsilon(1e-14));
    const BodyState later = *exact->state(1, Instant{t} + period);
    CHECK(later.pose.position.y() == Approx(s.pose.position.y()).margin(1e-13));
  }
}

TEST_CASE("inelastic drop: Zeno's rest", "[exact]") {
  CHECK(*drop("inelastic-drop", "1", "9.8", "0.5")->rest_time() ==
        Approx(1.3552618543578769).epsilon(1e-15));
  const auto fmi = drop("inelastic-drop", "1", "9.81", "0.7");
  CHECK(*fmi->impact_time(1) == Approx(0.4515236409857309).epsilon(1e-15));
  CHECK(*fmi->rest_time() == Approx(2.558633965586).epsilon(1e-12));
  const auto siconos = drop("inelastic-drop", "1", "9.81", "0.9");
  CHECK(*siconos->impact_time(44) == Approx(8.49137402565).epsilon(1e-11));
  CHECK(*siconos->impact_time(45) > 8.5);
  CHECK(*siconos->rest_time() == Approx(8.5789491787).epsilon(1e-10));
  // Continuous across an impact, which takes e of the speed; at rest for ever after.
  for (const std::int64_t k : {1, 2, 7, 20}) {
    const double t = *siconos->impact_time(k);
    const BodyState before = *siconos->state(1, Instant{t} - 1e-9);
    const BodyState after = *siconos->state(1, Instant{t} + 1e-9);
    CHECK(before.pose.position.y() == Approx(0.0).margin(1e-8));
    CHECK(after.pose.position.y() == Approx(0.0).margin(1e-8));
    CHECK(after.twist.linear.y() == Approx(-0.9 * before.twist.linear.y()).epsilon(1e-6));
  }
  const BodyState rest = *siconos->state(1, Instant{9.0});
  CHECK(rest.pose.position.y() == Approx(0.0).margin(1e-16));
  CHECK(rest.twist.linear == Vector3::Zero());
  // e = 0 rests at once.
  const auto clay = drop("inelastic-drop", "1", "9.8", "0");
  CHECK(*clay->rest_time() == *clay->impact_time(1));
}

TEST_CASE("cradle: two in, two out", "[exact]") {
  const auto exact = solve_exactly(read_scene(scenes + "cradle.toml"));
  std::int64_t impacts = 0;
  while (exact->impact_time(impacts + 1)) {
    ++impacts;
  }
  CHECK(impacts == 6);
  const std::vector<double> speeds = {0, 0, 0, 1, 1};
  for (BodyIndex i = 0; i < 5; ++i) {
    CHECK(exact->state(i, Instant{2.0})->twist.linear.x() == speeds[i]);
  }
  // The third is left where the gap before it and the row put it.
  CHECK(exact->state(0, Instant{0.0})->pose.position.x() == Approx(-0.701));
  CHECK(exact->state(2, Instant{2.0})->pose.position.x() == Approx(0.002).margin(1e-15));
}

TEST_CASE("reflection: there and back", "[exact]") {
  const auto exact = solve_exactly(read_scene(scenes + "bullet.toml"));
  CHECK(*exact->impact_time(1) == Approx(0.0485).epsilon(1e-15));
  CHECK_FALSE(exact->impact_time(2).has_value());
  CHECK(exact->state(1, Instant{0.097})->pose.position.x() == Approx(-1.0).epsilon(1e-15));
  CHECK(exact->state(1, Instant{0.097})->twist.linear.x() == -20.0);
}

TEST_CASE("exact solutions: a scene that is another one is told so", "[exact]") {
  const std::string bounce = scenes + "bounce.toml";
  const std::vector<Override> changes = {
      {"body.ball.restitution", "0.5"},       {"body.ball.G", "0"},
      {"body.floor.normal", "[0, 0, 1]"},     {"body.ball.position[1]", "-5"},
      {"exact.solution", "\"equal-masses\""}, {"exact.solution", "\"reflection\""}};
  for (const Override& change : changes) {
    INFO(change.key);
    CHECK_THROWS_AS(solve_exactly(read_scene(bounce, {change})), InputError);
  }
}

TEST_CASE("drag drop: the table-tennis ball's first impact, and the energy of every bounce",
          "[exact]") {
  const Scene scene = read_scene(scenes + "drag-drop.toml");
  const auto exact = solve_exactly(scene);
  REQUIRE(exact != nullptr);
  const double first = *exact->impact_time(1);
  CHECK(first == Approx(0.4610370640415288).epsilon(1e-15));
  CHECK(exact->state(1, Instant{first})->twist.linear.y() ==
        Approx(-4.165174324051543).epsilon(1e-13));
  // Continuous in height, e of the speed; between impacts the path obeys v' = -g - k |v| v / m:
  // central differences, O(dt^2) + eps/dt.
  const double k_m = 0.5 * 1.2 * 0.45 * 3.14159265358979323846 * 4e-4 / 2.7e-3;
  for (const std::int64_t k : {1, 2, 3, 7}) {
    const double t = *exact->impact_time(k), next = *exact->impact_time(k + 1);
    const BodyState before = *exact->state(1, Instant{t - 1e-10});
    const BodyState after = *exact->state(1, Instant{t + 1e-10});
    CHECK(before.pose.position.y() == Approx(0.02).margin(1e-9));
    CHECK(after.pose.position.y() == Approx(0.02).margin(1e-9));
    CHECK(after.twist.linear.y() == Approx(-0.9 * before.twist.linear.y()).epsilon(1e-8));
    for (const double fraction : {0.2, 0.45, 0.8}) {
      const double now = t + fraction * (next - t), dt = 1e-5;
      const double v = exact->state(1, Instant{now})->twist.linear.y();
      const double slope = (exact->state(1, Instant{now + dt})->twist.linear.y() -
                            exact->state(1, Instant{now - dt})->twist.linear.y()) /
                           (2.0 * dt);
      const double rise = (exact->state(1, Instant{now + dt})->pose.position.y() -
                           exact->state(1, Instant{now - dt})->pose.position.y()) /
                          (2.0 * dt);
      CHECK(slope == Approx(-9.81 - k_m * std::abs(v) * v).epsilon(1e-8));
      CHECK(rise == Approx(v).margin(1e-8));
    }
  }
  CHECK_THROWS_AS(
      solve_exactly(read_scene(scenes + "drag-drop.toml", {{"force[0].wind", "[1, 0, 0]"}})),
      InputError);
}

TEST_CASE("oscillator: impacts of x'' = -x at -0.3, and its period", "[exact]") {
  const auto exact = solve_exactly(read_scene(scenes + "oscillator.toml"));
  REQUIRE(exact != nullptr);
  const double first = 1.8754889808103;
  for (const std::int64_t k : {1, 2, 10, 100}) {
    CHECK(*exact->impact_time(k) ==
          Approx((2.0 * static_cast<double>(k) - 1.0) * first).epsilon(1e-13));
  }
  for (const double t : {0.0, 0.7, 1.8, 2.0, 3.7, 19.0, 1e4}) {
    const BodyState s = *exact->state(1, Instant{t});
    const double x = s.pose.position.x(), v = s.twist.linear.x();
    INFO(t);
    CHECK(x * x + v * v == Approx(1.0).epsilon(1e-14));
    CHECK(x >= -0.3 - 1e-14);
    const BodyState later = *exact->state(1, Instant{t} + 2.0 * *exact->impact_time(1));
    CHECK(later.pose.position.x() == Approx(x).margin(1e-12));
    CHECK(later.twist.linear.x() == Approx(v).margin(1e-12));
  }
  // Another phase: thrown from where it would have been 0.4 s later.
  const auto shifted = solve_exactly(read_scene(
      scenes + "oscillator.toml", {{"body.ball.position[0]", "0.9210609940028851"},
                                   {"body.ball.velocity", "[-0.3894183423086505, 0, 0]"}}));
  CHECK(*shifted->impact_time(3) == Approx(*exact->impact_time(3) - 0.4).epsilon(1e-14));
  CHECK_FALSE(solve_exactly(read_scene(scenes + "spring.toml"))->impact_time(1).has_value());
}
