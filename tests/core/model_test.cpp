#include "core/model.hpp"

#include "core/error.hpp"
#include "core/island_force.hpp"
#include "core/reading/scene_reader.hpp"
#include "tests/catch.hpp"
#include "tests/locations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace kairos;

namespace {

const std::string scenes = tests::source_path("scenes/");

bool decided(const Model& model, const std::string& topic, const std::string& part) {
  const auto& all = model.decisions();
  return std::any_of(all.begin(), all.end(), [&](const Decision& d) {
    return d.topic == topic && d.text.find(part) != std::string::npos && !d.reason.empty();
  });
}

std::vector<BodyPair> listed(const BodyPairs& pairs) { return {pairs.begin(), pairs.end()}; }

/// Pulls the second body to the first; says what it was shown.
class Spring : public Force {
 public:
  void add(Instant, std::span<const BodyState> bodies, std::span<Wrench> wrenches) const override {
    const Vector3 pull = bodies[1].pose.position - bodies[0].pose.position;
    wrenches[0].force += pull;
    wrenches[1].force -= pull;
  }
  [[nodiscard]] double potential(Instant, std::span<const BodyState> bodies) const override {
    return 0.5 * (bodies[1].pose.position - bodies[0].pose.position).squaredNorm();
  }
  [[nodiscard]] bool conservative() const override { return true; }
  [[nodiscard]] std::string description() const override { return "spring"; }
};

Scene tumbling() { return read_scene(scenes + "spinning-box.toml"); }

}  // namespace

TEST_CASE("model: a ball over a floor has no orientation, no solver, one pair", "[model]") {
  const Model model(read_scene(scenes + "bounce.toml"));
  CHECK_FALSE(model.rotates(1));
  CHECK(model.mobility(0) == Mobility::fixed);
  CHECK(listed(model.pairs()) == std::vector<BodyPair>{{0, 1}});
  REQUIRE(model.islands().size() == 1);
  CHECK(model.closed_form(0));
  CHECK(model.gravity_force(1) == Vector3(0, -9.8, 0));
  CHECK(model.gravity_force(0) == Vector3::Zero());
  CHECK(decided(model, "rotation", "\"ball\""));
  CHECK(decided(model, "motion", "closed form"));
  CHECK(decided(model, "bodies", "\"floor\""));
  BodyState state = model.initial_state()[1];
  state.twist = {{0, 3, 4}, {100, 0, 0}};
  CHECK(model.kinetic_energy(1, state) == 12.5);
  CHECK(model.kinetic_energy(0, state) == 0.0);
  CHECK(model.gravity_potential(1, {0, 2, 0}) == 19.6);
}

TEST_CASE("model: every saving can be switched off", "[model]") {
  const Scene scene = read_scene(scenes + "billiard.toml");
  const Model lean(scene);
  ModelOptions off;
  off.leave_out_orientation = false;
  off.closed_form = false;
  off.prune_pairs = false;
  const Model full(scene, off);
  CHECK(lean.pairs().size() == 216);
  CHECK(full.pairs().size() == 231);
  CHECK_FALSE(lean.rotates(6));
  CHECK(full.rotates(6));
  CHECK(lean.closed_form(0));
  CHECK_FALSE(full.closed_form(0));
  // What can do something to each other is physics, not a saving.
  for (BodyIndex a = 0; a < lean.size(); ++a) {
    for (BodyIndex b = 0; b < lean.size(); ++b) {
      CHECK(lean.interacts(a, b) == full.interacts(a, b));
    }
  }
  CHECK(decided(full, "motion", "integrated"));
}

TEST_CASE("model: what can tumble is a free top, what cannot turns at a constant rate", "[model]") {
  CHECK_FALSE(Model(tumbling()).closed_form(0));
  CHECK(Model(tumbling()).tumbles(0));
  ModelOptions off;
  off.closed_form = false;
  CHECK_FALSE(Model(tumbling(), off).tumbles(0));
  CHECK(Model(tumbling()).rotates(1));
  // A cube has no axis to prefer: its rate of turning is constant between impacts.
  Scene cube =
      read_scene(scenes + "spinning-box.toml", {{"body.box.half_extents", "[0.1, 0.1, 0.1]"}});
  CHECK(Model(cube).closed_form(0));
  CHECK_FALSE(Model(cube).tumbles(0));
  // Alone, a box that spins about a principal axis keeps it; about another it does not.
  Scene alone = tumbling();
  alone.bodies.erase(alone.bodies.begin());
  alone.bodies[0].initial.pose.orientation = Quaternion::Identity();
  alone.bodies[0].initial.twist.angular = {0, 0, 5};
  CHECK(Model(alone).closed_form(0));
  alone.bodies[0].initial.twist.angular = {0, 1, 5};
  CHECK_FALSE(Model(alone).closed_form(0));
  // A sphere, whatever its spin, and a ball that collides as its box.
  Scene sphere = alone;
  sphere.bodies[0].shape = Sphere{0.1};
  CHECK_FALSE(Model(sphere).rotates(0));
  sphere.bodies[0].bounds = Bounds::obb;
  CHECK(Model(sphere).rotates(0));
}

TEST_CASE("model: fields act on free bodies only, fixed and driven bodies ignore each other",
          "[model]") {
  const std::string text = R"(
[[body]]
name = "pad"
entity = "anti-gravity-pad"
half_extents = [1, 1, 1]
[[body]]
name = "wall"
entity = "wall"
half_extents = [1, 1, 1]
[[body]]
name = "bat"
entity = "bat"
half_extents = [1, 1, 1]
mass = 1
drive = {frequency = 1, amplitude = [1, 0, 0]}
[[body]]
name = "ball"
entity = "ball"
radius = 1
mass = 1
position = [9, 9, 9]
[[body]]
name = "table"
entity = "wall"
shape = "half-space"
position = [0, -9, 0]
drive = {frequency = 1, amplitude = [0, 1, 0], phase = 1.5707963267948966}
)";
  const Model model(parse_scene(text, ""));
  CHECK(listed(model.pairs()) == std::vector<BodyPair>{{0, 3}, {1, 3}, {2, 3}, {3, 4}});
  CHECK(model.mobility(2) == Mobility::driven);
  CHECK(model.mobility(4) == Mobility::driven);
  CHECK(decided(model, "bodies", "follows its drive"));
  // Driven bodies start where their drive puts them: at -9 + sin(pi/2).
  CHECK(model.initial_state()[4].pose.position.y() == Approx(-8.0).epsilon(1e-15));
}

TEST_CASE("model: gravity as the thesis' force does not know the mass", "[model]") {
  const std::vector<Override> heavy = {{"body.ball.mass", "4"}};
  std::vector<Override> force = heavy;
  force.push_back({"gravity", "force"});
  CHECK(Model(read_scene(scenes + "bounce.toml", heavy)).gravity_force(1).y() == -39.2);
  CHECK(Model(read_scene(scenes + "bounce.toml", force)).gravity_force(1).y() == -9.8);
}

TEST_CASE("model: forces couple bodies into islands and see them in their own order", "[model]") {
  Scene scene = read_scene(scenes + "cradle.toml");
  scene.forces = {{std::make_shared<const Spring>(), {3, 1}},
                  {std::make_shared<const Spring>(), {0, 2}}};
  const Model model(scene);
  REQUIRE(model.islands().size() == 3);
  const Island& coupled = model.islands()[model.island_of(1)];
  CHECK(coupled.bodies == std::vector<BodyIndex>{3, 1});
  CHECK(model.island_of(3) == model.island_of(1));
  CHECK_FALSE(model.closed_form(model.island_of(1)));
  CHECK(model.closed_form(model.island_of(4)));
  CHECK(decided(model, "islands", "2 bodies"));

  std::vector<BodyState> states(2);
  states[0].pose.position = {1, 0, 0};  // body 1, the spring's second
  states[1].pose.position = {4, 0, 0};  // body 3, its first
  std::vector<Wrench> wrenches(2);
  coupled.wrenches(Instant{}, states, wrenches);
  CHECK(wrenches[0].force == Vector3(3, 0, 0));
  CHECK(wrenches[1].force == Vector3(-3, 0, 0));
  CHECK(coupled.forces[0]->potential(Instant{}, states) == 4.5);

  // A copy of the model keeps its forces alive.
  const auto copy = std::make_unique<Model>(model);
  CHECK(copy->islands()[copy->island_of(1)].forces[0]->description() == "spring");
}

TEST_CASE("model: scenes made in code are checked too", "[model]") {
  const auto refused = [](auto&& change, const std::string& key) {
    Scene scene = tumbling();
    change(scene);
    try {
      const Model model(scene);
      FAIL("was not refused: " << key);
    } catch (const InputError& error) {
      CHECK(error.key() == key);
    }
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused([](Scene& s) { s.bodies.clear(); }, "body");
  refused([](Scene& s) { s.duration = 0.0; }, "duration");
  refused([nan](Scene& s) { s.duration = nan; }, "duration");
  refused([](Scene& s) { s.frames = FixedFrames{0.0}; }, "frame");
  refused([](Scene& s) { s.frames = ListedFrames{}; }, "frame");
  refused([](Scene& s) { s.frames = ListedFrames{{0.1, -0.01}, ""}; }, "frame");
  refused([](Scene& s) { s.bodies[1].name = s.bodies[0].name; }, "body.plate.name");
  refused([](Scene& s) { s.bodies[1].entity = nullptr; }, "body.box.entity");
  refused([](Scene& s) { s.bodies[1].mass = -1.0; }, "body.box.mass");
  refused([](Scene& s) { s.bodies[1].inertia.setZero(); }, "body.box.inertia");
  refused([nan](Scene& s) { s.bodies[1].initial.pose.position.x() = nan; }, "body.box.position");
  refused([nan](Scene& s) { s.bodies[1].initial.twist.linear.x() = nan; }, "body.box.velocity");
  refused([](Scene& s) { s.bodies[1].initial.pose.orientation.coeffs() *= 1.1; },
          "body.box.orientation");
  refused([](Scene& s) { s.bodies[1].shape = Sphere{0.0}; }, "body.box.radius");
  refused([](Scene& s) { s.bodies[1].shape = Box{}; }, "body.box.half_extents");
  refused([](Scene& s) { s.bodies[1].shape = HalfSpace{}; }, "body.box.shape");
  refused([](Scene& s) { s.bodies[1].restitution = 2.0; }, "body.box.restitution");
  refused([](Scene& s) { s.forces = {{std::make_shared<const Spring>(), {0, 1}}}; }, "force");
}

TEST_CASE("model: forces of a scene couple, turn and join what they must", "[model]") {
  const std::string bodies = R"(
[[body]]
name = "floor"
entity = "wall"
shape = "half-space"
position = [0, -9, 0]
[[body]]
name = "a"
entity = "ball"
radius = 0.1
mass = 2
[[body]]
name = "b"
entity = "body"
radius = 0.1
mass = 3
position = [1, 0, 0]
[[body]]
name = "c"
entity = "ball"
radius = 0.1
mass = 4
position = [2, 0, 0]
)";
  const std::string spring = "[[force]]\nkind = \"spring\"\nstiffness = 1\n";
  {
    const Model model(parse_scene(bodies + spring + "bodies = [\"a\", \"c\"]", ""));
    CHECK(model.islands().size() == 2);  // a and c, b
    CHECK(model.island_of(1) == model.island_of(3));
    CHECK(model.islands()[model.island_of(1)].forces.size() == 1);
    CHECK_FALSE(model.closed_form(model.island_of(1)));
    CHECK(model.closed_form(model.island_of(2)));
    CHECK(decided(model, "forces", "spring: \"a and c\""));
    CHECK(decided(model, "islands", "2 bodies"));
    CHECK(decided(model, "motion", "integrated: \"a\", \"c\""));
  }
  {  // A fixed body is an anchor: it couples nothing, and where it is counts.
    const Model model(
        parse_scene(bodies + spring + "bodies = [\"a\", \"floor\"]\npoint_b = [0, 1, 0]", ""));
    CHECK(model.islands().size() == 3);
    std::vector<Wrench> wrenches(1);
    const Island& island = model.islands()[model.island_of(1)];
    island.wrenches(Instant{}, std::vector<BodyState>{model.body(1).initial}, wrenches);
    CHECK(wrenches[0].force == Vector3(0, -2 * 9.8 - 8, 0));
  }
  {  // Drag acts on each by itself, with its own area, and turns nothing.
    const Model model(parse_scene(bodies + "[[force]]\nkind = \"quadratic-drag\"", ""));
    CHECK(model.islands().size() == 3);
    CHECK_FALSE(model.rotates(2));
    CHECK(decided(model, "forces", "\"a\", \"b\", \"c\""));
  }
  {  // Lift needs the spin of a sphere, which nothing else asks for.
    const Model model(
        parse_scene(bodies + "[[force]]\nkind = \"magnus-lift\"\nbodies = [\"b\"]", ""));
    CHECK(model.rotates(2));
    CHECK(decided(model, "rotation", "orientation is kept: \"b\""));
  }
  {  // Buoyancy is the same everywhere: still a parabola.
    const Model model(
        parse_scene(bodies + "[[force]]\nkind = \"buoyancy\"\ndensity = 1000\nvolume = 1e-3", ""));
    CHECK(model.closed_form(model.island_of(1)));
    CHECK(model.islands()[model.island_of(1)].forces.empty());
    CHECK((model.gravity_force(1) - Vector3(0, -9.8 * 2 + 9.8, 0)).norm() <= 1e-14);
    CHECK(decided(model, "forces", "buoyancy"));
  }
}

namespace {

/// A ball that can roll on a floor, with these lines at the top of the file.
Scene rolling(const std::string& top) {
  return parse_scene(top +
                         "\n[[body]]\nname = \"floor\"\nentity = \"wall\"\nshape = \"half-space\"\n"
                         "restitution = 0.25\nfriction = 0.09\n[[body]]\nname = \"ball\"\n"
                         "entity = \"body\"\nradius = 0.5\nmass = 1\nposition = [0, 0.5, 0]\n",
                     "");
}

}  // namespace

TEST_CASE("model: a pair's friction and restitution are combined as the scene says", "[model]") {
  const Model usual(rolling("friction = 0.25"));
  CHECK(usual.friction(0, 1) == Approx(0.15).epsilon(1e-15));
  CHECK(usual.friction(0, 1) == usual.friction(1, 0));
  CHECK(usual.restitution(0, 1) == 0.25);  // the product with 1
  CHECK(usual.has_friction());

  const Model product(
      rolling("friction = 0.25\nfriction_combine = \"product\"\n"
              "restitution_combine = \"geometric-mean\""));
  CHECK(product.friction(0, 1) == 0.09 * 0.25);
  CHECK(product.restitution(0, 1) == 0.5);
  const Model least(rolling("friction = 0.25\nfriction_combine = \"minimum\""));
  CHECK(least.friction(0, 1) == 0.09);

  const Model rough(rolling("friction = inf"));
  CHECK(std::isinf(rough.friction(0, 1)));
  // Where one is smooth the pair is, whatever the other and however they combine.
  for (const Combine how : {Combine::product, Combine::geometric_mean, Combine::minimum}) {
    CHECK(combine(how, 0.0, std::numeric_limits<double>::infinity()) == 0.0);
  }
}

TEST_CASE("model: a sphere turns where friction can turn it, and only there", "[model]") {
  const Model smooth(rolling(""));
  CHECK_FALSE(smooth.has_friction());
  CHECK_FALSE(smooth.rotates(1));
  const Model rough(rolling("friction = 0.3"));
  CHECK(rough.rotates(1));
  CHECK(rough.closed_form(0));  // at a constant rate between impacts
  CHECK(decided(rough, "friction", "spinning friction is left out"));
}
