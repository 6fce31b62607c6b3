// Random valid scenes: no NaN, no overlap, no hang; and what a run must not depend on: where the
// origin is, which way the axes point, the units, the order of the file, and being interrupted.

#include "core/archive.hpp"
#include "core/compound_body.hpp"
#include "core/mesh_body.hpp"
#include "core/mesh_shapes.hpp"
#include "core/random.hpp"
#include "core/reading/scene_reader.hpp"
#include "experiments/parallel_for.hpp"
#include "experiments/random/plain_overlap.hpp"
#include "experiments/random/plain_parts.hpp"
#include "experiments/random/plain_room.hpp"
#include "experiments/random/scene_survey.hpp"
#include "experiments/random/scene_watch.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"
#include "tests/thoroughness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

using namespace kairos;
using namespace kairos::experiments;

namespace {

constexpr std::uint64_t seed = 20261121;

/// The end of a run; nothing where it stopped.
std::optional<RunResult> end_of(const RandomScene& scene, const std::string& integrator = "auto") {
  Recorder nobody;
  RunChoice choice;
  choice.method.integrator = integrator;
  RunResult result =
      simulate(Model(parse_scene(scene.toml(), scene.name + ".toml")), choice, nobody);
  return result.status == RunStatus::completed ? std::optional(std::move(result)) : std::nullopt;
}

double size_of(const RandomScene& scene) {
  double size = 0.0;
  for (const RandomBody& b : scene.bodies) {
    size = std::max(size, b.position.norm());
  }
  return size;
}

/// Moves a scene rigidly: p -> turn p + shift, and with `mirrored` first x -> -x.
RandomScene moved(RandomScene scene, const Quaternion& turn, const Vector3& shift, bool mirrored) {
  const Vector3 flip(mirrored ? -1.0 : 1.0, 1.0, 1.0);
  const auto vector = [&](const Vector3& v) { return Vector3(turn * v.cwiseProduct(flip)); };
  // Angular quantities are axial: a mirror turns them the other way round.
  const auto axial = [&](const Vector3& v) {
    return Vector3(turn * Vector3((mirrored ? -1.0 : 1.0) * v.cwiseProduct(flip)));
  };
  for (RandomBody& b : scene.bodies) {
    b.position = vector(b.position) + shift;
    b.velocity = vector(b.velocity);
    b.normal = vector(b.normal).normalized();
    b.swing = vector(b.swing);
    b.spin = axial(b.spin);
    const Vector3 turned = mirrored ? Vector3(-b.turned.cwiseProduct(flip)) : b.turned;
    const double angle = turned.norm();
    Quaternion q = turn;
    if (angle > 0.0) {
      q = turn * Quaternion(Eigen::AngleAxisd(angle, turned / angle));
    }
    const Eigen::AngleAxisd whole(q);
    b.turned =
        b.shape == "half-space" ? Vector3(Vector3::Zero()) : Vector3(whole.axis() * whole.angle());
  }
  return scene;
}

/// Roundoff in the start, multiplied at each impact: two round bodies of radius r that meet after a
/// flight of L scatter by 2L/r, here by less than 200.
double tolerance(const RandomScene& scene, std::int64_t impacts, double coordinates) {
  return 1e-14 * std::max(size_of(scene), coordinates) *
         std::pow(200.0, static_cast<double>(impacts + 1));
}

struct Compared {
  int scenes = 0;
  int with_impacts = 0;
};

/// Runs scenes with few impacts as they are and moved, and compares where things end.
template <typename Draw>
Compared compare_moved(int count, const Draw& draw, bool mirrored) {
  Compared compared;
  for (int k = 0; k < count; ++k) {
    Random random(seed, static_cast<std::uint64_t>(k));
    const RandomScene scene = random_scene(seed, static_cast<std::uint64_t>(k));
    const auto plain = end_of(scene);
    if (!plain || plain->cost.impacts > 3) {
      continue;
    }
    const auto [turn, shift] = draw(random, size_of(scene));
    const auto there = end_of(moved(scene, turn, shift, mirrored));
    CAPTURE(k, plain->cost.impacts, shift.norm());
    REQUIRE(there);
    CHECK(there->cost.impacts == plain->cost.impacts);
    const Vector3 flip(mirrored ? -1.0 : 1.0, 1.0, 1.0);
    double worst = 0.0;
    for (std::size_t i = 0; i < plain->state.size(); ++i) {
      const Vector3 expected = turn * plain->state[i].pose.position.cwiseProduct(flip) + shift;
      worst = std::max(worst, (there->state[i].pose.position - expected).norm());
    }
    CHECK(worst <= tolerance(scene, plain->cost.impacts, shift.norm()));
    ++compared.scenes;
    compared.with_impacts += plain->cost.impacts > 0 ? 1 : 0;
  }
  return compared;
}

void check_enough(const Compared& compared) {
  CAPTURE(compared.scenes, compared.with_impacts);
  CHECK(compared.scenes > 15);
  CHECK(compared.with_impacts > 8);
}

}  // namespace

// Not the fate `differs` either: neighbours from cells, and every pair asked.
TEST_CASE("random scenes of balls: no NaN, no overlap, no hang, one result", "[random][slow]") {
  constexpr std::size_t count = 200;
  std::vector<Trial> trials(count);
  parallel_for(count, 0,
               [&](std::size_t i) { trials[i] = try_by_two_searches(balls_scene(seed, i)); });
  std::int64_t impacts = 0;
  for (std::size_t i = 0; i < count; ++i) {
    INFO("kairos random-scenes --balls --seed "
         << seed << " --first " << i << " --count 1: " << to_string(trials[i].fate) << ": "
         << trials[i].reason);
    CHECK_FALSE(trials[i].failed());
    impacts += trials[i].impacts;
  }
  CHECK(impacts > 10'000);
}

TEST_CASE("scenes of balls that failed once", "[random]") {
  // The first crossed its cell without end where a curved motion of a ball was over; in the next
  // two balls lie on each other as images, which the judge took to be apart; in 432 a group that
  // was lifted was pushed 1e-12 m into an image. With every pair asked, a large ball among many
  // crossed on ever shorter ways (29833), and a ball was not told of a wall in touch with it
  // (58680, 92604); where 89529 stopped depended on how often balls crossed.
  using Case = std::pair<std::uint64_t, std::uint64_t>;
  std::vector<Case> failed{{15, 40473},       {15, 2788},        {15, 8949},       {20261124, 432},
                           {20261125, 29833}, {20261125, 58680}, {20261125, 92604}};
  if (tests::thorough()) {
    failed.emplace_back(20261125, 89529);  // 80 s
  }
  for (const auto& [from, index] : failed) {
    const Trial trial = try_by_two_searches(balls_scene(from, index));
    INFO(index << ": " << to_string(trial.fate) << ": " << trial.reason);
    CHECK_FALSE(trial.failed());
  }
}

TEST_CASE("a thousand random scenes: no NaN, no overlap, no hang, few stops", "[random][slow]") {
  constexpr std::size_t count = 1000;
  std::vector<Trial> trials(count);
  parallel_for(count, 0, [&](std::size_t i) { trials[i] = try_scene(random_scene(seed, i)); });
  int stops = 0;
  std::int64_t impacts = 0;
  for (std::size_t i = 0; i < count; ++i) {
    INFO("kairos random-scenes --seed " << seed << " --first " << i << " --count 1: "
                                        << to_string(trials[i].fate) << ": " << trials[i].reason);
    CHECK_FALSE(trials[i].failed());
    stops += trials[i].fate == Fate::stopped ? 1 : 0;
    impacts += trials[i].impacts;
  }
  CHECK(stops <= 50);
  CHECK(impacts > 4000);
}

TEST_CASE("scenes of all shapes: no NaN, no overlap, no hang, few stops", "[random][slow]") {
  constexpr std::size_t count = 400;
  std::vector<Trial> trials(count);
  parallel_for(count, 0, [&](std::size_t i) { trials[i] = try_scene(shapes_scene(seed, i)); });
  int stops = 0;
  std::int64_t impacts = 0;
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    INFO("kairos random-scenes --shapes --seed "
         << seed << " --first " << i << " --count 1: " << to_string(trials[i].fate) << ": "
         << trials[i].reason);
    CHECK_FALSE(trials[i].failed());
    stops += trials[i].fate == Fate::stopped ? 1 : 0;
    impacts += trials[i].impacts;
    text += shapes_scene(seed, i).toml();
  }
  CHECK(stops <= 40);
  CHECK(impacts > 1500);
  for (const char* shape : {"sphere", "box", "half-space", "capsule", "cylinder", "cone", "hull",
                            "compound", "mesh", "height-field"}) {
    CAPTURE(shape);
    CHECK(text.find(fmt::format("shape = \"{}\"", shape)) != std::string::npos);
  }
}

TEST_CASE("the judge of all shapes knows depths that are known", "[random]") {
  const Pose origin;
  const auto at = [](double x, double y, double z) {
    return Pose{{x, y, z}, Quaternion::Identity()};
  };
  const Shape cylinder = Cylinder{0.5, 2.0};
  const Shape cone = Cone{0.5, 1.0};  // its apex is 0.75 above the origin
  const Shape ring = Mesh{solid_body(torus_mesh(1.0, 0.25, 18, 12)).body};
  const Shape cube = Mesh{solid_body(box_mesh({1.0, 1.0, 1.0})).body};
  const Shape pair = Compound{
      compound_in_place({{Sphere{0.5}, at(-1.0, 0.0, 0.0)}, {Sphere{0.5}, at(1.0, 0.0, 0.0)}})};
  const Shape ball = Sphere{0.6};
  const Shape floor = HalfSpace{};
  struct Known {
    const Shape& a;
    const Shape& b;
    Pose at_b;
    double depth;
  };
  const double d = 1e-9;
  const Known inside[] = {{cylinder, cylinder, at(1.0 - d, 0.3, 0.0), d},
                          {cylinder, cylinder, at(0.2, 2.0 - d, 0.0), d},
                          {cone, cylinder, at(0.1, 1.75 - d, 0.0), d},
                          {pair, cylinder, at(0.1, 1.0, 0.0), 1e-2},
                          {cube, cylinder, at(0.0, 1.99, 0.0), 1e-2},
                          {cube, cone, at(0.0, 0.0, 0.0), 0.1}};  // without a touch
  for (const Known& known : inside) {
    const double depth = plain_parts_depth(known.a, origin, known.b, known.at_b);
    CAPTURE(known.at_b.position.transpose(), depth);
    CHECK(depth > 0.1 * known.depth);
  }
  const Known apart[] = {{cylinder, cylinder, at(1.0 + d, 0.3, 0.0), 0.0},
                         {cylinder, cylinder, at(0.2, 2.0 + d, 0.0), 0.0},
                         {cone, cylinder, at(0.1, 1.75 + d, 0.0), 0.0},
                         {pair, cylinder, at(0.0, 1.1, 0.0), 0.0},  // between the two
                         {cube, cylinder, at(0.0, 2.0 + d, 0.0), 0.0},
                         {ring, ball, at(0.0, 0.0, 0.0), 0.0}};  // in the hole
  for (const Known& known : apart) {
    CAPTURE(known.at_b.position.transpose());
    CHECK(plain_parts_depth(known.a, origin, known.b, known.at_b) == 0.0);
  }
  // Faces that are parallel but for roundoff: which point of a rim is the highest is noise there.
  for (std::uint64_t i = 0; i < 50; ++i) {
    Random random(seed, i << 32U);
    const Quaternion q = random.orientation();
    const Shape plate = Box{{1.0, 1.0, 1.0}};
    CAPTURE(i);
    CHECK(plain_parts_depth(cylinder, {Vector3::Zero(), q}, plate,
                            {q * Vector3(0.1, 2.0 + d, 0.0), q}) == 0.0);
  }
  CHECK(plain_depth(cone, at(0.0, 0.25 - d, 0.0), floor, origin) == Approx(d).epsilon(1e-6));
  // Boxes, whose depth the fifteen axes tell, by the other way.
  for (std::uint64_t i = 0; i < 200; ++i) {
    Random random(seed, i << 20U);
    const Shape a = Box{{1.0, 0.5, 0.25}};
    const Shape b = Box{{0.3, 0.6, 0.9}};
    const Vector3 away = random.uniform(0.5, 2.0) * random.direction();
    const Pose pose_b{away, random.orientation()};
    const double exact = plain_depth(a, origin, b, pose_b);
    const double least = plain_parts_depth(a, origin, b, pose_b);
    CAPTURE(i, exact, least);
    CHECK(least <= exact * (1.0 + 1e-12));
    CHECK(least >= exact / 8.0);  // powers of four, and sqrt(3) for the octahedron
  }
  // Edges 1e-7 off being parallel, 1e-11 m apart where faces are not: no overlap, which would be a
  // false alarm.
  const Shape post = Box{{0.1, 0.1, 0.5}};
  const Vector3 n = Vector3(1.0, 1.0, 0.0).normalized();
  const Vector3 corner(0.1, 0.1, 0.0);
  for (const double gap : {1e-11, -1e-11}) {
    const Quaternion q(Eigen::AngleAxisd(1e-7, n));
    const Pose pose{corner + gap * n + q * corner, q};
    CHECK(plain_depth(post, origin, post, pose) == Approx(std::max(-gap, 0.0)).epsilon(1e-4));
  }
}

namespace {

/// How many of the scenes run to their end; none breaks a promise, every stop says what to do.
int right_of(SceneKind kind, std::uint64_t count, std::uint64_t of_seed = seed) {
  const SceneSurvey survey{.seed = of_seed, .kind = kind};
  std::vector<Trial> trials(count);
  parallel_for(count, 0, [&](std::size_t i) { trials[i] = try_scene(scene_of(survey, i)); });
  int right = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Trial& trial = trials[i];
    INFO("kairos random-scenes --" << to_string(kind) << " --seed " << of_seed << " --first " << i
                                   << " --count 1: " << to_string(trial.fate) << ": "
                                   << trial.reason);
    CHECK_FALSE(trial.failed());
    if (trial.fate == Fate::stopped) {
      CHECK(trial.reason.find("allowed: ") != std::string::npos);
    }
    right += trial.fate == Fate::right ? 1 : 0;
  }
  return right;
}

}  // namespace

TEST_CASE("scenes that start in touch break no promise, and every stop says what to do",
          "[random]") {
  // Elastic ones, rows, and what comes to rest.
  const int count = tests::thorough() ? 300 : 120;
  CHECK(right_of(SceneKind::touching, static_cast<std::uint64_t>(count)) > count * 4 / 5);
}

TEST_CASE("scenes with friction break no promise, and every stop says what to do",
          "[random][slow]") {
  // A seed of its own: a pile among the hundred of the other takes two minutes.
  CHECK(right_of(SceneKind::rough, 100, 20261128) > 90);
}

TEST_CASE("scenes with friction that stopped once", "[random]") {
  // Light balls between heavy ones and boxes, whose collapses light bodies hand on and on; boxes
  // that rattle in touch; a stop of a slide that leaves 2e-23 m/s; light boxes that rattle under
  // heavy ones on a floor that returns all of their speed; edges that cross at a face which is
  // hardly tilted; balls struck by the roundoff of their speeds; corners that part where no
  // detector can tell; light boxes that rattle on all of their corners between such a floor and
  // what does not bounce as well; a ball that closes in on a plane at 2e-321 m/s. One broke a
  // promise: an impact of all touches at once turned a slip, and friction was said to give 3.7 J.
  // Rows of balls without gravity that hand an impact on until it is 5e-324 m/s. The last ones:
  // balls that are settled in vain at one instant, or struck by roundoff while others hold them;
  // aligned boxes; a rough ball that has to stop its slip in a step of 1e-12 s; rough touches that
  // no impulses keep all of, and such that would take very large ones; three touches that friction
  // jams beside one that slides 1e6 times faster; balls that part where time stood still; a ball of
  // 52 kg that struck a box of 3 g on a floor 10,000 times at one instant.
  for (const auto& [of_seed, index] :
       {std::pair(20261201, 13), {20261209, 160},  {20261208, 30},   {20261211, 45},
        {20261204, 86},          {20261204, 149},  {20261202, 220},  {20261202, 173},
        {20261204, 260},         {20261202, 90},   {20261202, 206},  {20261202, 343},
        {20261201, 262},         {20261128, 26},   {20261130, 432},  {20261201, 518},
        {20261201, 1073},        {20261401, 6544}, {20261401, 8308}, {20261401, 6397},
        {20261401, 9097},        {20261401, 983},  {20261401, 460},  {20261401, 15787},
        {20261701, 297},         {20261801, 308},  {20261901, 381}}) {
    const SceneSurvey survey{.seed = static_cast<std::uint64_t>(of_seed), .kind = SceneKind::rough};
    const Trial trial = try_scene(scene_of(survey, static_cast<std::size_t>(index)));
    CAPTURE(of_seed, index, trial.reason);
    CHECK(trial.fate == Fate::right);
  }
}

TEST_CASE("bodies on joints break no promise, and every stop says what to do", "[random]") {
  // What rests on a driven body, or hangs on one, stops.
  CHECK(right_of(SceneKind::jointed, 150) > 140);
}

TEST_CASE("bodies on joints and friction that stopped or broke a promise once", "[random]") {
  // Rough balls that hang side by side: joints and friction lock them, which sliding does not find;
  // what moves by roundoff across; rods that lean 1e-6; a light ball between a corner and what two
  // welded boxes make; one that strikes all around 10,000 times at one instant; 2 g that a rod with
  // 69 kg at its end presses to a wall, and no longer. The last five: impacts whose roundoff was
  // 1e-13 of the energy and more, through a rod between 18 g and 75 kg, along what rods all but
  // block, and on 1 g that a weld holds to 1 kg.
  for (const auto& [seed, number] : {std::pair(20262101, 45),
                                     {20262101, 141},
                                     {20262101, 203},
                                     {20262101, 1286},
                                     {20262101, 1594},
                                     {20262101, 589},
                                     {20262101, 1348},
                                     {20262101, 535},
                                     {20262111, 3359},
                                     {20262111, 699},
                                     {20262101, 780},
                                     {20262301, 5825},
                                     {20262302, 5988},
                                     {20262302, 7039},
                                     {20262302, 4057}}) {
    const SceneSurvey survey{.seed = static_cast<std::uint64_t>(seed), .kind = SceneKind::jointed};
    const Trial trial = try_scene(scene_of(survey, static_cast<std::size_t>(number)));
    CAPTURE(seed, number, trial.reason);
    CHECK(trial.fate == Fate::right);
  }
}

TEST_CASE("bodies on joints: what endless impacts still have is lost by completing them",
          "[random]") {
  // A bounce that slides as it ends; it was booked as what steps of joints lose. Left for those is
  // what their tolerance lets them lose.
  const auto end = end_of(jointed_scene(20262101, 1961));
  REQUIRE(end);
  const double completed = end->ledger.line(EnergyLine::zeno_completion);
  CHECK(completed < -1.0);
  CHECK(std::abs(end->ledger.line(EnergyLine::projection)) < 1e-9 * std::abs(completed));
}

TEST_CASE("bodies on joints: scenes that stopped where contact lasts", "[random]") {
  // Came to rest on a wall, on a box, on each other; the fourth is a cradle whose balls, little
  // elastic, handed an impact to and fro between them.
  for (const auto& [of_seed, index] :
       {std::pair(3107, 33), {3107, 53}, {3107, 209}, {31, 128}, {4711, 121}}) {
    RandomScene scene =
        jointed_scene(static_cast<std::uint64_t>(of_seed), static_cast<std::uint64_t>(index));
    for (const RandomJoint& joint : scene.joints) {
      for (RandomBody& b : scene.bodies) {  // they did so without friction
        const bool hangs =
            std::find(joint.bodies.begin(), joint.bodies.end(), b.name) != joint.bodies.end();
        b.friction = hangs && b.moves() ? 0.0 : b.friction;
      }
    }
    const Trial trial = try_scene(scene);
    CAPTURE(of_seed, index, trial.reason);
    CHECK(trial.fate == Fate::right);
  }
}

TEST_CASE("random scenes of bodies in touch that stopped once", "[random]") {
  // A box pushed from its rim by a ball, boxes that tilt over each other's rims, a collapse that
  // takes no time, two pairs of a body that stall at one instant.
  for (const std::uint64_t index : {54U, 84U, 155U, 174U, 201U}) {
    const Trial trial = try_scene(touching_scene(772, index));
    CAPTURE(index, trial.reason);
    CHECK(trial.fate == Fate::right);
  }
  // Blocks that meet at a corner only and part as far as first rates tell; a ball in a groove with
  // another on it; an approach that is roundoff of a spin.
  for (const std::uint64_t index : {510U, 854U, 280U, 629U, 794U, 121U}) {
    const Trial trial = try_scene(touching_scene(20261128, index));
    CAPTURE(index, trial.reason);
    CHECK(trial.fate == Fate::right);
  }
  // A wall of boxes that gives way: gaps that are to be held make room in all directions.
  const Trial wall = try_scene(touching_scene(20261126, 662));
  CAPTURE(wall.reason);
  CHECK(wall.fate == Fate::right);
  // Wedges, and light bodies between heavy ones: contact forces that sweeps touch by touch do not
  // settle.
  for (const std::uint64_t index : {63U, 71U, 105U}) {
    const Trial trial = try_scene(rough_scene(20261127, index));
    CAPTURE(index, trial.reason);
    CHECK(trial.fate == Fate::right);
  }
  // A rough corner that would pull if it stuck and approaches if it opens; it stopped after 0.62 s.
  RandomScene rough = rough_scene(20261202, 210);
  rough.duration = 0.64;
  const Trial held = try_scene(rough);
  CAPTURE(held.reason);
  CHECK(held.fate == Fate::right);
}

TEST_CASE("a random scene is written as it is run", "[random]") {
  const auto written = tests::kairos_program(
      {"random-scenes", "--touching", "--seed", "772", "--first", "54", "--count", "1", "--print"});
  CHECK(written.exit_code == 0);
  CHECK(written.out == touching_scene(772, 54).toml());
}

TEST_CASE("the judge of room between walls that close in", "[random]") {
  // A wall at 1 m that swings by 0.5 m, 1 + 0.5 sin(2 pi t), over a floor: it is lowest, 0.5 m, at
  // 0.75 s.
  RandomScene scene;
  RandomBody floor;
  floor.entity = "wall";
  floor.shape = "half-space";
  RandomBody lid = floor;
  lid.normal = -Vector3::UnitY();
  lid.position = {0.0, 1.0, 0.0};
  lid.swing = {0.0, 0.5, 0.0};
  lid.frequency = 1.0;
  RandomBody ball;
  ball.entity = "ball";
  ball.shape = "sphere";
  ball.radius = 0.2501;
  scene.bodies = {floor, lid, ball};
  CHECK(leaves_no_room(scene, 0.7, 0.8));
  CHECK_FALSE(leaves_no_room(scene, 0.0, 0.7));
  scene.bodies[2].radius = 0.2499;
  CHECK_FALSE(leaves_no_room(scene, 0.0, 2.0));
  // A box lies down where it cannot stand.
  scene.bodies[2].entity = "body";
  scene.bodies[2].shape = "box";
  scene.bodies[2].half_extents = {0.2499, 1.0, 1.0};
  CHECK_FALSE(leaves_no_room(scene, 0.0, 2.0));
  scene.bodies[2].half_extents = {0.2501, 1.0, 1.0};
  CHECK(leaves_no_room(scene, 0.0, 2.0));
  // Walls that do not face each other leave room beside them; one that rests closes nothing in.
  scene.bodies[1].normal = Vector3(0.1, -1.0, 0.0).normalized();
  CHECK_FALSE(leaves_no_room(scene, 0.0, 2.0));
  scene.bodies[1] = lid;
  scene.bodies[1].swing.setZero();
  scene.bodies[1].position.y() = 0.4;
  CHECK_FALSE(leaves_no_room(scene, 0.0, 2.0));
}

TEST_CASE("the judge tells a joint that is open, and friction that drives", "[random]") {
  const auto fate_of = [](SceneWatch& watch, const State& states, const EnergyLedger& ledger) {
    try {
      watch.frame({0, Instant{}, states, ledger});
      return Fate::right;
    } catch (const BrokenPromise& broken) {
      return broken.fate;
    }
  };
  std::set<JointKind> kinds;
  for (std::uint64_t k = 0; k < 60; ++k) {
    const RandomScene scene = jointed_scene(seed, k);
    const Model model(parse_scene(scene.toml(), "jointed.toml"));
    const Joint& joint = model.scene().joints.at(0);
    State states = model.initial_state();
    EnergyLedger ledger;
    double energy = 0.0;
    const auto loses = [&](EnergyLine line, double joules) {
      ledger.add(line, joules);
      ledger.balance(energy += joules, 0.0);
    };
    ledger.open(0.0, 0.0);
    SceneWatch watch;
    watch.begin(model);
    CAPTURE(k, to_string(joint.kind));
    REQUIRE(fate_of(watch, states, ledger) == Fate::right);
    loses(EnergyLine::friction, -1.0);
    CHECK(fate_of(watch, states, ledger) == Fate::right);
    loses(EnergyLine::friction, 1e-9);
    CHECK(fate_of(watch, states, ledger) == Fate::friction);

    // Along no direction that the joint could leave free.
    const BodyIndex on = joint.a.body ? *joint.a.body : *joint.b.body;
    states[on].pose.position += 1e-7 * Vector3(0.36, 0.48, 0.8);
    SceneWatch fresh;
    fresh.begin(model);
    CHECK(fate_of(fresh, states, ledger) == Fate::joint);
    kinds.insert(joint.kind);
  }
  CHECK(kinds.size() == 5);
}

TEST_CASE("a scene that fails is shrunk to a small one that fails in the same way", "[random]") {
  // A stop stands for a failure: event-driven has none to offer.
  std::uint64_t index = 0;
  while (try_scene(random_scene(seed, index)).fate != Fate::stopped) {
    ++index;
  }
  const RandomScene scene = random_scene(seed, index);
  const RandomScene small = shrink(scene, Fate::stopped);
  CAPTURE(index, small.toml());
  CHECK(try_scene(small).fate == Fate::stopped);
  CHECK(small.bodies.size() <= 6);
  CHECK(small.bodies.size() < scene.bodies.size());
  CHECK(small.duration <= scene.duration);
  // What is written is what was run.
  CHECK(random_scene(seed, index).toml() == scene.toml());
}

TEST_CASE("random scenes that once broke a promise", "[random]") {
  struct Case {
    std::uint64_t seed, index;
    Fate fate;
    const char* what;
  };
  const Case cases[] = {
      {seed, 1450, Fate::stopped, "30,000 impacts in a closing gap left energy unexplained"},
      {1999, 3693, Fate::right, "potentials that cancel left their rounding"},
      {1999, 64849, Fate::right, "potentials that cancel left their rounding"},
      {1999, 4471, Fate::right, "a ball sank through a box that lay on the floor"},
      {1999, 60224, Fate::right, "a ball sank through a ball that lay on the floor"},
      {1999, 71544, Fate::right, "asked the same question for ever; hops on a ball on the floor"},
      {1999, 84136, Fate::right, "a ball sank through a ball that lay on the floor"},
      {1999, 87189, Fate::right, "a ball sank through a box; now one rests on it with e = 1"},
      {1999, 91884, Fate::right, "a ball sank through a ball that lay on the floor"},
      {4242, 15588, Fate::right, "what an impact turned into spin was no flow"},
      {1999, 70032, Fate::right, "a ball left a box at its edge and was on it, for ever"},
      {1999, 130453, Fate::right, "a ball left a box at its edge and was on it, for ever"},
  };
  for (const Case& c : cases) {
    const Trial trial = try_scene(random_scene(c.seed, c.index));
    CAPTURE(c.seed, c.index, c.what, trial.reason);
    CHECK(trial.fate == c.fate);
  }
}

TEST_CASE("random scenes of bodies in touch that once broke a promise", "[random]") {
  struct Case {
    std::uint64_t index;
    Fate fate;
    const char* what;
  };
  const Case cases[] = {
      {16443, Fate::right, "a ball in contact hovered beside the other"},
      {46413, Fate::right, "a part of a slow way along an incline was taken for roundoff"},
      {81822, Fate::right, "a part of a slow way along an incline was taken for roundoff"},
      {12184, Fate::right, "rounding of what others handed on was taken for a broken law"},
  };
  for (const Case& c : cases) {
    const Trial trial = try_scene(touching_scene(21, c.index));
    CAPTURE(c.index, c.what, trial.reason);
    CHECK(trial.fate == c.fate);
  }
}

TEST_CASE("scenes of touching bodies that were judged by too little rounding", "[random]") {
  // #8947: depth of a gap that is a sum of coordinates, not of lengths. The others: bodies that
  // rest on two, nanometres apart and so tilted, are struck flat; no velocity suits all points.
  for (const std::uint64_t index : {8947, 20656, 21960, 23819}) {
    const Trial trial = try_scene(touching_scene(20261128, index));
    CAPTURE(index, to_string(trial.fate), trial.reason);
    CHECK_FALSE(trial.failed());
  }
}

TEST_CASE("what is held where edges cross ends where they part", "[random]") {
  // A block that tips over another's edge was held by it for a millisecond longer, 1.4 mm apart:
  // the crossing of two edges has no rim, and the step was as long as a frame.
  for (const std::uint64_t index : {7128, 11741}) {
    const Trial trial = try_scene(touching_scene(20261201, index));
    CAPTURE(index, to_string(trial.fate), trial.reason);
    CHECK_FALSE(trial.failed());
  }
}

TEST_CASE("what begins to last is put straight, and out of roundoff", "[random]") {
  // #60176: a face came to rest by hops, tilted by 1e-9 rad, and slid over an edge: 1e-11 m inside.
  // #55300: balls that fly in touch between impacts sank by a roundoff each time, 3e-15 m.
  // 20261127 #9709: a ball went on along the face of a box as it had been before that was put
  // straight, at 1e-10 m/s into it: 2e-12 m inside.
  // 20261127 #81413: a ball comes back along a plane from 3 m away, where its height was rounded.
  for (const auto& [seed, index] :
       {std::pair{20261126, 60176}, {20261126, 55300}, {20261127, 9709}, {20261127, 81413}}) {
    const Trial trial = try_scene(
        touching_scene(static_cast<std::uint64_t>(seed), static_cast<std::uint64_t>(index)));
    CAPTURE(seed, index, to_string(trial.fate), trial.reason);
    CHECK_FALSE(trial.failed());
  }
}

TEST_CASE("two bodies that turn in touch: scenes that once broke a promise", "[random]") {
  // Balls sank into boxes whose motion had ended, boxes into boxes whose faces were 1e-7 rad off
  // the normal between them, and what contact forces leaked was booked for a body that they had
  // left.
  for (const std::uint64_t index :
       {37, 840, 848, 1401, 2121, 2161, 2249, 2284, 3920, 4386, 4514, 4708, 5039, 5250, 5521}) {
    const Trial trial = try_scene(touching_scene(41, index));
    CAPTURE(index, to_string(trial.fate), trial.reason);
    CHECK_FALSE(trial.failed());
  }
}

TEST_CASE("a step that a strike would end ends, too, where the strike never comes", "[random]") {
  // Another body struck one of the two before. What the other was held by went on along a motion
  // that had ended: into a box, and with 1e14 J.
  for (const std::uint64_t index : {1047, 1569}) {
    const Trial trial = try_scene(touching_scene(31, index));
    CAPTURE(index, to_string(trial.fate), trial.reason);
    CHECK_FALSE(trial.failed());
  }
}

TEST_CASE("a survey that was killed goes on, and one that wants more scenes", "[random][sweep]") {
  const tests::TemporaryFolder folder;
  const std::string journal = folder.path("blocks");
  const auto survey = [&](std::uint64_t count, const std::string& file) {
    std::uint64_t at_first = count;
    Tally tally = run_survey({.count = count, .seed = seed}, file, [&](const Tally& so_far) {
      at_first = std::min(at_first, so_far.scenes);
    });
    tally.seconds = 0.0;
    return std::pair(survey_summary({.count = count, .seed = seed}, tally), at_first);
  };
  const std::string whole = survey(450, "").first;
  CHECK(survey(450, journal).first == whole);
  const std::string full = tests::read_all(journal);

  Random random(seed);
  for (int kill = 0; kill < 4; ++kill) {  // a death leaves any part of the file
    const auto size = static_cast<std::size_t>(random.below(full.size()));
    std::filesystem::resize_file(folder.file("blocks", full), size);
    CAPTURE(size, full.size());
    CHECK(survey(450, journal).first == whole);
    CHECK(tests::read_all(journal).size() == full.size());
  }
  const auto [more, kept] = survey(650, journal);
  CHECK(kept == 400);  // the block of 50 was no whole one
  CHECK(more == survey(650, "").first);
}

TEST_CASE("a run does not depend on where the origin is", "[random][invariance]") {
  check_enough(compare_moved(
      60,
      [](Random& random, double size) {
        return std::pair(Quaternion::Identity(), Vector3(random.direction() * 8.0 * size));
      },
      false));
}

TEST_CASE("a run does not depend on which way the axes point", "[random][invariance]") {
  check_enough(compare_moved(
      60,
      [](Random& random, double /*size*/) {
        const double angle = random.uniform(0.0, 6.28);  // about the vertical: gravity stays
        return std::pair(Quaternion(Eigen::AngleAxisd(angle, Vector3::UnitY())),
                         Vector3(Vector3::Zero()));
      },
      false));
}

TEST_CASE("a run in a mirror is the mirrored run", "[random][invariance]") {
  check_enough(compare_moved(
      60,
      [](Random& /*random*/, double /*size*/) {
        return std::pair(Quaternion::Identity(), Vector3(Vector3::Zero()));
      },
      true));
}

TEST_CASE("a run in other units is the same, bit for bit", "[random][invariance]") {
  // Powers of two, which round nothing. No number of the library is a length, a time or a mass but
  // the absolute tolerance of controlled integrators.
  INFO("seed " << seed);
  RunChoice choice;
  choice.stepper.absolute_tolerance = 0.0;
  for (const auto& [length, time, mass] :
       {std::tuple{2.0, 1.0, 1.0}, std::tuple{1.0, 0.5, 1.0}, std::tuple{1.0, 1.0, 2.0},
        std::tuple{16.0, 0.125, 0x1p10}}) {
    for (std::uint64_t k = 0; k < 60; ++k) {
      const RandomScene scene = random_scene(seed, k);
      RandomScene other = scene;
      other.duration *= time;
      other.frame *= time;
      other.G *= length / (time * time);
      for (RandomBody& b : other.bodies) {
        b.radius *= length;
        b.half_extents *= length;
        b.mass *= mass;
        b.position *= length;
        b.velocity *= length / time;
        b.spin /= time;
        b.swing *= length;
        b.frequency /= time;
      }
      Recorder nobody;
      const auto run = [&](const RandomScene& s) {
        return simulate(Model(parse_scene(s.toml(), s.name + ".toml")), choice, nobody);
      };
      const RunResult plain = run(scene), scaled = run(other);
      CAPTURE(k, length, time, mass, plain.reason);
      CHECK(scaled.reason == plain.reason);
      CHECK(scaled.end.seconds == time * plain.end.seconds);
      CHECK(scaled.cost.impacts == plain.cost.impacts);
      for (std::size_t i = 0; i < plain.state.size(); ++i) {
        CHECK(scaled.state[i].pose.position == length * plain.state[i].pose.position);
        CHECK(scaled.state[i].twist.linear == length / time * plain.state[i].twist.linear);
        CHECK(scaled.state[i].pose.orientation.coeffs() ==
              plain.state[i].pose.orientation.coeffs());
      }
      const double joule = mass * length * length / (time * time);
      CHECK(scaled.ledger.energy() == joule * plain.ledger.energy());
    }
  }
}

TEST_CASE("a run does not depend on the order of the file", "[random][invariance]") {
  for (std::uint64_t k = 0; k < 60; ++k) {
    const RandomScene scene = random_scene(seed, k);
    RandomScene other = scene;
    std::reverse(other.bodies.begin(), other.bodies.end());
    const auto plain = end_of(scene);
    const auto reversed = end_of(other);
    CAPTURE(k);
    REQUIRE(plain.has_value() == reversed.has_value());
    for (std::size_t i = 0; plain && i < plain->state.size(); ++i) {
      const std::size_t j = plain->state.size() - 1 - i;
      CHECK(reversed->state[j].pose.position == plain->state[i].pose.position);
      CHECK(reversed->state[j].twist.linear == plain->state[i].twist.linear);
    }
  }
}

TEST_CASE("shipped scenes do not depend on the order of their bodies, energy included",
          "[invariance]") {
  class Books : public Recorder {
   public:
    void frame(const Frame& frame) override {
      Archive archive;
      EnergyLedger ledger = frame.ledger;
      archive(ledger);
      bytes += archive.bytes();
    }
    std::string bytes;
  };
  for (const std::string& name : shipped_scenes()) {
    if (name.ends_with(".def")) {
      continue;  // the thesis' format: its story is that of `original`
    }
    const Scene scene = read_scene(find_scene(name));
    Scene other = scene;
    const BodyIndex last = scene.bodies.size() - 1;
    std::reverse(other.bodies.begin(), other.bodies.end());
    for (SceneForce& force : other.forces) {
      for (BodyIndex& i : force.bodies) {
        i = last - i;
      }
    }
    for (Joint& joint : other.joints) {
      for (JointSide* const side : {&joint.a, &joint.b}) {
        if (side->body) {
          side->body = last - *side->body;
        }
      }
    }
    Books plain, reversed;
    const RunChoice choice{.duration = std::min(scene.duration, 2.0)};
    if (!why_refused(Model(scene), choice).empty()) {
      continue;
    }
    const RunResult result = simulate(Model(scene), choice, plain);
    const RunResult again = simulate(Model(other), choice, reversed);
    CAPTURE(name);
    CHECK(again.reason == result.reason);
    CHECK(reversed.bytes == plain.bytes);
    for (BodyIndex i = 0; i <= last; ++i) {
      CHECK(again.state[last - i].pose.position == result.state[i].pose.position);
      CHECK(again.state[last - i].twist.linear == result.state[i].twist.linear);
    }
  }
}
