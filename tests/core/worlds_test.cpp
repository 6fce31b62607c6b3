// What the schemes ask of their ports, and in which order: both worlds with a stepper, a detector
// and a law that write down what they are asked.

#include "core/laws/newton_law.hpp"
#include "core/model.hpp"
#include "core/reading/scene_reader.hpp"
#include "core/scheme.hpp"
#include "core/schemes/event/event_driven.hpp"
#include "core/schemes/frame/bisected.hpp"
#include "core/schemes/frame/original.hpp"
#include "core/trajectory.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

using namespace kairos;

namespace {

/// All that was asked, in order.
struct Call {
  enum class What { start, restart, step, look, law } what = What::start;
  std::size_t island = 0;  ///< of a stepper
  double t = 0.0;          ///< s; of a detector: where its window begins
  double length = 0.0;     ///< s, of a step or window
  double x = 0.0;          ///< m, of the first body, as a stepper is told
  double latest = 0.0;     ///< s; of a detector: where the later of the two motions begins
};
struct Log {
  std::vector<Call> calls;
  [[nodiscard]] std::vector<Call> of(Call::What what) const {
    std::vector<Call> found;
    std::copy_if(calls.begin(), calls.end(), std::back_inserter(found),
                 [what](const Call& c) { return c.what == what; });
    return found;
  }
  [[nodiscard]] std::vector<Call> of(Call::What what, std::size_t island) const {
    std::vector<Call> found = of(what);
    std::erase_if(found, [island](const Call& c) { return c.island != island; });
    return found;
  }
};

/// Straight on, in steps of at most `longest`; its step number `fails` does not succeed.
class StraightOn final : public Stepper {
 public:
  StraightOn(Log& log, std::size_t island, double longest, int fails)
      : log_(log), island_(island), longest_(longest), fails_(fails) {}

  [[nodiscard]] StepperInfo info() const override {
    return {"straight-on", 1, 1, 1, false, false, "tests", "", false};
  }
  [[nodiscard]] std::string refuses(const Island&) const override { return {}; }
  void start(const Island&, Instant t, std::span<const BodyState> states) override {
    write(Call::What::start, t, 0.0, states);
  }
  void restart(const Island&, Instant t, std::span<const BodyState> states) override {
    write(Call::What::restart, t, 0.0, states);
  }
  StepResult step(const Island&, Instant t, double h, std::span<BodyState> states) override {
    write(Call::What::step, t, h, states);
    if (--fails_ == 0) {
      StepResult failed;
      failed.ok = false;
      failed.reason = "it was told to fail";
      return failed;
    }
    StepResult result;
    result.advanced = std::min(h, longest_);
    motions_.clear();
    for (BodyState& s : states) {
      motions_.push_back(Motion::ballistic(t, result.advanced, s.pose,
                                           {s.twist.linear, Vector3::Zero()}, Vector3::Zero()));
      s.pose.position += result.advanced * s.twist.linear;
    }
    return result;
  }
  void dense_output(std::span<Motion> motions) const override {
    std::copy(motions_.begin(), motions_.end(), motions.begin());
  }
  [[nodiscard]] std::int64_t evaluations() const override { return 0; }

 private:
  void write(Call::What what, Instant t, double h, std::span<const BodyState> states) {
    log_.calls.push_back({what, island_, t.seconds, h, states[0].pose.position.x(), 0.0});
  }

  Log& log_;
  std::size_t island_;
  double longest_;
  int fails_;
  std::vector<Motion> motions_;
};

/// Balls of 0.1 m that move along x, without acceleration: exact.
class AlongX final : public ContactDetector {
 public:
  explicit AlongX(Log& log) : log_(log) {}

  [[nodiscard]] DetectorInfo info() const override {
    return {.name = "along-x", .locates = true, .proves = true, .summary = ""};
  }
  [[nodiscard]] bool overlaps(const Shape& a, const Pose& pose_a, const Shape& b,
                              const Pose& pose_b) const override {
    return overlap(a, pose_a, b, pose_b).gap < 0.0;
  }
  [[nodiscard]] Overlap overlap(const Shape&, const Pose& pose_a, const Shape&,
                                const Pose& pose_b) const override {
    const double d = pose_b.position.x() - pose_a.position.x();
    Overlap o;
    o.normal = (d < 0.0 ? -1.0 : 1.0) * Vector3::UnitX();
    o.gap = std::abs(d) - 0.2;
    o.point = 0.5 * (pose_a.position + pose_b.position);
    o.overlapping = o.gap < 0.0;
    return o;
  }
  [[nodiscard]] TimeOfImpact time_of_impact(const MovingShape& a, const MovingShape& b,
                                            const Window& window, double) const override {
    log_.calls.push_back({Call::What::look, 0, window.start.seconds, window.duration, 0.0,
                          std::max(a.motion.start, b.motion.start).seconds});
    const auto at = [&](const MovingShape& s) {
      return s.motion.position(window.start - s.motion.start).x();
    };
    const double d = at(b) - at(a);
    const double v = b.motion.velocity[0].x() - a.motion.velocity[0].x();
    const double side = d < 0.0 ? -1.0 : 1.0;
    TimeOfImpact toi;
    toi.t_lo = toi.t_hi = window.duration;
    toi.evaluations = 1;
    const double t = v * side < 0.0 ? (std::abs(d) - 0.2) / (-v * side)
                                    : std::numeric_limits<double>::infinity();
    if (t <= window.duration) {
      toi.status = ToiStatus::impact;
      toi.t_lo = toi.t_hi = std::max(t, 0.0);
      toi.normal = side * Vector3::UnitX();
    }
    return toi;
  }
  [[nodiscard]] TimeOfImpact time_of_separation(const MovingShape&, const MovingShape&,
                                                const Window&, double) const override {
    return {};
  }
  [[nodiscard]] bool swept_overlap(const MovingShape&, const MovingShape&,
                                   const Window&) const override {
    return true;
  }

 private:
  Log& log_;
};

/// Newton's law, written down.
class WrittenLaw final : public ImpactLaw {
 public:
  explicit WrittenLaw(Log& log) : log_(log), law_(make_newton_law()) {}
  [[nodiscard]] LawInfo info() const override { return law_->info(); }
  ImpactEnergy apply(const Contact& contact, ImpactBody a, ImpactBody b) const override {
    log_.calls.push_back({.what = Call::What::law, .x = a.state.pose.position.x()});
    return law_->apply(contact, a, b);
  }

 private:
  Log& log_;
  std::unique_ptr<ImpactLaw> law_;
};

/// Balls on a line, at 0 and with the velocities of `speeds`, 1 m apart; each an island of its own,
/// in the order of the names a, b, c, ...
Model balls(const std::vector<double>& speeds) {
  std::string text = "name = \"line\"\nsummary = \"\"\nduration = 2.0\nframe = 0.25\nG = 0.0\n";
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    const char name = static_cast<char>('a' + i);
    text += std::string("[[body]]\nname = \"") + name +
            "\"\nentity = \"ball\"\nradius = 0.1\nmass = 1.0\nposition = [" + std::to_string(i) +
            ".0, 0.0, 0.0]\nvelocity = [" + std::to_string(speeds[i]) + ", 0.0, 0.0]\n";
  }
  ModelOptions options;
  options.closed_form = false;
  return Model(parse_scene(text, "line.toml"), options);
}

struct Ran {
  Log log;
  Trajectory trajectory;
  RunResult result;
};

std::unique_ptr<Ran> run(const Model& model, std::unique_ptr<Scheme> scheme, double longest,
                         int fails = 0) {
  auto ran = std::make_unique<Ran>();
  Log& log = ran->log;
  const Method method{.stepper =
                          [&log, longest, fails](const Model&, std::size_t island) {
                            return std::make_unique<StraightOn>(log, island, longest, fails);
                          },
                      .detector = std::make_shared<AlongX>(log),
                      .law = std::make_shared<WrittenLaw>(log),
                      .broad_phase = {},
                      .swept_bounds = {}};
  const SchemeOptions options{.frames = FixedFrames{0.25}, .duration = 2.0, .step = 0.5};
  REQUIRE(scheme->refuses(model, method, options).empty());
  ran->result = scheme->run(model, method, options, ran->trajectory);
  return ran;
}

}  // namespace

TEST_CASE("event world: an impact restarts the two islands that it changes, and no other",
          "[worlds]") {
  // a meets b at 0.8 s, when they are 0.2 m apart; b goes on and would meet c after the end.
  const Model model = balls({1.0, 0.0, 0.0});
  const auto ran = run(model, make_event_driven(), 10.0);
  REQUIRE(ran->result.status == RunStatus::completed);
  REQUIRE(ran->trajectory.events().size() == 2);
  CHECK(ran->log.of(Call::What::law).size() == 2);
  for (std::size_t island = 0; island < 3; ++island) {
    CHECK(ran->log.of(Call::What::start, island).size() == 1);
  }
  // a and b at 0.8 s, b and c at 1.6 s.
  CHECK(ran->log.of(Call::What::restart, 0).size() == 1);
  CHECK(ran->log.of(Call::What::restart, 1).size() == 2);
  CHECK(ran->log.of(Call::What::restart, 2).size() == 1);
  for (const Call& c : ran->log.of(Call::What::restart, 0)) {
    CHECK(std::abs(c.t - 0.8) <= 1e-15);  // roundoff of one division
    CHECK(std::abs(c.x - 0.8) <= 1e-15);
  }
  CHECK(ran->result.state[2].twist.linear.x() == 1.0);  // equal masses exchange velocities
  CHECK(ran->result.ledger.unexplained() == 0.0);
}

TEST_CASE("event world: segments join, and a stepper goes on from where it was", "[worlds]") {
  const Model model = balls({0.5, 0.5});
  const auto ran = run(model, make_event_driven(), 0.125);
  REQUIRE(ran->result.status == RunStatus::completed);
  for (std::size_t island = 0; island < 2; ++island) {
    const std::vector<Call> steps = ran->log.of(Call::What::step, island);
    REQUIRE(steps.size() >= 16);  // 2 s in steps of 0.125 s
    for (std::size_t k = 0; k < steps.size(); ++k) {
      CHECK(steps[k].t == 0.125 * static_cast<double>(k));  // both exact in binary
      CHECK(steps[k].x == static_cast<double>(island) + 0.5 * steps[k].t);
      CHECK(steps[k].length == 0.5);  // what the options allow
    }
    CHECK(ran->log.of(Call::What::restart, island).empty());
  }
}

TEST_CASE("event world: a query begins where the later of two motions does", "[worlds]") {
  const Model model = balls({1.0, 0.0, -0.5, -0.5});
  const auto ran = run(model, make_event_driven(), 0.25);
  REQUIRE(ran->result.status == RunStatus::completed);
  const std::vector<Call> looks = ran->log.of(Call::What::look);
  REQUIRE(looks.size() >= 20);
  for (const Call& look : looks) {
    CHECK(look.t == look.latest);
    CHECK(look.length <= 0.25);  // no further than the motions
  }
}

TEST_CASE("event world: who meets nobody is never restarted", "[worlds]") {
  // a and b meet at 0.4 s; c and d fly ahead of all others.
  const Model model = balls({1.0, -1.0, 3.0, 4.0});
  const auto ran = run(model, make_event_driven(), 100.0);
  REQUIRE(ran->result.status == RunStatus::completed);
  CHECK(ran->log.of(Call::What::law).size() == 1);
  CHECK(ran->log.of(Call::What::step, 2).size() == ran->log.of(Call::What::step, 3).size());
  CHECK(ran->log.of(Call::What::restart, 2).empty());
  CHECK(ran->log.of(Call::What::restart, 3).empty());
}

TEST_CASE("worlds: a stepper that fails ends the run with its reason, where it was", "[worlds]") {
  const Model model = balls({0.5, 0.5});
  for (const bool event : {true, false}) {
    CAPTURE(event);
    const auto ran = run(model, event ? make_event_driven() : make_original(), 0.25, /*fails=*/3);
    CHECK(ran->result.status == RunStatus::stopped);
    CHECK(ran->result.reason == "integrator: it was told to fail");
    CHECK(ran->result.state[0].pose.position.allFinite());
    CHECK(ran->result.end.seconds < 2.0);
  }
}

TEST_CASE("frame world: one step a frame, or as many as the stepper takes", "[worlds]") {
  const Model model = balls({0.5, 0.5});
  const auto whole = run(model, make_original(), 10.0);
  REQUIRE(whole->result.status == RunStatus::completed);
  const std::vector<Call> steps = whole->log.of(Call::What::step, 1);
  REQUIRE(steps.size() == 8);
  for (std::size_t k = 0; k < steps.size(); ++k) {
    CHECK(steps[k].t == 0.25 * static_cast<double>(k));
    CHECK(steps[k].length == 0.25);
  }
  const auto parts = run(model, make_original(), 0.0625);
  const std::vector<Call> short_steps = parts->log.of(Call::What::step, 1);
  REQUIRE(short_steps.size() == 32);
  for (std::size_t k = 0; k < short_steps.size(); ++k) {
    CHECK(short_steps[k].t == 0.0625 * static_cast<double>(k));
    CHECK(short_steps[k].length == 0.25 - 0.0625 * static_cast<double>(k % 4));
  }
  CHECK(whole->result.state[1].pose.position == parts->result.state[1].pose.position);
}

TEST_CASE("frame world: contacts are handled where bodies are drawn, and both islands restarted",
          "[worlds]") {
  // They overlap first in the frame of 1 s, 0.2 s late: the thesis' defect.
  const Model model = balls({1.0, 0.0});
  const auto ran = run(model, make_original(), 10.0);
  const std::vector<Call> laws = ran->log.of(Call::What::law);
  REQUIRE_FALSE(laws.empty());
  CHECK(laws.front().x == 1.0);
  for (std::size_t island = 0; island < 2; ++island) {
    const std::vector<Call> restarts = ran->log.of(Call::What::restart, island);
    REQUIRE_FALSE(restarts.empty());
    CHECK(restarts.front().t == 1.0);
  }
  CHECK(ran->log.of(Call::What::look).empty());  // it locates nothing
}

TEST_CASE("frame world: bisected goes to the contact within the frame, and on from there",
          "[worlds]") {
  const Model model = balls({1.0, 0.0});
  const auto ran = run(model, make_bisected(), 10.0);
  REQUIRE(ran->result.status == RunStatus::completed);
  REQUIRE(ran->log.of(Call::What::law).size() == 1);
  CHECK(std::abs(ran->log.of(Call::What::law).front().x - 0.8) <= 4e-16);  // roundoff of the way
  CHECK(ran->result.state[0].twist.linear.x() == 0.0);
  CHECK(std::abs(ran->result.state[1].pose.position.x() - 2.2) <= 1e-15);
}
