// What accuracy costs: tradeoff, recommend, savings.

#include "core/exact_solution.hpp"
#include "core/reading/scene_reader.hpp"
#include "experiments/ablation/ablation_experiment.hpp"
#include "experiments/data_folders.hpp"
#include "experiments/sweeps/sweep_spec.hpp"
#include "experiments/tradeoff/recommend.hpp"
#include "simulation/scene_library.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace kairos;
using namespace kairos::experiments;

namespace {

/// Scenes that no experiment and no shipped scene has, each with an exact solution.
constexpr std::string_view thrown = R"(name = "thrown"
summary = "a ball is thrown at a floor"
duration = 3.3
frame = "1/50"
G = 3.71
[[body]]
name = "floor"
entity = "wall"
shape = "half-space"
[[body]]
name = "ball"
entity = "ball"
radius = 0.03
mass = 0.4
position = [0.0, 2.17, 0.0]
velocity = [0.7, -1.3, 0.2]
[exact]
solution = "elastic-drop"
)";

constexpr std::string_view shot = R"(name = "shot"
summary = "a ball flies at a plate"
duration = 0.31
frame = "1/75"
G = 0.0
[[body]]
name = "plate"
entity = "wall"
half_extents = [0.04, 1.0, 1.0]
normal = [-1.0, 0.0, 0.0]
position = [0.3, 0.0, 0.0]
[[body]]
name = "ball"
entity = "ball"
radius = 0.07
mass = 2.0
restitution = 0.8
position = [-1.4, 0.0, 0.0]
velocity = [9.1, 0.0, 0.0]
[exact]
solution = "reflection"
)";

constexpr std::string_view row = R"(name = "row"
summary = "three equal balls on a line"
duration = 1.7
frame = "1/60"
G = 0.0
[[body]]
name = "a"
entity = "ball"
radius = 0.05
mass = 0.3
position = [-1.0, 0.0, 0.0]
velocity = [2.3, 0.0, 0.0]
[[body]]
name = "b"
entity = "ball"
radius = 0.05
mass = 0.3
position = [0.0, 0.0, 0.0]
[[body]]
name = "c"
entity = "ball"
radius = 0.05
mass = 0.3
position = [0.6, 0.0, 0.0]
velocity = [0.4, 0.0, 0.0]
[exact]
solution = "equal-masses"
)";

/// How far the method is off where the exact solution says it should be, m.
double error_against_exact(const Model& model, const RunChoice& choice) {
  const auto exact = solve_exactly(model.scene());
  Recorder nobody;
  const RunResult result = simulate(model, choice, nobody);
  REQUIRE(result.status == RunStatus::completed);
  double worst = 0.0;
  for (BodyIndex i = 0; i < model.size(); ++i) {
    const auto state = exact->state(i, Instant{} + model.scene().duration);
    if (model.is_free(i) && state) {
      worst = std::max(worst, (result.state[i].pose.position - state->pose.position).norm());
    }
  }
  return worst;
}

Recommendation advised(const Model& model, const Assessment& assessment, const Requirements& wanted,
                       double frame) {
  return recommend(assessment, wanted, frame, whole_run_of(model, assessment.reference, wanted));
}

}  // namespace

TEST_CASE("what recommend picks meets the bound on scenes held apart", "[recommend]") {
  for (const std::string_view text : {thrown, shot, row}) {
    const Model model(parse_scene(text, "apart.toml"));
    const double frame = mean_frame_duration(model.scene().frames);
    const Assessment assessment = assess(model, model.scene().duration, 0);
    CHECK(assessment.reference.kind == "exact solution");
    std::int64_t work = 0;
    for (const double bound : {1e-1, 1e-3, 1e-9}) {
      const Recommendation found =
          advised(model, assessment, {.error = bound, .penetration = 0.0}, frame);
      CAPTURE(model.scene().name, bound);
      REQUIRE(found.pick);
      const Assessed& pick = assessment.methods[*found.pick];
      CAPTURE(pick.candidate.name);
      CHECK(error_against_exact(model, pick.candidate.choice) <= bound);
      CHECK(pick.run.metrics.deepest().depth == 0.0);
      CHECK(pick.run.work() >= work);  // a tighter bound is never cheaper
      work = pick.run.work();
      for (std::size_t i = 0; i < assessment.methods.size(); ++i) {
        // Nothing that does is cheaper.
        CHECK((!found.shortcomings[i].empty() ||
               assessment.methods[i].run.work() >= pick.run.work()));
      }
    }
    // What nobody can: none.
    CHECK_FALSE(advised(model, assessment, {.error = 1e-30, .penetration = {}}, frame).pick);
    Requirements hasty{.error = 1.0};
    hasty.budget = 1e-12;
    CHECK_FALSE(advised(model, assessment, hasty, frame).pick);
  }
}

TEST_CASE("recommend advises nothing from a part of the run in which nothing happens",
          "[recommend]") {
  // Once the rack is broken, what differs by a hair differs by everything: methods can be compared
  // over the first half second only, in which the white ball is still alone.
  const auto refused = tests::kairos_program({"recommend", "billiard", "--error", "1e-2"});
  CAPTURE(refused.out, refused.err);
  CHECK(refused.exit_code == 1);
  CHECK(refused.out.find("no advice") != std::string::npos);
  CHECK(refused.err.find("no impact of ball and ball") != std::string::npos);
  CHECK(refused.out.find("kairos run") == std::string::npos);
}

TEST_CASE("recommend looks for penetration over the whole run, asked or not", "[recommend]") {
  const Model model(parse_scene(thrown, "apart.toml"));
  const double frame = mean_frame_duration(model.scene().frames);
  Assessment assessment = assess(model, 0.2, 0);  // before the first impact
  assessment.reference.whole = model.scene().duration;
  // Of the methods that look once a frame, by the free flight alone each one does.
  std::erase_if(assessment.methods, [](const Assessed& method) {
    return method.candidate.group != "original" ||
           method.candidate.name.find('/') != std::string::npos;
  });
  REQUIRE(assessment.methods.size() >= 4);
  const auto nobody_looks = [](const Assessed&) { return std::string(); };
  CHECK(recommend(assessment, {.error = 1.0}, frame, nobody_looks).pick);
  const Recommendation held = advised(model, assessment, {.error = 1.0}, frame);
  CHECK_FALSE(held.pick);
  for (const std::string& why : held.shortcomings) {
    CHECK(why.find("deep over 3.3 s") != std::string::npos);  // a ball of 3 cm is through
  }
  CHECK(advised(model, assessment, {.error = 1.0, .penetration = 1.0}, frame).pick);
}

TEST_CASE("the command that recommend prints runs as it stands, with all that was set",
          "[recommend]") {
  const tests::TemporaryFolder folder;
  const std::string scene = folder.file("it's a \"scene\" $HOME.toml", std::string(shot));
  const auto advice =
      tests::kairos_program({"recommend", scene, "--error", "1e-3", "--duration", "1/4", "--set",
                             "body.ball.mass=3.5", "--set", "summary=a ball's flight"});
  CAPTURE(advice.out, advice.err);
  REQUIRE(advice.exit_code == 0);
  const std::size_t begin = advice.out.find("kairos run ");
  REQUIRE(begin != std::string::npos);
  const std::string command = advice.out.substr(begin, advice.out.find('\n', begin) - begin);
  const std::string out = folder.path("out");
  CAPTURE(command);
  REQUIRE(tests::in_a_shell(command + " --out " + out) == 0);
  const std::string summary = tests::read_all(out + "/summary.json");
  CHECK(summary.find("\"end\": 0.25") != std::string::npos);
  CHECK(summary.find("\"name\": \"shot\"") != std::string::npos);
  // What was set is in it: 3.5 kg at 9.1 m/s.
  CHECK(summary.find("\"initial\": 144.9") != std::string::npos);
}

TEST_CASE("tradeoff: what ends beyond all that moves has diverged, and is on no front",
          "[tradeoff]") {
  // A stiff spring and steps far too long for it: the thesis' arithmetic blows up.
  const Model model(read_scene(find_scene("spring")));
  const Assessment assessment = assess(model, model.scene().duration, 0);
  int diverged = 0;
  for (auto error :
       {&Errors::position, &Errors::event_time, &Errors::penetration, &Errors::energy}) {
    const std::vector<bool> front = pareto_front(assessment, error);
    for (std::size_t i = 0; i < front.size(); ++i) {
      const Assessed& method = assessment.methods[i];
      const bool far = !(method.errors.position <= assessment.reference.scale);
      diverged += far ? 1 : 0;
      CHECK_FALSE((far && front[i]));
      CHECK((!far || !method.run.completed()));
    }
  }
  CHECK(diverged > 0);
}

TEST_CASE(
    "tradeoff: a scene of bodies in touch is compared with, too: one of them has room to be moved",
    "[tradeoff]") {
  const Model model(read_scene(find_scene("stack")));
  constexpr double duration = 0.1;  // s
  const Reference reference = find_reference(model, duration);
  CHECK(reference.until == duration);
  CHECK(reference.lyapunov == 0.0);  // what is at rest stays beside itself
}

TEST_CASE("tradeoff: the scenes of the experiment tell frames of h/4 and h/16 apart",
          "[tradeoff]") {
  const ExperimentSpec spec = read_experiment(find_experiment("tradeoff"), Size::quick);
  const Model model(read_scene(find_scene(spec.scenes.front())));
  const Assessment assessment = assess(model, model.scene().duration, 0);
  const auto error_of = [&](const std::string& name) {
    for (const Assessed& method : assessment.methods) {
      if (method.candidate.name == name) {
        return method.errors.position;
      }
    }
    return -1.0;
  };
  for (const std::string name : {"original velocity-verlet", "original rk4"}) {
    // Of first order in the frame, but for where in a frame an impact happens to be.
    CHECK(error_of(name + ", h/16") < 0.7 * error_of(name + ", h/4"));
    CHECK(error_of(name + ", h/16") > 0.0);
  }
}

TEST_CASE("the commands tradeoff and recommend: evidence, the same each time", "[recommend]") {
  const auto once = tests::kairos_program({"recommend", "bullet", "--error", "1e-6"});
  const auto again =
      tests::kairos_program({"recommend", "bullet", "--error", "1e-6", "--threads", "1"});
  CHECK(once.exit_code == 0);
  CHECK(once.out == again.out);
  CHECK(once.out.find("kairos run bullet --scheme") != std::string::npos);
  CHECK(once.out.find("exact solution") != std::string::npos);
  const auto none = tests::kairos_program({"recommend", "bounce", "--error", "1e-300"});
  CHECK(none.exit_code == 1);
  CHECK(none.out.find("none of") != std::string::npos);
  CHECK(tests::kairos_program({"recommend", "bullet", "--error", "0"}).exit_code == 2);
  CHECK(tests::kairos_program({"recommend", "bullet", "--error", "nan"}).exit_code == 2);
  CHECK(tests::kairos_program({"recommend", "bullet"}).exit_code == 2);
  CHECK(tests::kairos_program({"recommend", "bullet", "--error", "1", "--budget", "soon"})
            .exit_code == 2);
  const auto chaotic = tests::kairos_program({"tradeoff", "billiard"});
  CHECK(chaotic.exit_code == 0);
  CHECK(chaotic.out.find("chaotic: compared up to") != std::string::npos);
}

TEST_CASE("tradeoff: who misses an impact has no error of its time, and is no cheapest answer",
          "[tradeoff]") {
  const BodyPair pair{0, 1}, other{0, 2};
  Assessment assessment;
  assessment.reference.impacts = {{pair, {1.0, 2.0}}, {other, {}}};
  for (const auto& impacts : {std::vector<double>{}, {1.25, 2.0}, {1.0}}) {
    MeasuredRun run{.status = "completed", .reason = {}, .end = {}};
    run.impacts[pair] = impacts;
    run.cost.overlap_tests = static_cast<std::int64_t>(impacts.size());
    assessment.methods.push_back({{}, run, errors_of(run, assessment.reference)});
  }
  CHECK(std::isinf(assessment.methods[0].errors.event_time));
  CHECK(assessment.methods[0].errors.missed == 2);
  CHECK(assessment.methods[1].errors.event_time == 0.25);
  CHECK(assessment.methods[2].errors.event_time == 0.0);  // of the one that both have
  CHECK(assessment.methods[2].errors.missed == 1);
  CHECK(pareto_front(assessment, &Errors::event_time) == std::vector<bool>{false, false, true});
}

TEST_CASE("each saving of the model saves, and changes no answer", "[ablation]") {
  for (const Ablation& ablation : ablations()) {
    const Ablated r = ablate(ablation);
    CAPTURE(ablation.saving, ablation.scene, r.difference);
    CHECK(r.difference <= ablation.tolerance);
    const auto work = [](const Cost& c) {
      return c.right_hand_sides + c.toi_queries + c.toi_evaluations + c.overlap_tests;
    };
    // Leaving an orientation out makes each right-hand side shorter, not fewer.
    CHECK((work(r.with) < work(r.without) || ablation.saving == "orientation left out"));
  }
}
