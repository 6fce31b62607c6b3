// Cylinders and cones that roll and turn on faces, against closed forms.

#include "core/contacts/touch.hpp"
#include "core/random.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/registry.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/whole_run.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

using namespace kairos;

namespace {

constexpr double g = 9.8;

std::string head(double duration, const std::string& mu, const std::string& floor) {
  return fmt::format(
      "duration = {}\nframe = \"1/60\"\nG = {}\nfriction = {}\n"
      "[[body]]\nname = \"floor\"\nentity = \"wall\"\n{}\n",
      duration, g, mu, floor);
}

const std::string half_space = "shape = \"half-space\"";

std::string body(const std::string& name, const std::string& shape, const std::string& rest) {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"body\"\n{}\nmass = 1.0\nrestitution = 0.0\n{}\n", name,
      shape, rest);
}

std::string list(const Vector3& v) {
  return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x(), v.y(), v.z());
}

std::string list(const Quaternion& q) {
  return fmt::format("[{:.17g}, {:.17g}, {:.17g}, {:.17g}]", q.w(), q.x(), q.y(), q.z());
}

/// Implicit steps are of first order: of all that flowed.
constexpr double implicit = 1e-6;

Simulation run(const std::string& text) {
  INFO(text);
  const Scene scene = parse_scene(text, "test.toml");
  Simulation sim = simulate(scene, {});
  tests::check_whole(sim, scene, implicit);
  CHECK(sim.result.ledger.line(EnergyLine::friction) <= 1e-15);
  return sim;
}

const std::string lying = "axis_angle = [1, 0, 0, 1.5707963267948966]";

}  // namespace

// g sin / (1 + I / (m r^2)) = 2/3 g sin for what rolls, on a half-space as on a box; what slides
// does so by g (sin - mu cos), and turns by 2 mu g cos / r.
TEST_CASE("rims: a cylinder rolls and slides down an incline", "[turning][rims]") {
  const double angle = 0.3;
  const Vector3 down(std::cos(angle), -std::sin(angle), 0.0);
  const Vector3 up(std::sin(angle), std::cos(angle), 0.0);
  for (const std::string& floor :
       {"shape = \"half-space\"\nnormal = " + list(up),
        "half_extents = [10, 0.1, 2]\naxis_angle = [0, 0, 1, " + fmt::format("{:.17g}", -angle) +
            "]\nposition = " + list(-0.1 * up)}) {
    for (const double mu : {1.0, 0.05}) {
      CAPTURE(floor, mu);
      const bool rolls = mu > std::tan(angle) / 3.0;
      const std::string text = head(1.5, fmt::format("{}", mu), floor) +
                               body("roll", "shape = \"cylinder\"\nradius = 0.1\nlength = 0.4",
                                    lying + "\nposition = " + list(0.1 * up));
      const Simulation sim = run(text);
      const double a =
          rolls ? 2.0 / 3.0 * g * std::sin(angle) : g * (std::sin(angle) - mu * std::cos(angle));
      const double spin = rolls ? a / 0.1 : 2.0 * mu * g * std::cos(angle) / 0.1;
      for (const double t : {0.3, 0.9, 1.5}) {
        const BodyState state = sim.trajectory.at(1, Instant{} + t);
        CHECK((state.pose.position - (0.1 * up + 0.5 * a * t * t * down)).norm() <= 1e-9);
        CHECK((state.twist.angular - Vector3(0, 0, -spin * t)).norm() <= 1e-8);
      }
      const double rubbed = rolls ? 0.0 : mu * g * std::cos(angle);
      // Over the way of the surface: 1.5 s of the difference of both accelerations.
      const double way = 0.5 * (a - 0.1 * spin) * 1.5 * 1.5;
      CHECK(std::abs(sim.result.ledger.line(EnergyLine::friction) + rubbed * way) <= 1e-8);
    }
  }
}

// A disc whose middle stays where it is while it rolls round on its rim, tilted by alpha: with the
// place p of the rim from the middle, W^2 sin((I1 - I3) cos + I3 p_x / r) = m g p_x; of a thin one
// W^2 = 4 g / (r sin).
TEST_CASE("rims: a disc rolls round on its rim, as steady as it should", "[turning][rims]") {
  for (const double alpha : {0.2, 0.6, 1.2}) {
    for (const double length : {0.01, 0.1}) {
      CAPTURE(alpha, length);
      const double r = 0.1;
      const double across = r * r / 4.0 + length * length / 12.0;
      const double about = 0.5 * r * r;
      const double px = r * std::cos(alpha) - 0.5 * length * std::sin(alpha);
      const double pz = -r * std::sin(alpha) - 0.5 * length * std::cos(alpha);
      const double round = std::sqrt(
          g * px / (std::sin(alpha) * ((across - about) * std::cos(alpha) + about * px / r)));
      const double spin = -round * px / r;
      // The axis of the body is y, and so is the vertical: it leans towards x.
      const Vector3 axis(std::sin(alpha), std::cos(alpha), 0.0);
      const Quaternion q = Quaternion::FromTwoVectors(Vector3::UnitY(), axis);
      const Vector3 turns = round * Vector3::UnitY() + spin * axis;
      const std::string text =
          head(0.8, "inf", half_space) +
          body("disc", fmt::format("shape = \"cylinder\"\nradius = {}\nlength = {}", r, length),
               "position = " + list(Vector3(0, -pz, 0)) + "\norientation = " + list(q) +
                   "\nangular_velocity = " + list(turns));
      const Simulation sim = run(text);
      for (const double t : {0.11, 0.4, 0.8}) {
        CAPTURE(t);
        const BodyState state = sim.trajectory.at(1, Instant{} + t);
        CHECK((state.pose.position - Vector3(0, -pz, 0)).norm() <= 1e-8);
        const Vector3 leans = state.pose.orientation * Vector3::UnitY();
        const Vector3 known(std::sin(alpha) * std::cos(round * t), std::cos(alpha),
                            -std::sin(alpha) * std::sin(round * t));
        CHECK((leans - known).norm() <= 1e-6);
      }
      CHECK(sim.result.ledger.line(EnergyLine::friction) == 0.0);
    }
  }
}

// A coin that rolls and leans gains and loses nothing.
TEST_CASE("rims: a coin that rolls keeps its energy", "[turning][rims]") {
  const double leans = 0.3;
  const Quaternion q(Eigen::AngleAxisd(0.5 * M_PI - leans, Vector3::UnitX()));
  const double r = 0.1;
  const double length = 0.02;
  const Vector3 e = q * Vector3::UnitY();
  const Vector3 out = (-Vector3::UnitY() + e * e.y()).normalized();
  const Vector3 arm = r * out - 0.5 * length * e;
  const Vector3 turns = 12.0 * e;
  const std::string text =
      head(5.0, "inf", half_space) +
      body("coin", fmt::format("shape = \"cylinder\"\nradius = {}\nlength = {}", r, length),
           "position = " + list(Vector3(0, -arm.y(), 0)) + "\norientation = " + list(q) +
               "\nvelocity = " + list(-turns.cross(arm)) + "\nangular_velocity = " + list(turns));
  const Simulation sim = run(text);
  CHECK(sim.result.ledger.line(EnergyLine::friction) == 0.0);
  CHECK(std::abs(sim.result.ledger.line(EnergyLine::truncation)) <= 1e-8);
  CHECK(sim.result.cost.impacts == 0);
}

// On its side a cone rolls about its apex: its axis goes round by cot(half of its angle) times the
// rate at which it turns about itself.
TEST_CASE("rims: a cone rolls about its apex", "[turning][rims]") {
  const double r = 0.1;
  const double height = 0.3;
  const double half = std::atan2(r, height);
  // Its side along x from the apex at the origin: the axis rises from there.
  const Vector3 axis(-std::cos(half), -std::sin(half), 0.0);  // from base to apex
  const Quaternion q = Quaternion::FromTwoVectors(Vector3::UnitY(), axis);
  const Vector3 middle = -0.75 * height * axis;
  // The side that touches is at rest: it turns about that.
  const Vector3 turns(2.0, 0.0, 0.0);
  const std::string text =
      head(2.0, "inf", half_space) +
      body("cone", fmt::format("shape = \"cone\"\nradius = {}\nheight = {}", r, height),
           "position = " + list(middle) + "\norientation = " + list(q) +
               "\nvelocity = " + list(turns.cross(middle)) + "\nangular_velocity = " + list(turns));
  const Simulation sim = run(text);
  // v = w x middle = 2 * 0.75 h sin(half) along z at the distance 0.75 h cos(half).
  const double round = -2.0 * std::tan(half);
  for (const double t : {0.5, 1.0, 2.0}) {
    CAPTURE(t);
    const Vector3 known = Eigen::AngleAxisd(round * t, Vector3::UnitY()) * middle;
    CHECK((sim.trajectory.at(1, Instant{} + t).pose.position - known).norm() <= 1e-8);
  }
}

// Where what touches goes from the side of a capsule into its cap, nothing jumps: at the end of the
// side the two are one surface. They hopped there, 3e-11 m high, until the run stopped.
TEST_CASE("rims: capsules roll over the ends of each other", "[turning][capsules]") {
  const std::string first =
      head(0.6, "0.5", half_space) +
      "[[body]]\nname = \"below\"\nentity = \"wall\"\nshape = \"capsule\"\n"
      "radius = 0.2823444624806015\nlength = 1.6510747085622905\n"
      "orientation = [0.7071067811865475, 0.6274722352800458, 0.0, -0.32600397843072826]\n"
      "position = [-0.6, 0.29234446248060153, -0.004751528952564893]\n" +
      body("above",
           "shape = \"capsule\"\nradius = 0.14339615544386147\nlength = 0.45123806676221306",
           "orientation = [-0.5539247876247264, 0.7251905258376031, 0.37786550583524986, "
           "-0.1564726506139435]\n"
           "position = [-0.22168894152855456, 1.2, 0.06299377974950013]");
  const std::string second =
      head(0.6, "0", half_space) +
      "[[body]]\nname = \"below\"\nentity = \"wall\"\nshape = \"capsule\"\n"
      "radius = 0.1481078785116669\nlength = 1.2969431858821348\n"
      "orientation = [0.6436301758845343, 0.4528256562853461, 0.0, -0.6170000986228359]\n"
      "position = [0.0, 0.2693080423660502, -0.04812704094595797]\n"
      "[[body]]\nname = \"beside\"\nentity = \"wall\"\nshape = \"capsule\"\n"
      "radius = 0.17075680479065178\nlength = 1.0788736770019471\n"
      "orientation = [0.6081035706788273, 0.0, 0.0, -0.793857699671459]\n"
      "position = [0.6, 0.3212369973336425, 0.01666975440837]\n" +
      body("above",
           "shape = \"capsule\"\nradius = 0.19012653012111974\nlength = 0.7016489411202316",
           "orientation = [0.7071067811865476, 0.0, 0.0, 0.7071067811865476]\n"
           "position = [0.02350658558716634, 1.2, -0.096259026418916]");
  for (const std::string& text : {first, second}) {
    const Simulation sim = run(text);
    CHECK(sim.result.cost.impacts < 100);
  }
}

// It goes twice as far as they.
TEST_CASE("rims: a plank on two rollers", "[turning][rims]") {
  std::string text = head(1.0, "2.0", half_space);
  for (const double x : {-0.3, 0.3}) {
    text += body(fmt::format("roller-{}", x > 0.0 ? "b" : "a"),
                 "shape = \"cylinder\"\nradius = 0.1\nlength = 0.6",
                 lying + fmt::format("\nposition = [{}, 0.1, 0]\nvelocity = [0.2, 0, 0]\n"
                                     "angular_velocity = [0, 0, -2]",
                                     x));
  }
  text += body("plank", "half_extents = [1, 0.05, 0.2]",
               "position = [0, 0.25, 0]\nvelocity = [0.4, 0, 0]");
  const Simulation sim = run(text);
  for (const double t : {0.4, 1.0}) {
    CAPTURE(t);
    CHECK(std::abs(sim.trajectory.at(3, Instant{} + t).pose.position.x() - 0.4 * t) <= 1e-8);
    CHECK(std::abs(sim.trajectory.at(1, Instant{} + t).pose.position.x() - (0.2 * t - 0.3)) <=
          1e-8);
  }
}

namespace {

constexpr double radius = 0.1;
constexpr double half = 0.15;
const std::string can =
    fmt::format("shape = \"cylinder\"\nradius = {}\nlength = {}", radius, 2.0 * half);
const std::string box = "half_extents = [0.1, 0.15, 0.2]";
const std::string cone = "shape = \"cone\"\nradius = 0.3\nheight = 0.4";

/// Where a shape is to touch: along what, and which way its surface looks there.
struct Frame {
  Frame(const Vector3& x, const Vector3& tangent, const Vector3& outward) : at(x) {
    axes << tangent, outward, tangent.cross(outward);
  }
  Vector3 at;
  Matrix3 axes;
};

const double sine = std::sqrt(0.5);
const Frame rim({radius, -half, 0.0}, Vector3::UnitZ(), {sine, -sine, 0.0});
const Frame edge({0.1, -0.15, 0.05}, Vector3::UnitZ(), {sine, -sine, 0.0});
const Frame side({0.15, 0.1, 0.0}, Vector3::UnitZ(), {0.8, 0.6, 0.0});

struct Crossing {
  std::string below;
  Frame on_below;
  std::string above;
  Frame on_above;
};

/// So that it touches at the origin along this, with its surface looking there.
Pose placed(const Frame& f, const Vector3& tangent, const Vector3& outward) {
  Matrix3 world;
  world << tangent, outward, tangent.cross(outward);
  const Quaternion q = Quaternion(Matrix3(world * f.axes.transpose())).normalized();
  return {-(q * f.at), q};
}

/// The one lies on the other, at this angle; the normal leads up, and a little aside. `aside`: of
/// what stays where it is.
std::string crossing(const Crossing& c, double angle, const std::string& mu, const Vector3& aside) {
  const Vector3 normal = Vector3(0.1, 1.0, 0.05).normalized();
  const Vector3 along = normal.cross(Vector3(0.3, 0.2, -1.0)).normalized();
  const Pose below = placed(c.on_below, along, normal);
  const Pose above = placed(c.on_above, Eigen::AngleAxisd(angle, normal) * along, -normal);
  return fmt::format(
             "duration = 0.1\nframe = \"1/60\"\nG = {}\nfriction = {}\n"
             "[[body]]\nname = \"below\"\nentity = \"wall\"\n{}\nposition = {}\norientation = {}\n",
             g, mu, c.below, list(below.position + aside), list(below.orientation)) +
         body("above", c.above,
              fmt::format("position = {}\norientation = {}", list(above.position + 1e-12 * normal),
                          list(above.orientation)));
}

}  // namespace

// Curves that cross and do not slip touch at the same points of both: the body turns about that
// point as it would on a ball joint.
TEST_CASE("rims: what sticks where edges and rims cross turns about that point",
          "[turning][rims]") {
  const Crossing cases[] = {{box, edge, can, rim}, {can, rim, box, edge}, {can, rim, can, rim}};
  for (const Crossing& c : cases) {
    for (const double angle : {0.4, 1.2, 2.2}) {
      CAPTURE(c.below, c.above, angle);
      const Simulation touching = run(crossing(c, angle, "inf", Vector3::Zero()));
      const std::string hung = crossing(c, angle, "inf", {0.0, -9.0, 0.0}) +
                               "[[joint]]\nkind = \"ball\"\nbodies = [\"above\"]\n"
                               "anchor = [0, 0, 0]\n";
      const Simulation hanging = simulate(parse_scene(hung, "test.toml"), {});
      const BodyState end = touching.trajectory.at(1, Instant{} + 0.1);
      const BodyState exact = hanging.trajectory.at(1, Instant{} + 0.1);
      CHECK((end.pose.position - exact.pose.position).norm() <= 1e-9);
      CHECK((end.twist.angular - exact.twist.angular).norm() <= 1e-7);
      CHECK((exact.pose.position - hanging.trajectory.at(1, Instant{}).pose.position).norm() >
            0.01);
    }
  }
}

// Nothing works on what slides without friction, or rolls, over the side of a cone.
TEST_CASE("rims: an edge, a rim and a side go over the side of a cone, and keep their energy",
          "[turning][rims]") {
  const Crossing cases[] = {
      {cone, side, box, edge}, {cone, side, can, rim}, {box, edge, cone, side}};
  for (const Crossing& c : cases) {
    for (const double angle : {0.4, 1.2, 2.2}) {
      for (const char* const mu : {"0", "inf"}) {
        CAPTURE(c.below, c.above, angle, mu);
        const Simulation sim = run(crossing(c, angle, mu, Vector3::Zero()));
        const auto& ledger = sim.result.ledger;
        CHECK(std::abs(ledger.line(EnergyLine::truncation)) <= 1e-9);
        CHECK(std::abs(ledger.line(EnergyLine::restitution_loss)) <= 1e-9);
        const auto& events = sim.trajectory.events();
        const bool ends = std::any_of(events.begin(), events.end(), [](const Event& event) {
          return event.kind == EventKind::contact_ends;
        });
        CHECK(!ends);
      }
    }
  }
}

// What turns about the normal, infinite friction stops at once, and with that m (3 r^2 + l^2) w^2 /
// 24; it rolls from rest by 2/3 g sin.
TEST_CASE("rims: a rough cylinder that spins stops by an impulse, and rolls", "[turning][rims]") {
  const double tilt = 0.2;
  const Vector3 normal(-std::sin(tilt), std::cos(tilt), 0.0);
  for (const double spin : {1.0, -3.0}) {
    CAPTURE(spin);
    const Simulation sim = run(head(0.5, "inf", half_space + "\nnormal = " + list(normal)) +
                               body("can", "shape = \"cylinder\"\nradius = 0.1\nlength = 0.3",
                                    lying + "\nposition = " + list(0.1 * normal) +
                                        "\nangular_velocity = " + list(spin * normal)));
    const BodyState end = sim.trajectory.at(1, Instant{} + 0.5);
    const Vector3 way = end.pose.position - 0.1 * normal;
    const Vector3 up(std::cos(tilt), std::sin(tilt), 0.0);
    CHECK(std::abs(up.dot(way) + g * std::sin(tilt) / 3.0 * 0.25) <= 1e-9);
    CHECK(std::abs(way.z()) <= 1e-9);
    const double lost = 0.12 * spin * spin / 24.0;
    CHECK(std::abs(sim.result.ledger.line(EnergyLine::impact_friction) + lost) <= 1e-12);
  }
}

TEST_CASE("rims: of coins that hardly tilt on each other it is known where they touch", "[rims]") {
  const std::uint64_t seed = 20261130;
  CAPTURE(seed);
  Random random(seed);
  const auto detector = find_detector("certified");
  constexpr double gap = 1e-11;
  for (int round = 0; round < 400; ++round) {
    CAPTURE(round);
    const Cylinder lower{random.uniform(0.05, 0.2), random.uniform(0.01, 0.1)};
    const Cylinder upper{random.uniform(0.05, 0.2), random.uniform(0.01, 0.1)};
    const auto turned = [&] {
      const double tilt = std::pow(10.0, random.uniform(-10.0, -3.0));
      const double where = random.uniform(0.0, 6.3);
      return Quaternion(Eigen::AngleAxisd(tilt, Vector3(std::cos(where), 0.0, std::sin(where))));
    };
    Pose below;
    below.orientation = turned();
    Pose above;
    above.orientation = turned();
    // Each is beside the middle of the other: rims cross.
    const double beside = random.uniform(0.3, 0.9) * (lower.radius + upper.radius);
    const double where = random.uniform(0.0, 6.3);
    above.position = Vector3(beside * std::cos(where), 0.2, beside * std::sin(where));
    for (int k = 0; k < 8; ++k) {
      const Overlap apart = detector->overlap(lower, below, upper, above);
      above.position.y() -= apart.gap - 0.5 * gap;
    }
    const ContactManifold manifold = detector->manifold(lower, below, upper, above, gap);
    REQUIRE(manifold.size > 0);
    for (std::size_t k = 0; k < manifold.size; ++k) {
      CHECK(touch_at(manifold, k, lower, below, upper, above));
    }
  }
}

// Random scenes that stopped: a can that is struck and goes down flat, a rough coin that is thrown
// up as its other side lands, a cone on its side over the edge of a slab.
TEST_CASE("rims: what stopped once", "[turning][rims][slow]") {
  const std::string can_and_ball =
      head(2.0, "0.5", half_space) +
      "[[body]]\nname = \"can\"\nentity = \"body\"\nshape = \"cylinder\"\nradius = 0.05\n"
      "length = 0.12\nposition = [0, 0.06, 0]\nmass = 0.4\nrestitution = 0\n"
      "[[body]]\nname = \"ball\"\nentity = \"body\"\nshape = \"sphere\"\nradius = 0.04\n"
      "position = [0, 0.06, -1]\nmass = 0.3\nrestitution = 0.4\nvelocity = [0, 0.8, 5]\n";
  const std::string slab =
      "[[body]]\nname = \"slab\"\nentity = \"wall\"\nshape = \"box\"\n"
      "half_extents = [0.5, 0.1, 0.5]\nposition = [0, 0.45, 0]\n";
  const std::string coin =
      head(1.0, "inf", half_space) + slab + "axis_angle = [1, 0, 0.3, -0.173291]\n" +
      body("box", "half_extents = [0.159677, 0.107276, 0.133002]",
           "orientation = [-0.6628990950866542, -0.3195662074305183, -0.2085244873254485, "
           "0.6441737087055236]\nposition = [-0.00734551, 1, -0.177651]\n"
           "velocity = [0.430686, 0, -0.821408]\n"
           "angular_velocity = [-0.321657, -2.0723, -0.330437]") +
      "[[body]]\nname = \"coin\"\nentity = \"body\"\nshape = \"cylinder\"\nradius = 0.160462\n"
      "length = 0.037776\nmass = 0.01\nrestitution = 0\n"
      "orientation = [0.8522245753716001, -0.25774347386036683, 0.4134163341967364, "
      "-0.1907052947204635]\nposition = [0.124529, 1.7, 0.0123762]\n"
      "velocity = [0.343054, 0, 0.528664]\nangular_velocity = [2.04539, 0, 0.215175]\n";
  const std::string cone_on_edge =
      head(1.5, "1", half_space + "\nnormal = [-0.111675, 1, 0]") + slab +
      "axis_angle = [1, 0, 0.3, 0.118318]\n"
      "[[body]]\nname = \"cone\"\nentity = \"body\"\nshape = \"cone\"\nradius = 0.107513\n"
      "height = 0.26077\nmass = 0.01\nrestitution = 0.3\n"
      "orientation = [0.3924087262596756, -0.6210376708038736, -0.674444661902398, "
      "0.07383766673668928]\nposition = [0.0557364, 1, 0.0733572]\n"
      "velocity = [0.141452, 0, 0.317017]\nangular_velocity = [0, -1.39072, 0.92339]\n";
  for (const std::string& text : {can_and_ball, coin, cone_on_edge}) {
    (void)run(text);
  }
}
