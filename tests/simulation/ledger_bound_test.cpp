// The bound of the ledger, |unexplained| <= 8 eps flow, where it is hard to keep: long elastic
// runs, crowds, every scheme.

#include "core/random.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/registry.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/ledger_check.hpp"
#include "tests/thoroughness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

using namespace kairos;

namespace {

class FrameBalance : public Recorder {
 public:
  void frame(const Frame& frame) override { tests::check_explained(frame.ledger); }
};

class Order : public FrameBalance {
 public:
  void event(const Event& event) override {
    if (event.time < last_) {
      ++backwards;
    }
    last_ = event.time;
    deepest = std::min(deepest, event.contact.gap);
  }
  int backwards = 0;     ///< events told after one that was later
  double deepest = 0.0;  ///< the least gap of an impact, m

 private:
  Instant last_;
};

/// Twenty-seven inelastic balls fall, in a crowd, into a box of five walls: in one frame a ball may
/// meet several others, of which some are told of before those that were earlier.
std::string crowd() {
  std::string text = "duration = 4\nframe = \"1/60\"\nG = 9.81\n";
  const std::pair<const char*, const char*> walls[] = {{"[0, 0, 0]", "[0, 1, 0]"},
                                                       {"[-0.3, 0, 0]", "[1, 0, 0]"},
                                                       {"[0.3, 0, 0]", "[-1, 0, 0]"},
                                                       {"[0, 0, -0.3]", "[0, 0, 1]"},
                                                       {"[0, 0, 0.3]", "[0, 0, -1]"}};
  int number = 0;
  for (const auto& [position, normal] : walls) {
    text += fmt::format(
        "[[body]]\nname = \"wall {2}\"\nentity = \"wall\"\nshape = \"half-space\"\n"
        "position = {0}\nnormal = {1}\n",
        position, normal, ++number);
  }
  Random random(20261122);
  for (int k = 0; k < 27; ++k) {
    const Vector3 place(k % 3 - 1, k / 9, k / 3 % 3 - 1);
    const Vector3 p = Vector3(0, 0.3, 0) + 0.19 * place +
                      0.01 * Vector3(random.uniform(), random.uniform(), random.uniform());
    text += fmt::format(
        "[[body]]\nname = \"ball {}\"\nentity = \"ball\"\nradius = 0.08\nmass = 1.0\n"
        "restitution = 0.8\nposition = [{:.17g}, {:.17g}, {:.17g}]\n",
        k, p.x(), p.y(), p.z());
  }
  return text;
}

void check_frames(const std::string& scene, const MethodChoice& method, double duration) {
  CAPTURE(scene, method.scheme, method.integrator);
  const Model model(read_scene(find_scene(scene)));
  RunChoice choice;
  choice.method = method;
  choice.duration = duration;
  if (why_refused(model, choice).empty()) {
    FrameBalance balance;
    (void)simulate(model, choice, balance);
  }
}

}  // namespace

TEST_CASE("ledger: what is elastic is explained for long, whatever the scheme", "[ledger][slow]") {
  // Balls that fell through the floor of `balls` go on to fall, by then at 200 m/s.
  const std::pair<const char*, double> runs[] = {
      {"billiard", 30.0}, {"balls", 20.0}, {"table", 30.0}};
  for (const auto& [scene, duration] : runs) {
    for (const auto& scheme : schemes()) {
      check_frames(scene, {std::string(scheme->info().name), "auto", "certified", "newton"},
                   duration);
    }
  }
}

TEST_CASE("ledger: what is elastic is explained for hundreds of seconds", "[ledger][slow]") {
  const double longest = tests::thorough() ? 1000.0 : 200.0;
  for (const char* scene : {"billiard", "bounce", "cradle", "table", "spinning-box"}) {
    for (const auto& scheme : schemes()) {
      for (const char* integrator : {"auto", "symplectic-euler"}) {
        // penalty and xpbd take 100 and 20 steps a frame, and a box that tumbles many, whose
        // impacts are looked for in each.
        const bool tumbles = std::string_view(scene) == "spinning-box";
        const bool steps = !scheme->info().integrator.empty();
        const double duration = steps ? longest / 50.0 : tumbles ? longest / 5.0 : longest;
        check_frames(scene, {std::string(scheme->info().name), integrator, "certified", "newton"},
                     duration);
      }
    }
  }
}

TEST_CASE("ledger: a box that is sent to and fro by walls gives up its energy and gets it back",
          "[ledger]") {
  const Model model(parse_scene(
      "duration = 1000\nframe = 1\nG = 0\n[[body]]\nname = \"high\"\nentity = \"wall\"\n"
      "shape = \"half-space\"\nnormal = [-0.6, -0.8, 0]\nposition = [1.2, 1.6, 0]\n"
      "[[body]]\nname = \"low\"\nentity = \"wall\"\nshape = \"half-space\"\n"
      "normal = [0.6, 0.8, 0]\nposition = [-1.2, -1.6, 0]\n[[body]]\nname = \"ball\"\n"
      "entity = \"ball\"\nradius = 0.1\nmass = 1\nvelocity = [30, 40, 0]\n",
      ""));
  FrameBalance balance;
  const RunResult result = simulate(model, {}, balance);
  CHECK(result.cost.impacts > 10'000);
}

TEST_CASE("ledger: no frame of a crowd undoes an impact that was booked, and events are in order",
          "[ledger][slow]") {
  const Model model(parse_scene(crowd(), ""));
  for (const auto& scheme : schemes()) {
    const std::string name(scheme->info().name);
    CAPTURE(name);
    Order order;
    RunChoice choice;
    choice.method = {name, "auto", "certified", "newton"};
    if (name == "event-driven") {
      choice.duration = 0.6;  // what follows are hops that die out, for most of the time it takes
    }
    (void)simulate(model, choice, order);
    CHECK(order.backwards == 0);
    CHECK((name != "event-driven" || order.deepest > -1e-12));
  }
}
