// Exact solutions against the numbers of the literature, and against themselves.

#include "core/exact_solution.hpp"

#include "core/error.hpp"
#include "tests/catch.hpp"

#include <cmath>

using namespace kairos;

namespace {

const std::string scenes = std::string(KAIROS_SOURCE_DIR) + "/scenes/";

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
