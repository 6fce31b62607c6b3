// Cylinders and cones that roll and turn on faces, against closed forms.

#include "core/reading/scene_reader.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/whole_run.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

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
