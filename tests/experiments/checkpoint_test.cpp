// A run that goes on from a checkpoint gives the bytes of one that was never interrupted.

#include "core/archive.hpp"
#include "core/forces/drag.hpp"
#include "core/random.hpp"
#include "core/reading/scene_reader.hpp"
#include "experiments/checkpoint/checkpoint_file.hpp"
#include "simulation/registry.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"
#include "tests/thoroughness.hpp"

#include <string>
#include <tuple>
#include <vector>

using namespace kairos;
using namespace kairos::experiments;
using tests::kairos_program;
using tests::TemporaryFolder;

// What only this test archives.
namespace kairos {
inline namespace core {
constexpr EventKind last_of(EventKind) { return EventKind::roll_begins; }
constexpr RunStatus last_of(RunStatus) { return RunStatus::stopped; }
}  // namespace core
}  // namespace kairos

namespace {

/// All that a run tells, bit for bit.
class Tape : public Recorder {
 public:
  void frame(const Frame& frame) override {
    Archive archive;
    Instant time = frame.time;
    std::vector<BodyState> bodies(frame.bodies.begin(), frame.bodies.end());
    EnergyLedger ledger = frame.ledger;
    archive(time, bodies, ledger);
    bytes += archive.bytes();
  }
  void event(const Event& event) override {
    Archive archive;
    Event e = event;
    archive(e.time, e.kind, e.a, e.b, e.contact.point, e.contact.normal, e.contact.gap, e.after_a,
            e.after_b);
    bytes += archive.bytes();
  }
  bool persist(Archive& archive) override {
    archive(bytes);
    return true;
  }
  std::string bytes;
};

/// Keeps the checkpoint that a test asks for.
class OneCheckpoint : public CheckpointKeeper {
 public:
  explicit OneCheckpoint(std::int64_t offer) : offer_(offer) {}
  bool wants(Instant /*t*/, bool last) override { return offer_-- == 0 || (last && offer_ > 0); }
  void keep(Instant /*t*/, std::string_view bytes) override { world = bytes; }
  std::string world;

 private:
  std::int64_t offer_;
};

/// The end of a run, with what it cost.
std::string bytes_of(RunResult result) {
  Archive archive;
  archive(result.status, result.reason, result.end, result.state, result.ledger, result.cost);
  return archive.bytes();
}

struct Case {
  std::string name;
  Model model;
  double duration;
};

/// Thirty balls fall into a bowl of walls: enough for a broad phase.
std::string many_balls() {
  std::string text = "name = \"many\"\nsummary = \"many balls\"\nduration = 0.3\n";
  for (const auto& [name, normal, place] :
       {std::tuple{"left", "[1,0,0]", -1.0}, std::tuple{"right", "[-1,0,0]", 1.0}}) {
    text += "[[body]]\nname = \"" + std::string(name) +
            "\"\nentity = \"wall\"\nshape = \"half-space\"\nnormal = " + normal + "\nposition = [" +
            std::to_string(place) + ", 0, 0]\n";
  }
  Random random(7);
  for (int k = 0; k < 30; ++k) {
    text += "[[body]]\nname = \"b" + std::to_string(k) + "\"\nentity = \"ball\"\nradius = 0.05\n" +
            "mass = 1\nrestitution = 0.9\nposition = [" + std::to_string(-0.75 + 0.25 * (k % 6)) +
            ", " + std::to_string(0.2 * (k / 6)) + ", 0]\nvelocity = [" +
            std::to_string(random.uniform(-4.0, 4.0)) + ", 0, 0]\n";
  }
  return text;
}

/// A force that depends on the state, on a body that tumbles or that slides on its support.
Scene with_drag(Scene scene, BodyIndex body) {
  const LinearDrag::Parameters drag{.coefficient = 0.5, .rotational = 0.0};
  scene.forces.push_back({std::make_shared<const LinearDrag>(drag), {body}});
  return scene;
}

constexpr std::string_view slide = R"(name = "slide"
summary = "a ball slides along a floor"
duration = 1.0
[[body]]
name = "floor"
entity = "wall"
shape = "half-space"
[[body]]
name = "ball"
entity = "ball"
radius = 0.1
mass = 1.0
position = [0.0, 0.1, 0.0]
velocity = [1.0, 0.0, 0.0]
restitution = 0.5
)";

/// A bar on a hinge swings against a block.
constexpr std::string_view struck = R"([[body]]
name = "bar"
entity = "body"
half_extents = [0.05, 0.5, 0.05]
mass = 1.0
position = [0.42073549240394825, -0.2701511529340699, 0.0]
axis_angle = [0.0, 0.0, 1.0, 1.0]
[[body]]
name = "block"
entity = "wall"
half_extents = [0.1, 0.3, 1.0]
position = [0.0, -1.25, 0.0]
[[joint]]
kind = "hinge"
bodies = ["bar"]
anchor = [0.0, 0.0, 0.0]
axis = [0.0, 0.0, 1.0]
)";

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const auto& [name, duration] :
       {std::pair{"bounce-inelastic", 1.6}, std::pair{"spinning-box", 0.1}, std::pair{"table", 0.4},
        std::pair{"pad", 1.2}, std::pair{"bat", 0.3}, std::pair{"table-tennis", 0.9},
        std::pair{"double-pendulum", 0.2}, std::pair{"bridge", 0.5}}) {
    all.push_back({name, Model(read_scene(find_scene(name))), duration});
  }
  all.push_back({"drag", Model(with_drag(read_scene(find_scene("spinning-box")), 1)), 0.1});
  all.push_back({"slide", Model(with_drag(parse_scene(slide, "slide.toml"), 1)), 0.5});
  all.push_back({"struck", Model(parse_scene(struck, "struck.toml")), 0.6});
  all.push_back({"many", Model(parse_scene(many_balls(), "many.toml")), 0.25});
  return all;
}

}  // namespace

// By turns: every third of the combinations on a scene, all of them on all scenes by ./test
// --thorough.
TEST_CASE("every scheme and integrator goes on from a checkpoint as if nothing had been",
          "[checkpoint]") {
  std::vector<std::string> names{"auto"};
  for (const IntegratorEntry& entry : integrator_entries()) {
    names.emplace_back(entry.info.name);
  }
  Random random(20261121);
  INFO("seed 20261121");
  const std::size_t every = tests::thorough() ? 1 : 3;
  std::size_t turn = 0;
  int resumed = 0;
  for (const Case& each : cases()) {
    std::size_t combination = turn++;  // the next scene has others
    for (const auto& scheme : schemes()) {
      for (const std::string& integrator : names) {
        if (combination++ % every != 0) {
          continue;
        }
        RunChoice choice;
        choice.method = {std::string(scheme->info().name), integrator, "certified", "newton"};
        choice.duration = each.duration;
        choice.stepper = {1e-6, 1e-6};
        choice.frames = JitteredFrames{.mean = 1.0 / 100.0, .jitter = 0.3};
        if (!why_refused(each.model, choice).empty()) {
          continue;
        }
        CAPTURE(each.name, choice.method.scheme, integrator);
        Tape unbroken;
        const RunResult whole = simulate(each.model, choice, unbroken);

        // Interrupted somewhere on the way to the same end, or ended early and taken further.
        RunChoice first = choice;
        const bool ends_early = random.uniform() < 0.5;
        first.duration = ends_early ? each.duration * random.uniform(0.1, 0.9) : each.duration;
        OneCheckpoint keeper(ends_early ? 1000000
                                        : static_cast<std::int64_t>(random.below(
                                              static_cast<std::uint64_t>(each.duration * 90.0))));
        Tape broken;
        const RunResult part = simulate(each.model, first, broken, {&keeper, {}});
        if (part.status == RunStatus::stopped && keeper.world.empty()) {
          continue;  // stopped before
        }
        REQUIRE_FALSE(keeper.world.empty());
        Tape tape;
        const RunResult result = simulate(each.model, choice, tape, {nullptr, keeper.world});
        CHECK(tape.bytes == unbroken.bytes);
        CHECK(bytes_of(result) == bytes_of(whole));
        ++resumed;
      }
    }
  }
  CAPTURE(resumed);
  CHECK(resumed > (tests::thorough() ? 500 : 160));
}

TEST_CASE("run --save and --resume: the files of a run that was never interrupted",
          "[checkpoint]") {
  const TemporaryFolder folder;
  const auto run = [](std::vector<std::string> more) {
    std::vector<std::string> arguments{"run", "billiard", "--set", "body.ball-01.mass=2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return kairos_program(arguments);
  };
  const std::string saved = folder.path("half.checkpoint");
  REQUIRE(run({"--duration", "0.7", "--save", saved}).exit_code == 0);
  const auto on = run({"--duration", "2", "--resume", saved, "--out", folder.path("resumed")});
  const auto whole = run({"--duration", "2", "--out", folder.path("whole")});
  REQUIRE(on.exit_code == 0);
  CHECK(on.out == whole.out);
  for (const char* name : {"trajectory.csv", "events.csv", "energy.csv", "summary.json"}) {
    CAPTURE(name);
    CHECK(tests::read_all(folder.path("resumed") + "/" + name) ==
          tests::read_all(folder.path("whole") + "/" + name));
  }
  // Nothing is left beside what was asked for.
  CHECK(folder.entries("resumed").size() == 4);
  CHECK(folder.entries().size() == 3 + 2 * 4);

  SECTION("what is not of this run is refused, with a reason") {
    const auto refused = [&](std::vector<std::string> arguments, const std::string& why) {
      arguments.insert(arguments.begin(), "run");
      const auto outcome = kairos_program(arguments);
      CAPTURE(outcome.err, why);
      CHECK(outcome.exit_code == 2);
      CHECK(outcome.err.find(why) != std::string::npos);
      CHECK(outcome.out.empty());
    };
    const std::string set = "body.ball-01.mass=2";
    refused({"bounce", "--resume", saved}, "scene");
    refused({"billiard", "--resume", saved}, "body.ball-01.mass");
    refused({"billiard", "--set", "body.ball-01.mass=3", "--resume", saved}, "'2'");
    refused({"billiard", "--set", set, "--scheme", "bisected", "--resume", saved}, "scheme");
    refused({"billiard", "--set", set, "--frame", "1/50", "--resume", saved}, "frame");
    refused({"billiard", "--set", set, "--duration", "0.1", "--resume", saved}, "--duration");
    refused({"billiard", "--set", set, "--resume", folder.path("none")}, "cannot be read");

    const std::string bytes = tests::read_all(saved);
    const auto broken = [&](const std::string& text, const std::string& why) {
      refused({"billiard", "--set", set, "--resume", folder.file("broken", text)}, why);
    };
    for (const std::size_t size :
         {bytes.size() - 1, bytes.size() / 2, std::size_t{400}, std::size_t{25}}) {
      broken(bytes.substr(0, size), "cut off");
    }
    broken("", "not a checkpoint");
    broken("name = \"bounce\"\n", "not a checkpoint");
    broken("kairos checkpoint 999\n" + bytes.substr(bytes.find('\n') + 1), "format 999");
    std::string changed = bytes;
    changed[bytes.size() - 100] = static_cast<char>(changed[bytes.size() - 100] ^ 1);
    broken(changed, "checksum");
    broken(bytes + "x", "damaged");
  }
}

TEST_CASE("an archive that ends too early says so, and gives nothing more", "[checkpoint]") {
  Archive out;
  std::vector<double> values{1.0, 2.0, 3.0};
  out(values);
  for (std::size_t size = 0; size < out.bytes().size(); ++size) {
    Archive in(std::string_view(out.bytes()).substr(0, size));
    std::vector<double> read;
    CHECK_THROWS_AS(in(read), ArchiveError);
  }
  Archive in(out.bytes());
  std::vector<double> read;
  in(read);
  CHECK(read == values);
  CHECK(in.left() == 0);
}
