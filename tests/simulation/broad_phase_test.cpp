#include "ccd/cells.hpp"
#include "core/ball_detector.hpp"
#include "core/random.hpp"
#include "core/reading/scene_reader.hpp"
#include "core/scene.hpp"
#include "simulation/registry.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/event_digest.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

// The broad phase changes what a run costs and not what happens in it.

using namespace kairos;
using tests::EventDigest;

namespace {

/// 64 balls in a box, without gravity.
std::string gas() {
  std::string text = "duration = 0.5\nframe = 0.1\nG = 0\n";
  for (int side = 0; side < 6; ++side) {
    std::string half = "[2, 2, 2]";
    std::string at = "[0, 0, 0]";
    half[static_cast<std::size_t>(1 + 3 * (side / 2))] = '1';
    at.replace(static_cast<std::size_t>(1 + 3 * (side / 2)), 1, side % 2 == 0 ? "-3" : "3");
    text += "[[body]]\nname = \"wall" + std::to_string(side) +
            "\"\nentity = \"wall\"\nhalf_extents = " + half + "\nposition = " + at + "\n";
  }
  for (int k = 0; k < 64; ++k) {
    const auto coordinate = [](int i) { return std::to_string(-1.5 + i); };
    // Any fixed directions will do: thirds, fifths and sevenths of a turn do not repeat soon.
    text += "[[body]]\nname = \"ball" + std::to_string(100 + k) +
            "\"\nentity = \"ball\"\nradius = 0.3\nmass = 1\nposition = [" + coordinate(k % 4) +
            ", " + coordinate(k / 4 % 4) + ", " + coordinate(k / 16) + "]\nvelocity = [" +
            std::to_string(3.0 * std::sin(2.1 * k)) + ", " +
            std::to_string(3.0 * std::sin(1.3 * k)) + ", " +
            std::to_string(3.0 * std::cos(0.9 * k)) + "]\n";
  }
  return text;
}

Model model_of(const std::string& text, std::string_view broad_phase) {
  ModelOptions options;
  options.broad_phase = broad_phase;
  return Model(parse_scene(text, "gas.toml"), options);
}

std::vector<Event> impacts(std::string_view broad_phase) {
  const Model model = model_of(gas(), broad_phase);
  Trajectory trajectory;
  const RunResult result = simulate(model, {}, trajectory);
  REQUIRE(result.status == RunStatus::completed);
  return trajectory.events();
}

}  // namespace

TEST_CASE("every broad phase gives the same sequence of impacts", "[broad-phase]") {
  const std::vector<Event> reference = impacts("all-pairs");
  REQUIRE(reference.size() > 100);
  for (const std::string_view name : broad_phases()) {
    CAPTURE(name);
    const std::vector<Event> events = impacts(name);
    REQUIRE(events.size() == reference.size());
    for (std::size_t k = 0; k < events.size(); ++k) {
      REQUIRE(events[k].a == reference[k].a);
      REQUIRE(events[k].b == reference[k].b);
      // Bit for bit: a query depends on the two motions alone. Collisions of balls multiply a
      // difference by some 10 each, so that one of a last bit would show.
      REQUIRE(events[k].time == reference[k].time);
      REQUIRE(events[k].after_a.twist.linear == reference[k].after_a.twist.linear);
      REQUIRE(events[k].after_b.twist.linear == reference[k].after_b.twist.linear);
    }
  }
}

// Windows used to start when a pair was asked; they now start where the later of its motions does.
// What that changed is within what was proven: both brackets hold the same contact.
TEST_CASE("a window that starts later brackets the same contact", "[broad-phase]") {
  constexpr std::uint64_t seed = 7;
  INFO("seed " << seed);
  Random random(seed);
  const auto vector = [&](double size) {
    return Vector3(random.uniform(-size, size), random.uniform(-size, size),
                   random.uniform(-size, size));
  };
  const auto detector = find_detector("certified");
  const Shape ball = Sphere{0.3};
  const Vector3 gravity(0.0, -9.81, 0.0);
  int met = 0;
  for (int k = 0; k < 20000; ++k) {
    const Motion a = Motion::ballistic({}, 10.0, {vector(3.0)}, {vector(2.0)}, gravity);
    const Motion b = Motion::ballistic({random.uniform(0.0, 1.0), 0.0}, 10.0, {vector(3.0)},
                                       {vector(2.0)}, gravity);
    const TimeOfImpact first = detector->time_of_impact({ball, a}, {ball, b}, {b.start, 5.0}, 0.0);
    if (first.status != ToiStatus::impact || first.t_lo == 0.0) {
      continue;
    }
    ++met;
    const double later = random.uniform(0.0, 0.9) * first.t_lo;
    const TimeOfImpact second =
        detector->time_of_impact({ball, a}, {ball, b}, {b.start + later, 5.0 - later}, 0.0);
    REQUIRE(second.status == ToiStatus::impact);
    // Of the sums, in which Instants keep what doubles round.
    const double apart = (b.start + later + second.t_lo) - (b.start + first.t_lo);
    CHECK(apart <= first.t_hi - first.t_lo);
    CHECK(-apart <= second.t_hi - second.t_lo);
  }
  CHECK(met > 100);
}

namespace {

/// Every kind of thing in one room: balls of three sizes and one much larger, tumbling tiles, a
/// fixed block, a driven paddle, a field; gravity, and impacts that lose energy. `turned`: listed
/// the other way round.
std::string room(bool turned) {
  constexpr std::uint64_t seed = 5;
  Random random(seed);
  const auto vector = [](double x, double y, double z) {
    return "[" + std::to_string(x) + ", " + std::to_string(y) + ", " + std::to_string(z) + "]";
  };
  const auto side = [](const char* name, const char* position, const char* normal) {
    return std::string("name = \"") + name +
           "\"\nentity = \"wall\"\nshape = \"half-space\"\nrestitution = 0.9\nposition = " +
           position + "\nnormal = " + normal + "\n";
  };
  std::vector<std::string> bodies = {
      side("floor", "[0, 0, 0]", "[0, 1, 0]"),
      side("ceiling", "[0, 3, 0]", "[0, -1, 0]"),
      side("left", "[-2, 0, 0]", "[1, 0, 0]"),
      side("right", "[2, 0, 0]", "[-1, 0, 0]"),
      side("back", "[0, 0, -2]", "[0, 0, 1]"),
      side("front", "[0, 0, 2]", "[0, 0, -1]"),
      "name = \"block\"\nentity = \"wall\"\nrestitution = 0.9\nhalf_extents = [0.3, 0.3, 0.3]\n"
      "position = [1.5, 0.3, 1.5]\n",
      "name = \"paddle\"\nentity = \"bat\"\nmass = 100\nhalf_extents = [0.4, 0.05, 0.4]\n"
      "position = [-1.0, 0.6, -1.0]\n[body.drive]\nfrequency = 1.0\namplitude = [0.0, 0.2, 0.0]\n",
      "name = \"pad\"\nentity = \"anti-gravity-pad\"\nhalf_extents = [0.5, 0.5, 0.5]\n"
      "position = [1.0, 1.6, -1.0]\n",
      "name = \"big\"\nentity = \"ball\"\nrestitution = 0.9\nradius = 0.5\nmass = 20\n"
      "position = [0.2, 2.2, 0.3]\nvelocity = [0.3, 0, -0.2]\n"};
  for (int k = 0; k < 2; ++k) {
    bodies.push_back("name = \"tile" + std::to_string(k) +
                     "\"\nentity = \"body\"\nrestitution = 0.9\nhalf_extents = [0.12, 0.08, 0.1]\n"
                     "mass = 1\nposition = " +
                     vector(-1.5 + 0.6 * k, 1.4, 1.2) +
                     "\nvelocity = [0.5, 0.4, -1]\nangular_velocity = [1, 2, 0.5]\n");
  }
  const double sizes[] = {0.08, 0.12, 0.16};
  for (int k = 0; k < 60; ++k) {
    const Vector3 p(-1.6 + 0.5 * (k % 5), k / 5 % 3 == 2 ? 2.6 : 1.0 + 0.55 * (k / 5 % 3),
                    -1.6 + 0.5 * (k / 15));
    const double radius = sizes[k % 3];
    const Vector3 v(random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0),
                    random.uniform(-2.0, 2.0));
    const bool in_big = (p - Vector3(0.2, 2.2, 0.3)).norm() < 0.8;
    const bool in_pad = (p - Vector3(1.0, 1.6, -1.0)).cwiseAbs().maxCoeff() < 0.72;
    if (!in_big && !in_pad) {
      bodies.push_back("name = \"ball" + std::to_string(100 + k) +
                       "\"\nentity = \"ball\"\nrestitution = 0.9\nmass = 1\nradius = " +
                       std::to_string(radius) + "\nposition = " + vector(p.x(), p.y(), p.z()) +
                       "\nvelocity = " + vector(v.x(), v.y(), v.z()) + "\n");
    }
  }
  if (turned) {
    std::reverse(bodies.begin(), bodies.end());
  }
  std::string text = "duration = 3\nframe = 0.05\nG = 3\n";
  for (const std::string& body : bodies) {
    text += "[[body]]\n" + body;
  }
  return text;
}

}  // namespace

TEST_CASE("one digest over broad phases, orders of bodies and resumed runs", "[broad-phase]") {
  std::string reference;
  for (const bool turned : {false, true}) {
    for (const std::string_view name : broad_phases()) {
      CAPTURE(name, turned);
      const Model model = model_of(room(turned), name);
      EventDigest whole;
      const RunResult result = simulate(model, {}, whole, {.keeper = &whole});
      CAPTURE(result.reason);
      REQUIRE(result.status == RunStatus::completed);
      REQUIRE(whole.events > 300);
      reference = reference.empty() ? whole.text() : reference;
      CHECK(whole.text() == reference);
      REQUIRE_FALSE(whole.kept.empty());
      EventDigest rest;
      const RunResult resumed = simulate(model, {}, rest, {.resume = whole.kept});
      CHECK(rest.text() == reference);
      CHECK(resumed.cost.toi_queries == result.cost.toi_queries);
      CHECK(resumed.ledger.energy() == result.ledger.energy());
    }
  }
}

TEST_CASE("one digest over five sizes of cells", "[broad-phase]") {
  const Model model = model_of(room(false), "cells");
  EventDigest usual;
  REQUIRE(simulate(model, {}, usual).status == RunStatus::completed);
  std::vector<std::int64_t> costs;
  for (const ccd::CellSize size :
       {ccd::CellSize{1.0, 1.0}, {1.3, 1.0}, {1.7, 1.0}, {4.0, 1.0}, {1.0, 6.0}}) {
    CAPTURE(size.width, size.margin);
    Method method{find_integrator("auto", {}),
                  find_detector("certified"),
                  find_impact_law("newton"),
                  find_broad_phase("dynamic-tree"),
                  swept_bounds(),
                  ccd::cells_of(size)};
    EventDigest digest;
    SchemeOptions options;
    options.frames = model.scene().frames;
    options.duration = model.scene().duration;
    const RunResult result = find_scheme("event-driven")->run(model, method, options, digest);
    REQUIRE(result.status == RunStatus::completed);
    CHECK(digest.text() == usual.text());
    costs.push_back(result.cost.toi_queries);
  }
  // They are five: what they cost is not the same.
  CAPTURE(costs);
  std::sort(costs.begin(), costs.end());
  CAPTURE(costs);
  CHECK(std::adjacent_find(costs.begin(), costs.end()) == costs.end());
}

// Of most balls no motion is made, unless somebody wants to hear of it: their flights say all.
TEST_CASE("whoever listens to motions hears of the same events", "[broad-phase]") {
  class Listener : public EventDigest {
   public:
    [[nodiscard]] bool wants_motions() const override { return true; }
    void motion(BodyIndex /*body*/, const Motion& /*motion*/) override { ++motions; }
    std::int64_t motions = 0;
  };
  struct Kind {
    const char* name;
    const char* gravity;
    const char* restitution;
    const char* sizes;
  };
  for (const Kind& kind : {Kind{"gas", "0", "1", "[1, 1]"},
                           {"falling", "9.81", "0.9", "[1, 1]"},
                           {"of two sizes", "9.81", "1", "[0.5, 1]"}}) {
    CAPTURE(kind.name);
    std::string text = std::string("duration = 0.3\nG = ") + kind.gravity +
                       "\n[[many]]\nname = \"ball\"\nentity = \"ball\"\ncount = 400\nmass = 1.0\n" +
                       "radius = 0.03\nsizes = " + kind.sizes +
                       "\nrestitution = " + kind.restitution +
                       "\nvelocity_deviation = 1.0\nregion = {min = [0, 0, 0], max = [1, 1, 1]}\n";
    for (int side = 0; side < 6; ++side) {
      std::string normal = "[0, 0, 0]";
      normal.replace(static_cast<std::size_t>(1 + 3 * (side / 2)), 1, side % 2 == 0 ? "1" : "-1");
      const std::string at = side % 2 == 0 ? "[0, 0, 0]" : "[1, 1, 1]";
      text += "[[body]]\nname = \"wall" + std::to_string(side) +
              "\"\nentity = \"wall\"\nshape = \"half-space\"\nposition = " + at +
              "\nnormal = " + normal + "\n";
    }
    const Model model = model_of(text, "cells");
    EventDigest digest;
    Listener listener;
    const RunResult quiet = simulate(model, {}, digest);
    const RunResult heard = simulate(model, {}, listener);
    REQUIRE(quiet.status == RunStatus::completed);
    CHECK(listener.text() == digest.text());
    CHECK(digest.events > 1000);
    CHECK(listener.motions > digest.events);
    CHECK(heard.cost.steps == quiet.cost.steps);
    CHECK(heard.cost.right_hand_sides == quiet.cost.right_hand_sides);
    CHECK(heard.cost.toi_queries == quiet.cost.toi_queries);
    CHECK(heard.ledger.flow() == quiet.ledger.flow());
    CHECK(heard.ledger.energy() == quiet.ledger.energy());
  }
}

// `clear_times` may pass over a pair only before it meets; `ball_impact` is `time_of_impact`, and
// `ball_meeting` its time.
TEST_CASE("balls are clear of each other as long as they are said to be", "[broad-phase]") {
  constexpr std::uint64_t seed = 17;
  INFO("seed " << seed);
  Random random(seed);
  const auto vector = [&](double size) {
    return Vector3(random.uniform(-size, size), random.uniform(-size, size),
                   random.uniform(-size, size));
  };
  const auto detector = find_detector("certified");
  const auto* const of_balls = dynamic_cast<const BallDetector*>(detector.get());
  REQUIRE(of_balls != nullptr);
  int met = 0;
  int asked_when = 0;
  int passed_over = 0;
  int passed_over_alike = 0;
  int wrong = 0;
  int asked_short = 0;
  int differ = 0;
  for (int k = 0; k < 100000; ++k) {
    const Vector3 gravity(0.0, k % 2 == 0 ? 0.0 : -9.81, 0.0);
    const double far = k % 5 == 0 ? 1e6 : 0.0;  // from the origin
    const Vector3 corner(far, -far, far);
    const auto flight = [&](double radius) {
      return BallFlight{
          corner + vector(2.0), vector(3.0), gravity, {random.uniform(0.0, 1.0), 0.0}, radius};
    };
    BallFlight a = flight(random.uniform(0.01, 1.0));
    BallFlight b = flight(random.uniform(0.01, 1.0));
    if (k % 7 == 0) {  // at rest against each other, or as good as
      b.velocity = a.velocity + vector(k % 14 == 0 ? 0.0 : 1e-12);
      b.start = a.start;
    }
    const double tolerance = k % 3 == 0 ? 0.02 : 0.0;
    const bool alike = k % 11 < 5;
    FlightsBeside beside;
    if (alike) {
      b.radius = a.radius;
      beside.begin_alike(a);
      beside.add_alike(b);
    } else {
      beside.begin(a);
      beside.add(b);
    }
    std::array<double, FlightsBeside::block> found{};
    detector->clear_times(beside, tolerance, found);
    const double clear = found[0];
    const auto motion = [](const BallFlight& of) {
      return Motion::ballistic(of.start, 100.0, {of.position}, {of.velocity}, of.acceleration);
    };
    const Shape ball_a = Sphere{a.radius};
    const Shape ball_b = Sphere{b.radius};
    const TimeOfImpact toi = detector->time_of_impact(
        {ball_a, motion(a)}, {ball_b, motion(b)}, {std::max(a.start, b.start), 50.0}, tolerance);
    met += toi.status == ToiStatus::impact ? 1 : 0;
    const auto same = detector->ball_impact(a, b, {std::max(a.start, b.start), 50.0});
    if (same) {
      ++asked_short;
      const auto bits = [](const TimeOfImpact& of) {
        return std::tuple(of.status, of.t_lo, of.t_hi, of.gap, of.evaluations, of.normal.x(),
                          of.normal.y(), of.normal.z(), of.witness_a.x(), of.witness_a.y(),
                          of.witness_a.z(), of.witness_b.x(), of.witness_b.y(), of.witness_b.z());
      };
      differ += bits(*same) != bits(toi) ? 1 : 0;
    }
    if (const auto when = of_balls->ball_meeting(a, b, {std::max(a.start, b.start), 50.0})) {
      ++asked_when;
      const bool meets = toi.status == ToiStatus::impact;
      differ += when->meets != meets || (!meets && toi.status != ToiStatus::separated) ? 1 : 0;
      differ += meets && (when->t_lo != toi.t_lo || when->t_hi != toi.t_hi) ? 1 : 0;
      differ += when->evaluations != toi.evaluations ? 1 : 0;
    }
    passed_over += clear > 0.0 ? 1 : 0;
    passed_over_alike += alike && clear > 0.0 ? 1 : 0;
    wrong += toi.status != ToiStatus::separated && !(clear <= toi.t_lo) ? 1 : 0;
  }
  CHECK(wrong == 0);
  CHECK(met > 1000);
  CHECK(passed_over > 50000);
  CHECK(passed_over_alike > 20000);
  // The short way of asking says the same, and is there for all of these.
  CHECK(differ == 0);
  CHECK(asked_short == 100000);
  CHECK(asked_when > 50000);
}
