// Recorded rallies: the same seed the same bits, files that read back, and what a rally shows.

#include "core/document.hpp"
#include "experiments/rally/hand_path.hpp"
#include "experiments/rally/interval.hpp"
#include "experiments/rally/rally_run.hpp"
#include "experiments/scene_library.hpp"
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

TEST_CASE("intervals: Wilson's for shares, standard errors for means", "[rally]") {
  // Values of the formula, by hand.
  const Interval half = share_interval(5, 10);
  CHECK(half.estimate == 0.5);
  CHECK(half.low == Approx(0.236593).epsilon(1e-5));
  CHECK(half.high == Approx(0.763407).epsilon(1e-5));
  const Interval none = share_interval(0, 100);
  CHECK(none.low == 0.0);
  CHECK(none.high == Approx(0.036993).epsilon(1e-4));
  CHECK(share_interval(100, 100).high == 1.0);
  const Interval mean = mean_interval({1.0, 2.0, 3.0, 4.0});
  CHECK(mean.estimate == 2.5);
  CHECK(mean.high - mean.estimate == Approx(1.959964 * std::sqrt(5.0 / 3.0 / 4.0)).epsilon(1e-6));
  CHECK(mean_interval({7.0}).low == 7.0);
}
