// Recorded rallies: the same seed the same bits, files that read back, and what a rally shows.

#include "core/reading/document.hpp"
#include "core/reading/track_reader.hpp"
#include "experiments/rally/hand_path.hpp"
#include "experiments/rally/interval.hpp"
#include "experiments/rally/rally_run.hpp"
#include "simulation/scene_library.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"

#include <cmath>
#include <string>

using namespace kairos;
using namespace kairos::experiments;
using kairos::tests::kairos_program;
using kairos::tests::read_all;
using kairos::tests::TemporaryFolder;

namespace {

int passed(const RallyOutcome& rally) {
  int count = 0;
  for (const StrokeOutcome& stroke : rally.strokes) {
    count += stroke.passed() ? 1 : 0;
  }
  return count;
}

int penetrating(const RallyOutcome& rally) {
  int count = 0;
  for (const StrokeOutcome& stroke : rally.strokes) {
    count += stroke.penetrating;
  }
  return count;
}

const RallyMethod& method(const std::vector<RallyMethod>& methods, const std::string& name) {
  for (const RallyMethod& m : methods) {
    if (m.name == name) {
      return m;
    }
  }
  throw std::out_of_range(name);
}

}  // namespace

TEST_CASE("rally: a hand moves from rest to rest, fastest half way", "[rally]") {
  HandPath path({});
  path.move(1.0, 3.0, {Vector3(4, 0, 0), Quaternion::Identity()});
  CHECK(path.at(0.0).pose.position == Vector3::Zero());
  CHECK(path.at(1.0).velocity.norm() == 0.0);
  CHECK(path.at(2.0).pose.position.x() == Approx(2.0));
  CHECK(path.at(2.0).velocity.x() == Approx(15.0 / 8.0 * 4.0 / 2.0));
  CHECK(path.at(3.0).velocity.norm() == 0.0);
  CHECK(path.at(9.0).pose.position.x() == Approx(4.0));
  // The velocity is that of the path: order h^2 of a central difference, third derivative < 60
  // d/T^3.
  constexpr double h = 1e-4;
  for (const double t : {1.2, 1.9, 2.7}) {
    const double slope =
        (path.at(t + h).pose.position.x() - path.at(t - h).pose.position.x()) / (2 * h);
    CHECK(std::abs(path.at(t).velocity.x() - slope) < 60.0 * 4.0 / 8.0 * h * h);
  }
}

TEST_CASE("rally: the same seed, the same bits; the files read back as they were made", "[rally]") {
  const RallyOptions options{.seed = 7, .strokes = 3};
  const RallyRecording rally = make_rally(options);
  CHECK(bat_csv(rally) == bat_csv(make_rally(options)));
  CHECK(bat_csv(rally) != bat_csv(make_rally({.seed = 8, .strokes = 3})));
  const TemporaryFolder folder;
  const Recording bat = read_track_csv(folder.file("bat.csv", bat_csv(rally)));
  const Recording hand = read_track_csv(folder.file("hand.csv", hand_csv(rally)));
  REQUIRE(bat.samples.size() == rally.bat.samples.size());
  REQUIRE(hand.samples.size() == rally.hand.samples.size());
  CHECK_FALSE(bat.gestures);
  CHECK(hand.gestures);
  for (std::size_t i = 0; i < bat.samples.size(); ++i) {
    CHECK(bat.samples[i].time == rally.bat.samples[i].time);
    CHECK(bat.samples[i].pose.position == rally.bat.samples[i].pose.position);
  }
  for (std::size_t i = 0; i < hand.samples.size(); ++i) {
    CHECK(hand.samples[i].pose.position == rally.hand.samples[i].pose.position);
    CHECK(hand.samples[i].closed == rally.hand.samples[i].closed);
  }
}

TEST_CASE("rally: the shipped recordings are those that the scene says", "[rally]") {
  const RallyRecording rally = make_rally({.seed = 1999});
  const std::string recordings = scene_folder() + "/recordings/table-tennis-";
  CHECK(read_all(recordings + "bat.csv") == bat_csv(rally));
  CHECK(read_all(recordings + "hand.csv") == hand_csv(rally));
  CHECK(rally.strokes.size() >= 20);
  const TemporaryFolder folder;
  const auto made = kairos_program({"record", "--seed", "1999", "--out", folder.path("out")});
  CHECK(made.exit_code == 0);
  CHECK(read_all(folder.path("out/bat.csv")) == bat_csv(rally));
  const auto slow = kairos_program({"record", "--slowest", "9", "--out", folder.path("no")});
  CHECK(slow.exit_code == 2);
}

TEST_CASE("rally: strokes pass through the ball once a frame, and never from impact to impact",
          "[rally]") {
  const std::vector<RallyMethod> methods = rally_methods();
  const RallyRecording rally = make_rally({.seed = 1999});
  const RallyOutcome original = play(rally, method(methods, "original"));
  const RallyOutcome exact = play(rally, method(methods, "event-driven"));
  REQUIRE(original.strokes.size() == 24);
  CHECK(passed(original) > 0);
  CHECK(penetrating(original) > 0);
  CHECK(exact.status == RunStatus::completed);
  CHECK(passed(exact) == 0);
  CHECK(penetrating(exact) == 0);
  int missed = 0;
  for (const StrokeOutcome& stroke : exact.strokes) {
    missed += stroke.hits == 0 ? 1 : 0;
  }
  CHECK(missed == 0);  // every stroke finds its ball
}

TEST_CASE("rally: the nudge helps where a hit ball stays with the bat, and nowhere else",
          "[rally]") {
  const std::vector<RallyMethod> methods = rally_methods();
  const RallyRecording rally = make_rally({.seed = 1999});
  const auto frames = [&](const std::string& name) {
    return penetrating(play(rally, method(methods, name)));
  };
  const int light = frames("original, equal masses");
  CHECK(frames("original, equal masses, nudge 0.0025") < light);
  CHECK(frames("original, equal masses, nudge 0.02") <
        frames("original, equal masses, nudge 0.0025"));
  CHECK(light > frames("original"));
}

TEST_CASE("rally: fig. 15 taken literally does not cure the bat; equal substeps do", "[rally]") {
  const std::vector<RallyMethod> methods = rally_methods();
  std::int64_t original = 0, literal = 0, equal = 0;
  for (std::uint64_t seed = 1999; seed < 2009; ++seed) {
    const RallyRecording rally = make_rally({.seed = seed});
    original += play(rally, method(methods, "original")).passed().count;
    literal += play(rally, method(methods, "substepped, 0.0275 m")).passed().count;
    equal += play(rally, method(methods, "equal substeps, 0.0275 m")).passed().count;
  }
  CAPTURE(original, literal, equal);  // of 240 strokes; a cure of half would be 4 deviations away
  CHECK(2 * literal > original);
  CHECK(20 * equal < original);
}

TEST_CASE("rally: with the thesis' boxes and force the ball falls as before and is hit as a box",
          "[rally]") {
  const RallyRecording rally = make_rally({.seed = 1999, .strokes = 2});
  const auto scene = [&rally](bool boxes) {
    RallyMethod as{.name = "as"};
    as.boxes = boxes;
    return rally_scene(rally, as);
  };
  const Model spheres(scene(false));
  const Model boxes(scene(true));
  const std::size_t ball = spheres.size() - 1;
  CHECK(std::holds_alternative<Sphere>(spheres.shape(ball)));
  CHECK(std::holds_alternative<Box>(boxes.shape(ball)));
  // In the air, served and not hit yet: the same fall, up to the roundoff of G m/m.
  RunChoice choice;
  choice.method = MethodChoice::thesis();
  choice.duration = rally.strokes.front().hit - 0.1;
  const auto falls = [&](const Model& model) {
    Trajectory trajectory;
    return simulate(model, choice, trajectory).state[ball].twist.linear.y();
  };
  CHECK(falls(spheres) < -0.2);
  CHECK(std::abs(falls(boxes) / falls(spheres) - 1.0) <= 1e-12);
}

TEST_CASE("intervals: Wilson's for shares, Student's for means", "[rally]") {
  // Values of the formula, by hand.
  const Interval half = share_interval(5, 10);
  CHECK(half.estimate == 0.5);
  CHECK(half.low == Approx(0.236593).epsilon(1e-5));
  CHECK(half.high == Approx(0.763407).epsilon(1e-5));
  const Interval none = share_interval(0, 100);
  CHECK(none.low == 0.0);
  CHECK(none.high == Approx(0.036993).epsilon(1e-4));
  CHECK(share_interval(100, 100).high == 1.0);
  // From tables of the distribution, to the digits that the expansion holds.
  CHECK(student(4.0) == Approx(2.7764).epsilon(3e-3));
  CHECK(student(19.0) == Approx(2.0930).epsilon(1e-4));
  CHECK(student(1e9) == Approx(1.959964).epsilon(1e-6));
  const Interval mean = mean_interval({1.0, 2.0, 3.0, 4.0, 5.0});
  CHECK(mean.estimate == 3.0);
  CHECK(mean.high - mean.estimate == Approx(2.7764 * std::sqrt(2.5 / 5.0)).epsilon(3e-3));
  CHECK(mean_interval({7.0}).low == 7.0);
}

TEST_CASE("intervals: strokes of a rally that go alike count as fewer", "[rally]") {
  // All of a rally or nothing: as many independent draws as rallies.
  const std::vector<Cluster> alike{{10, 10}, {0, 10}, {10, 10}, {0, 10}};
  // 4/3 sum (c - p n)^2 / (n p (1 - p)) = 4/3 100/10.
  CHECK(design_effect(alike) == Approx(40.0 / 3.0));
  // Just as independent draws would have it, or more even: never narrower than they are.
  const std::vector<Cluster> even{{5, 10}, {5, 10}, {5, 10}, {5, 10}};
  CHECK(design_effect(even) == 1.0);
  const Interval wide = share_interval(alike);
  const Interval narrow = share_interval(even);
  CHECK(wide.estimate == narrow.estimate);
  CHECK(wide.low < narrow.low - 0.1);
  CHECK(wide.high > narrow.high + 0.1);
  // Where nothing was counted the effect is that of others.
  const std::vector<Cluster> nothing{{0, 10}, {0, 10}, {0, 10}, {0, 10}};
  CHECK(share_interval(nothing, 4.0).high > 2.0 * share_interval(nothing).high);
  CHECK(share_interval(nothing, 4.0).low == 0.0);
}
