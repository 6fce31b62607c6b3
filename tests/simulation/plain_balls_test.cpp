#include "core/plain_balls.hpp"

#include "core/archive.hpp"
#include "core/ball_detector.hpp"
#include "core/contacts/group_law.hpp"
#include "core/random.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/registry.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>

// What is told of plain balls, or done to them, in fewer words is what all bodies are asked and go
// through, bit by bit.

using namespace kairos;

namespace {

/// Newton's law to whoever does not ask whether it is also a law of points.
class Unabridged : public ImpactLaw, public GroupLaw {
 public:
  [[nodiscard]] LawInfo info() const override { return newton_->info(); }
  ImpactEnergy apply(const Contact& contact, ImpactBody a, ImpactBody b) const override {
    return newton_->apply(contact, a, b);
  }
  [[nodiscard]] bool takes_what_touches() const override { return of_groups_.takes_what_touches(); }
  [[nodiscard]] Eigen::VectorXd strike(const ContactSystem& system,
                                       const Eigen::VectorXd& restitution,
                                       std::vector<Twist>& v) const override {
    return of_groups_.strike(system, restitution, v);
  }

 private:
  std::shared_ptr<const ImpactLaw> newton_ = find_impact_law("newton");
  const GroupLaw& of_groups_ = dynamic_cast<const GroupLaw&>(*newton_);
};

/// Every bit of every event and of every frame.
class Bits : public Recorder {
 public:
  void event(const Event& event) override {
    Archive bits;
    Event e = event;
    bits(text_, e.time, e.bracket, e.a, e.b, e.contact.point, e.contact.normal, e.contact.gap,
         e.contact.restitution, e.contact.friction, e.before_a, e.after_a, e.before_b, e.after_b);
    text_ = fingerprint(bits.bytes());
    ++events;
    slowest = std::min(slowest, e.contact.restitution);
  }
  void frame(const Frame& frame) override {
    Archive bits;
    State state(frame.bodies.begin(), frame.bodies.end());
    EnergyLedger ledger = frame.ledger;
    bits(text_, state, ledger);
    text_ = fingerprint(bits.bytes());
  }
  [[nodiscard]] const std::string& text() const { return text_; }

  std::int64_t events = 0;
  double slowest = 1.0;

 private:
  std::string text_;
};

/// Two kinds of balls, perhaps of many sizes, among six walls.
std::string random_gas(Random& random) {
  const auto one_of = [&random](std::initializer_list<const char*> words) {
    const auto n = static_cast<double>(words.size());
    return *(words.begin() + static_cast<std::ptrdiff_t>(random.uniform(0.0, 0.999999 * n)));
  };
  // One draw a statement: compilers differ in which argument they make first.
  const auto combine = one_of({"product", "geometric-mean", "minimum"});
  std::string text =
      fmt::format("duration = 0.2\nframe = 0.05\nG = {}\nrestitution_combine = \"{}\"\n",
                  one_of({"0", "9.81"}), combine);
  for (int kind = 0; kind < 2; ++kind) {
    const double deviation = random.uniform(0.1, 3.0);
    const auto seed = static_cast<int>(random.uniform(1.0, 1e6));
    const auto restitution = one_of({"1", "1", "0.9", "0.3", "0"});
    const auto sizes = one_of({"[1, 1]", "[0.5, 1]"});
    const double mass = random.uniform(0.1, 3.0);
    text += fmt::format(
        "[[many]]\nname = \"ball{0}\"\nentity = \"ball\"\ncount = {1}\nmass = {2}\n"
        "radius = 0.03\nsizes = {3}\nrestitution = {4}\nseed = {5}\nvelocity_deviation = {6}\n"
        "region = {{min = [{7}, 0, 0], max = [{8}, 1, 1]}}\n",
        kind, static_cast<int>(random.uniform(20.0, 100.0)), mass, sizes, restitution, seed,
        deviation, 0.5 * kind, 0.5 + 0.5 * kind);
  }
  for (int side = 0; side < 6; ++side) {
    std::array<int, 3> normal{};
    normal[static_cast<std::size_t>(side / 2)] = side % 2 == 0 ? 1 : -1;
    text += fmt::format(
        "[[body]]\nname = \"wall{0}\"\nentity = \"wall\"\nshape = \"half-space\"\n"
        "position = [{1}, {1}, {1}]\nnormal = [{2}, {3}, {4}]\n",
        side, side % 2, normal[0], normal[1], normal[2]);
  }
  return text;
}

}  // namespace

TEST_CASE("plain balls meet as all bodies do, bit by bit", "[plain-balls]") {
  constexpr std::uint64_t seed = 41;
  INFO("seed " << seed);
  Random random(seed);
  std::int64_t events = 0;
  double slowest = 1.0;
  for (int round = 0; round < 16; ++round) {
    const std::string text = random_gas(random);
    CAPTURE(round, text);
    ModelOptions options;
    options.broad_phase = round % 3 == 2 ? "dynamic-tree" : "cells";
    const Model model(parse_scene(text, "gas.toml"), options);
    REQUIRE(PlainBalls(model).count() == model.size() - 6);
    const RunChoice choice{.toi_tolerance = round % 4 == 3 ? 1e-6 : 0.0};
    Bits plain;
    Bits general;
    const RunResult short_way = simulate(model, choice, plain);
    const RunResult long_way =
        simulate(model, choice, general, {}, {.impact = std::make_shared<Unabridged>()});
    CHECK(plain.text() == general.text());
    CHECK(short_way.status == long_way.status);
    CHECK(short_way.reason == long_way.reason);
    CHECK(short_way.cost.impacts == long_way.cost.impacts);
    CHECK(short_way.cost.steps == long_way.cost.steps);
    CHECK(short_way.cost.right_hand_sides == long_way.cost.right_hand_sides);
    CHECK(short_way.cost.toi_queries == long_way.cost.toi_queries);
    CHECK(short_way.cost.toi_evaluations == long_way.cost.toi_evaluations);
    events += plain.events;
    slowest = std::min(slowest, plain.slowest);
  }
  CHECK(events > 5000);
  CHECK(slowest == 0.0);
}

TEST_CASE("a detector tells of balls in fewer words what it tells of bodies", "[plain-balls]") {
  constexpr std::uint64_t seed = 43;
  INFO("seed " << seed);
  Random random(seed);
  const auto vector = [&](double size) {
    return Vector3(random.uniform(-size, size), random.uniform(-size, size),
                   random.uniform(-size, size));
  };
  const auto detector = find_detector("certified");
  const auto* const of_balls = dynamic_cast<const BallDetector*>(detector.get());
  REQUIRE(of_balls != nullptr);
  const auto bits = [](const TimeOfImpact& of) {
    Archive archive;
    TimeOfImpact toi = of;
    archive(toi.t_lo, toi.t_hi, toi.gap, toi.normal, toi.witness_a, toi.witness_b, toi.evaluations);
    return archive.bytes();
  };
  int met = 0;
  int missed = 0;
  int unlike = 0;
  int overlap_unlike = 0;
  for (int k = 0; k < 20000; ++k) {
    const double far = k % 5 == 0 ? 1e6 : 0.0;  // from the origin
    const double r_a = random.uniform(0.01, 1.0);
    const double r_b = k % 2 == 0 ? r_a : random.uniform(0.01, 1.0);
    const BallFlight flight{Vector3(far, -far, far) + vector(2.0),
                            vector(3.0),
                            Vector3(0.0, k % 3 == 0 ? 0.0 : -9.81, 0.0),
                            {random.uniform(0.0, 1.0), 0.0},
                            r_a};
    const Window window{{random.uniform(1.0, 2.0), 0.0}, k % 4 == 0 ? 1e3 : 5.0};
    Vector3 normal = Vector3::Unit(k % 3) * (k % 8 < 4 ? 1.0 : -1.0);
    if (k % 7 < 4) {
      normal = vector(1.0).normalized();
    }
    const Pose at_rest{Vector3(far, -far, far) + vector(3.0),
                       k % 9 < 5 ? Quaternion(1.0, 0.0, 0.0, 0.0)
                                 : Quaternion(Eigen::AngleAxisd(random.uniform(0.0, 3.0),
                                                                vector(1.0).normalized()))};
    const Shape ball = Sphere{r_a};
    const Shape wall = HalfSpace{normal};
    const Motion of_ball =
        Motion::ballistic(flight.start, std::numeric_limits<double>::infinity(), {flight.position},
                          {flight.velocity}, flight.acceleration);
    const Motion of_wall = Motion::at_rest(Instant{}, at_rest);
    const TimeOfImpact toi =
        detector->time_of_impact({ball, of_ball}, {wall, of_wall}, window, 0.0);
    const auto told =
        of_balls->ball_meets_plane(flight, std::get<HalfSpace>(wall), at_rest, window);
    REQUIRE(told);
    unlike += told->status != toi.status || bits(*told) != bits(toi) ? 1 : 0;
    met += toi.status == ToiStatus::impact ? 1 : 0;
    missed += toi.status == ToiStatus::separated ? 1 : 0;

    const Vector3 other = flight.position + vector(1.0);
    const Overlap o = detector->overlap(ball, {flight.position}, Sphere{r_b}, {other});
    const Overlap p = of_balls->ball_overlap(flight.position, r_a, other, r_b);
    overlap_unlike += o.overlapping != p.overlapping || o.gap != p.gap || o.normal != p.normal ||
                              o.point != p.point
                          ? 1
                          : 0;
  }
  CHECK(unlike == 0);
  CHECK(overlap_unlike == 0);
  CHECK(met > 1000);
  CHECK(missed > 2000);
}
