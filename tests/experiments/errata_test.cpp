// The errata of the thesis: every item names a test that exists, and every number agrees. What no
// other test holds is held here.

#include "experiments/thesis/errata.hpp"

#include "core/model.hpp"
#include "core/reading/scene_reader.hpp"
#include "core/rotation_between.hpp"
#include "experiments/thesis/literal_bounce.hpp"
#include "experiments/thesis/thesis_figure.hpp"
#include "simulation/registry.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"
#include "tests/locations.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

using namespace kairos;
using namespace kairos::experiments;
using namespace kairos::experiments::thesis;

namespace {

std::string all_tests() {
  std::string text;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(tests::source_path("tests"))) {
    if (entry.path().extension() == ".cpp") {
      text += tests::read_all(entry.path().string());
    }
  }
  return text;
}

}  // namespace

TEST_CASE("errata: every item names a test that exists", "[errata]") {
  const std::string tests = all_tests();
  CHECK(errata().size() >= 15);  // twelve predictions and three side claims
  for (const Erratum& erratum : errata()) {
    CAPTURE(erratum.id, erratum.test);
    CHECK(tests.find("TEST_CASE(\"" + std::string(erratum.test) + "\"") != std::string::npos);
  }
}

TEST_CASE("errata: every measured number agrees with its prediction", "[errata][slow]") {
  for (const Erratum& erratum : errata()) {
    for (const Check& check : erratum.measure(Size::quick)) {
      CAPTURE(erratum.id, check.quantity, check.predicted, check.measured, check.tolerance);
      CHECK(check.confirmed());
    }
  }
}

TEST_CASE("errata: only what a run could have refuted counts as confirmed", "[errata][slow]") {
  FigureData data("", Size::quick);
  find_thesis_figure("errata")->measure(data);
  const auto count = [&data](const char* name) {
    return std::stoi(data.filled(std::string("{") + name + "}"));
  };
  int decided = 0, others = 0;
  for (const Erratum& erratum : errata()) {
    for (const Check& check : erratum.measure(Size::quick)) {
      (check.evidence == Evidence::run ? decided : others) += 1;
      CAPTURE(erratum.id, check.quantity);
      // An effect without a predicted number is observed, and nothing else is.
      CHECK((check.agreement == Agreement::more_than) == (check.evidence == Evidence::observation));
    }
  }
  CHECK(count("decided") == decided);
  CHECK(count("confirmed") + count("refuted") == decided);
  CHECK(count("computed") + count("observed") == others);
  CHECK(others > 10);
  CHECK(count("corrected") == static_cast<int>(corrected().size()));
}

TEST_CASE("errata: contradictions, undecided claims and corrected readings are told",
          "[errata][slow]") {
  FigureData data("", Size::quick);
  find_thesis_figure("errata")->measure(data);  // throws where a text quotes what there is not
  CHECK(contradictions().size() >= 8);
  CHECK(undecided().size() >= 3);
  // 4.4.1 adds up accelerations: after 30 frames 29 * 30 / 2 of G h, against 29 of them.
  CHECK(data.number("fall_441") / data.number("fall_134") == Approx(15.0));
  for (const Corrected& item : corrected()) {
    const std::span<const Erratum> all = errata();
    CAPTURE(item.id);
    CHECK(std::any_of(all.begin(), all.end(), [&](const Erratum& e) { return e.id == item.id; }));
  }
}

TEST_CASE("roundoff is all that differs between double and long double, and is no cause",
          "[errata]") {
  RunChoice choice;
  choice.method = MethodChoice::thesis();
  choice.duration = 60.0;
  const Simulation run = simulate(read_scene(find_scene("bounce")), choice);
  const BounceSetting setting;
  BounceState<double> usual{setting.height, 0.0, 0.0, 0};
  BounceState<long double> longer{setting.height, 0.0L, 0.0L, 0};
  for (int n = 0; n < 3600; ++n) {
    literal_frame(setting, usual);
    literal_frame(setting, longer);
  }
  // The same operations in the same order: the same bits as the scheme.
  CHECK(usual.height == run.result.state[1].pose.position.y());
  CHECK(usual.velocity == run.result.state[1].twist.linear.y());
  CHECK(usual.impacts == run.result.cost.impacts);
  CHECK(longer.impacts == usual.impacts);
  // 3600 additions near 10 m and 10 m/s would reach 3600 eps 10 J if all erred the same way.
  const double start = usual.energy(setting);
  CHECK(std::abs(static_cast<double>(longer.energy(setting)) - start) <= 3600.0 * 0x1p-52 * 100.0);
  CHECK(longer.energy(setting) - 49.0L > 48.0L);  // the gain is there without roundoff
}

TEST_CASE("pushing a ball out of the bat adds m g d to its energy", "[errata]") {
  const Scene scene =
      read_scene(find_scene("bat"), {{"G", "9.8"},
                                     {"body.bat.nudge", "0.01"},
                                     {"body.bat.half_extents", "[0.08, 0.01, 0.08]"},
                                     {"body.bat.drive.amplitude", "[0, 0.4, 0]"},
                                     {"body.ball.position", "[0, 0.35, 0]"}});
  RunChoice choice;
  choice.method = MethodChoice::thesis();
  const Simulation run = simulate(scene, choice);
  REQUIRE_FALSE(run.trajectory.events().empty());
  double moved = 0.0;
  for (const Event& event : run.trajectory.events()) {
    moved += event.after_b.pose.position.y() - event.before_b.pose.position.y();
  }
  CHECK(std::abs(moved) > 1e-4);
  const double expected = scene.bodies[1].mass * 9.8 * moved;
  // Roundoff: sums of a handful of terms.
  CHECK(std::abs(run.result.ledger.line(EnergyLine::position_correction) / expected - 1.0) <=
        1e-12);
}

TEST_CASE("prediction 9: a ball's box touches up to (sqrt 3 - 1) r early", "[errata]") {
  const auto detector = find_detector("sat");
  const double r = 0.25;
  const Pose floor;  // its surface is y = 0
  // The diagonal of the box turned upright.
  const Quaternion upright = rotation_between(Vector3::Ones().normalized(), Vector3::UnitY());
  const auto touches = [&](const Shape& shape, double height) {
    return detector->overlaps(shape, {.position = {0.0, height, 0.0}, .orientation = upright},
                              HalfSpace{}, floor);
  };
  const Shape ball = Sphere{r};
  const Shape box = bounding_box(ball);
  // Roundoff: heights within 1e-12 of where contact begins.
  CHECK(touches(ball, r - 1e-12));
  CHECK_FALSE(touches(ball, r + 1e-12));
  CHECK(touches(box, std::sqrt(3.0) * r - 1e-12));
  CHECK_FALSE(touches(box, std::sqrt(3.0) * r + 1e-12));
}

TEST_CASE("prediction 11: n objects have n(n+1)/2 kinds of pairs, not n!", "[errata]") {
  // Of n balls and a floor the model tests n(n-1)/2 + n pairs: each with each other, each with the
  // floor; with the pair of floors that can never meet, (n+1)(n+2)/2 less the n + 1 of a body with
  // itself.
  for (const std::size_t n : {1u, 3u, 6u}) {
    std::string text =
        "name = \"n\"\nsummary = \"\"\nduration = 1\nframe = 0.1\n"
        "[[body]]\nname = \"floor\"\nentity = \"wall\"\nshape = \"half-space\"\n";
    for (std::size_t k = 0; k < n; ++k) {
      text += "[[body]]\nname = \"ball" + std::to_string(k) +
              "\"\nentity = \"ball\"\nradius = 0.1\nmass = 1.0\nposition = [" + std::to_string(k) +
              ", 1, 0]\n";
    }
    CHECK(Model(parse_scene(text, "n.toml")).pairs().size() == n * (n + 1) / 2);
  }
}

TEST_CASE("an energy error near 0 proves nothing: late flips keep energy and lose the state",
          "[errata]") {
  RunChoice late;
  late.method = MethodChoice::thesis();
  late.method.integrator = "rk4";
  late.duration = 60.0;
  RunChoice exact;
  exact.duration = 60.0;
  const Scene scene = read_scene(find_scene("bounce"));
  const RunResult flipped = simulate(scene, late).result;
  const RunResult located = simulate(scene, exact).result;
  const double error = flipped.ledger.energy() - flipped.ledger.initial_energy();
  CHECK(std::abs(error) <= 1e-12 * flipped.ledger.initial_energy());  // roundoff of 3600 steps
  CHECK(std::abs(flipped.state[1].pose.position.y() - located.state[1].pose.position.y()) > 0.1);
}
