// Joints by themselves: their rows are what they say, and scenes whose joints do not fit are
// refused by line and key.

#include "core/joint.hpp"

#include "core/error.hpp"
#include "core/joint_system.hpp"
#include "core/model.hpp"
#include "core/random.hpp"
#include "core/reading/scene_reader.hpp"
#include "tests/catch.hpp"
#include "tests/core/refused.hpp"

#include <array>
#include <string>
#include <vector>

using namespace kairos;

namespace {

using tests::BadScene;

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}
  Vector3 vector() {
    return {random_.uniform(-1.0, 1.0), random_.uniform(-1.0, 1.0), random_.uniform(-1.0, 1.0)};
  }
  Quaternion orientation() { return random_.orientation(); }

 private:
  Random random_;
};

/// A body that moves with constant accelerations, to second order in s.
struct Moving {
  BodyState state;
  Twist acceleration;

  explicit Moving(Draw& draw)
      : state{{draw.vector(), draw.orientation()}, {draw.vector(), draw.vector()}},
        acceleration{draw.vector(), draw.vector()} {}
  [[nodiscard]] JointEnd at(double s) const {
    const Vector3 turn = s * state.twist.angular + 0.5 * s * s * acceleration.angular;
    return {{state.pose.position + s * state.twist.linear + 0.5 * s * s * acceleration.linear,
             rotate(turn, state.pose.orientation)},
            state.twist,
            {}};
  }
};

Joint random_joint(Draw& draw, JointKind kind) {
  Joint joint;
  joint.kind = kind;
  joint.length = 0.7;
  joint.a = {0, draw.vector(), draw.orientation()};
  joint.b = {1, draw.vector(), draw.orientation()};
  return joint;
}

constexpr std::array all_kinds{JointKind::ball, JointKind::hinge, JointKind::slider, JointKind::rod,
                               JointKind::weld};

const std::string bar =
    "[[body]]\nname = \"bar\"\nentity = \"body\"\nhalf_extents = [0.5, 0.1, 0.1]\nmass = 1\n"
    "position = [0.5, 0, 0]\n";
const std::string other =
    "[[body]]\nname = \"other\"\nentity = \"body\"\nhalf_extents = [0.5, 0.1, 0.1]\nmass = 1\n"
    "position = [1.5, 0, 0]\n";
const std::string point_mass =
    "[[body]]\nname = \"bob\"\nentity = \"ball\"\nradius = 0.1\nmass = 1\nposition = [1, 0, 0]\n";
const std::string post =
    "[[body]]\nname = \"post\"\nentity = \"wall\"\nhalf_extents = [0.1, 1, 0.1]\n"
    "position = [-1, 0, 0]\n";
const std::string far_post =
    "[[body]]\nname = \"far\"\nentity = \"wall\"\nhalf_extents = [0.1, 1, 0.1]\n"
    "position = [-3, 0, 0]\n";

void check_refused(const BadScene& bad) {
  tests::check_refused(
      bad, [](const std::string& text, const char* file) { (void)Model(parse_scene(text, file)); });
}

}  // namespace

TEST_CASE("joint: rows, their rates and second derivatives are those of the residual", "[joint]") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    for (const JointKind kind : all_kinds) {
      CAPTURE(seed, to_string(kind));
      Draw draw(seed);
      const Moving a(draw);
      const Moving b(draw);
      const Joint joint = random_joint(draw, kind);
      const std::size_t n = row_count(kind);
      const auto rows_at = [&](double s) {
        std::array<JointRow, most_joint_rows> rows;
        joint_rows(joint, a.at(s), b.at(s), std::span(rows).first(n));
        return rows;
      };
      const double h = 1e-4;
      const auto before = rows_at(-h);
      const auto now = rows_at(0.0);
      const auto after = rows_at(h);
      for (std::size_t k = 0; k < n; ++k) {
        // Differences of a smooth function: C h^2, and C eps / h^2 of the second.
        const double rate = (after[k].residual - before[k].residual) / (2.0 * h);
        CHECK(now[k].rate(a.state.twist, b.state.twist) == Approx(rate).margin(1e-6));
        const double second =
            (after[k].residual - 2.0 * now[k].residual + before[k].residual) / (h * h);
        CHECK(now[k].rate(a.acceleration, b.acceleration) + now[k].bias ==
              Approx(second).margin(2e-6));
      }
    }
  }
}

TEST_CASE("joint: what is driven enters the second derivative by its own acceleration", "[joint]") {
  Draw draw(7);
  const Moving a(draw);
  const Moving b(draw);
  for (const JointKind kind : all_kinds) {
    CAPTURE(to_string(kind));
    const Joint joint = random_joint(draw, kind);
    const std::size_t n = row_count(kind);
    std::array<JointRow, most_joint_rows> free;
    std::array<JointRow, most_joint_rows> driven;
    JointEnd end_a = a.at(0.0);
    joint_rows(joint, end_a, b.at(0.0), std::span(free).first(n));
    end_a.acceleration = a.acceleration;
    joint_rows(joint, end_a, b.at(0.0), std::span(driven).first(n));
    for (std::size_t k = 0; k < n; ++k) {
      // Roundoff of a few products of numbers of order 1.
      CHECK(driven[k].bias ==
            Approx(free[k].bias + free[k].rate(a.acceleration, Twist{})).margin(1e-13));
    }
  }
}

TEST_CASE("joint: projections reach the constraints to roundoff and change nothing twice",
          "[joint]") {
  const std::string scene = bar + other +
                            "[[joint]]\nkind = \"hinge\"\nbodies = [\"bar\"]\nanchor = [0, 0, 0]\n"
                            "axis = [0, 0, 1]\n[[joint]]\nkind = \"ball\"\nbodies = [\"bar\", "
                            "\"other\"]\nanchor = [1, 0, 0]\n";
  const Model model(parse_scene(scene, "joints.toml"));
  REQUIRE(model.islands().size() == 1);
  const JointSystem& joints = *model.islands()[0].joints;
  CHECK(joints.rows() == 8);
  Draw draw(3);
  State states = model.initial_state();
  for (BodyState& s : states) {
    s.pose.position += 1e-3 * draw.vector();
    s.pose.orientation = rotate(1e-3 * draw.vector(), s.pose.orientation);
    s.twist = {draw.vector(), draw.vector()};
  }
  REQUIRE(joints.residual(Instant{}, states) > 1e-4);
  const std::vector<Vector3> forces(2, Vector3::Zero());
  CHECK(joints.project_positions(Instant{}, states, forces).converged);
  // Roundoff of coordinates of 1 m.
  CHECK(joints.residual(Instant{}, states) <= 8 * 0x1p-52);
  double before = 0.0;
  double after = 0.0;
  for (BodyIndex i = 0; i < 2; ++i) {
    before += model.kinetic_energy(i, states[i]);
  }
  const JointProjection velocities = joints.project_velocities(Instant{}, states);
  CHECK(joints.residual_rate(Instant{}, states) <= 16 * 0x1p-52);
  for (BodyIndex i = 0; i < 2; ++i) {
    after += model.kinetic_energy(i, states[i]);
  }
  // The identity of impulses: sum p (u- + u+) / 2, to roundoff.
  CHECK(velocities.velocity == Approx(after - before).margin(1e-14));
  CHECK(velocities.velocity < 0.0);
  CHECK(std::abs(joints.project_velocities(Instant{}, states).velocity) < 1e-14);
}

TEST_CASE("joint: neighbours do not meet unless asked, and loops that say too much are told",
          "[joint]") {
  const std::string hinge =
      "[[joint]]\nkind = \"hinge\"\nbodies = [\"bar\", \"other\"]\nanchor = [1, 0, 0]\n"
      "axis = [0, 0, 1]\n";
  CHECK_FALSE(Model(parse_scene(bar + other + hinge, "a.toml")).interacts(0, 1));
  CHECK(Model(parse_scene(bar + other + hinge + "collide = true\n", "a.toml")).interacts(0, 1));
  const auto told = [](const Model& model) {
    for (const Decision& decision : model.decisions()) {
      if (decision.text.find("over-determined") != std::string::npos) {
        return decision.text;
      }
    }
    return std::string();
  };
  CHECK(told(Model(parse_scene(bar + other + hinge, "a.toml"))).empty());
  const std::string twice = told(Model(parse_scene(bar + other + hinge + hinge, "a.toml")));
  CHECK(twice.find("10 rows, 5 of them independent") != std::string::npos);
}

TEST_CASE("joint: what does not fit is refused by file, line and key", "[joint]") {
  const std::vector<BadScene> all = {
      {bar + "[[joint]]\n", 7, "joint[0].kind", "missing"},
      {bar + "[[joint]]\nkind = \"glue\"\n", 8, "joint[0].kind", "ball"},
      {bar + "[[joint]]\nkind = \"ball\"\n", 7, "joint[0].bodies", "missing"},
      {bar + "[[joint]]\nkind = \"ball\"\nbodies = []\n", 9, "joint[0].bodies", "names 0 bodies"},
      {bar + "[[joint]]\nkind = \"ball\"\nbodies = [\"baz\"]\n", 9, "joint[0].bodies[0]", "bar"},
      {bar + "[[joint]]\nkind = \"ball\"\nbodies = [\"bar\", \"bar\"]\n", 9, "joint[0].bodies",
       "twice"},
      {bar + "[[joint]]\nkind = \"ball\"\nbodies = [\"bar\"]\n", 7, "joint[0].anchor", "missing"},
      {bar + "[[joint]]\nkind = \"ball\"\nbodies = [\"bar\"]\nanchor = [nan, 0, 0]\n", 10,
       "joint[0].anchor[0]", "number"},
      {bar +
           "[[joint]]\nkind = \"ball\"\nbodies = [\"bar\"]\nanchor = [0, 0, 0]\naxis = [1, 0, 0]\n",
       11, "joint[0].axis", "unknown"},
      {bar + "[[joint]]\nkind = \"hinge\"\nbodies = [\"bar\"]\nanchor = [0, 0, 0]\n", 7,
       "joint[0].axis", "missing"},
      {bar + "[[joint]]\nkind = \"hinge\"\nbodies = [\"bar\"]\nanchor = [0, 0, 0]\naxis = [0, 0, "
             "0]\n",
       11, "joint[0].axis", "direction"},
      {bar + "[[joint]]\nkind = \"ball\"\nbodies = [\"bar\"]\nanchor = [0, 0, 0]\npoint_b = [0, 0, "
             "0]\n",
       11, "joint[0].point_b", "one body"},
      {bar + other +
           "[[joint]]\nkind = \"ball\"\nbodies = [\"bar\", \"other\"]\nanchor = [1, 0, 0]\n"
           "point_a = [0, 0, 0]\npoint_b = [0, 0, 0]\n",
       16, "joint[0].anchor", "two of"},
      // Sides that are not where the joint puts them.
      {bar + other +
           "[[joint]]\nkind = \"ball\"\nname = \"elbow\"\nbodies = [\"bar\", \"other\"]\n"
           "point_a = [0.5, 0, 0]\npoint_b = [-0.5, 0.01, 0]\n",
       13, "joint.elbow.bodies", "0.01 m off"},
      {bar + other + "[[joint]]\nkind = \"rod\"\nbodies = [\"bar\", \"other\"]\nlength = 1.1\n", 13,
       "joint[0].length", "1 m apart"},
      {bar + "[[joint]]\nkind = \"rod\"\nbodies = [\"bar\"]\nanchor = [0, 0, 0]\nlength = 0\n", 11,
       "joint[0].length", "m"},
      {bar + "[[joint]]\nkind = \"rod\"\nbodies = [\"bar\"]\nanchor = [0.5, 0, 0]\n", 7, "joint[0]",
       "one place"},
      // Velocities that part.
      {bar + "velocity = [0, 1, 0]\n[[joint]]\nkind = \"ball\"\nbodies = [\"bar\"]\nanchor = [0, "
             "0, 0]\n",
       8, "joint[0].bodies", "part at 1 m/s"},
      // Nothing can move; what does not turn is turned.
      {post + far_post + "[[joint]]\nkind = \"weld\"\nbodies = [\"post\", \"far\"]\n", 11,
       "joint[0].bodies", "none of them can move"},
      {point_mass + "[[joint]]\nkind = \"hinge\"\nbodies = [\"bob\"]\nanchor = [0, 0, 0]\naxis = "
                    "[0, 0, 1]\n",
       7, "joint[0].bodies", "does not turn"},
      {point_mass + "[[joint]]\nkind = \"ball\"\nbodies = [\"bob\"]\nanchor = [0, 0, 0]\n", 7,
       "joint[0].bodies", "does not turn"},
      {bar + "[[joint]]\nkind = \"ball\"\nname = \"j\"\nbodies = [\"bar\"]\nanchor = [0, 0, 0]\n"
             "[[joint]]\nkind = \"ball\"\nname = \"j\"\nbodies = [\"bar\"]\nanchor = [0, 0, 0]\n",
       14, "joint.j.name", "already"},
  };
  for (const BadScene& bad : all) {
    check_refused(bad);
  }
}
