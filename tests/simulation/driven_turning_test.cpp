// Bodies that turn, stack or are pushed in touch with what is driven, against closed forms.

#include "core/drive.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/simulation/whole_run.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

using namespace kairos;

namespace {

constexpr double g = 9.8;

/// A table whose top is at y = 0, driven as told, and what is on it.
std::string on_table(double duration, double mu, const std::string& drive,
                     const std::string& bodies) {
  return fmt::format(
      "duration = {}\nframe = \"1/60\"\nG = {}\nfriction = {}\n"
      "[[body]]\nname = \"table\"\nentity = \"wall\"\nhalf_extents = [5, 0.1, 5]\n"
      "position = [0, -0.1, 0]\n{}\n{}",
      duration, g, mu, drive, bodies);
}

std::string load(const std::string& name, const std::string& shape, const std::string& rest) {
  return fmt::format(
      "[[body]]\nname = \"{}\"\nentity = \"body\"\n{}\nmass = 1.0\nrestitution = 0.0\n{}\n", name,
      shape, rest);
}

std::string ball(const std::string& rest) {
  return load("ball", "shape = \"sphere\"\nradius = 0.1", rest);
}

/// Implicit steps are of second order where something drives: of all that flowed.
constexpr double implicit = 1e-8;

void check_whole(const Simulation& sim, const Scene& scene) {
  tests::check_whole(sim, scene, implicit);
  CHECK(sim.result.ledger.line(EnergyLine::friction) <= 1e-15);
}

Simulation run(const std::string& text) {
  const Scene scene = parse_scene(text, "test.toml");
  Simulation sim = simulate(scene, {});
  check_whole(sim, scene);
  return sim;
}

/// Goes straight on, and turns at a constant rate about its own y.
class Steady final : public Drive {
 public:
  Steady(Vector3 velocity, double rate) : velocity_(std::move(velocity)), rate_(rate) {}

  [[nodiscard]] Motion motion(Instant t, double at_most) const override {
    constexpr double piece = 0.37;  // no part of a frame
    const double s = t - Instant{};
    const Pose pose{Vector3(0, -0.1, 0) + s * velocity_,
                    Quaternion(Eigen::AngleAxisd(rate_ * s, Vector3::UnitY()))};
    const Twist twist{velocity_, rate_ * Vector3::UnitY()};
    return Motion::ballistic(t, std::min(piece, at_most), pose, twist, Vector3::Zero());
  }
  [[nodiscard]] std::string description() const override { return "goes on as it is"; }

 private:
  Vector3 velocity_;
  double rate_;
};

/// The same with the table driven so.
Simulation run(const std::string& text, const Vector3& velocity, double rate) {
  Scene scene = parse_scene(text, "test.toml");
  scene.bodies[0].drive = std::make_shared<Steady>(velocity, rate);
  Simulation sim = simulate(scene, {});
  check_whole(sim, scene);
  return sim;
}

}  // namespace

// m v' = F and I w' = -r y x F: of what the surface moves along itself a ball that rolls takes
// I / (I + m r^2) = 2/7, whatever the surface does.
TEST_CASE("driven, turning: a ball rolls on a table that shakes", "[driven][turning]") {
  const std::string text = on_table(
      3.0, 2.0, "drive = {frequency = 1, amplitude = [0.1, 0, 0], phase = 1.5707963267948966}",
      ball("position = [0.1, 0.1, 0]"));
  const Simulation sim = run(text);
  for (const double t : {0.1, 0.77, 1.5, 2.9}) {
    CAPTURE(t);
    const BodyState state = sim.trajectory.at(1, Instant{} + t);
    const double moved = 0.1 * (std::cos(2.0 * M_PI * t) - 1.0);
    CHECK(std::abs(state.pose.position.x() - (0.1 + 2.0 / 7.0 * moved)) <= 1e-10);
    CHECK(std::abs(state.pose.position.y() - 0.1) <= 1e-9);
  }
  // All that the table did is what the ball has.
  CHECK(sim.result.ledger.line(EnergyLine::friction) >= -1e-15);
}

// On a turntable v = 2/7 W y x r + const: from rest in the middle of what it is added to it goes
// round by 2/7 of the turn; at a constant rate on a circle, once in 7/2 turns.
TEST_CASE("driven, turning: a ball on a turntable goes round two sevenths as fast",
          "[driven][turning]") {
  const std::string swings =
      on_table(4.0, 2.0,
               "drive = {frequency = 0.25, rotation_axis = [0, 1, 0], rotation_amplitude = 1.5, "
               "rotation_phase = 1.5707963267948966}",
               ball("position = [0.5, 0.1, 0]"));
  const Simulation swung = run(swings);
  const std::string turns =
      on_table(4.0, 2.0, "",
               ball("position = [0.5, 0.1, 0]\nvelocity = [0, 0, -0.2857142857142857]\n"
                    "angular_velocity = [7.142857142857143, 0, 0]"));
  // Rolling: v - r w x y = W y x p.
  const Simulation turned = run(turns, Vector3::Zero(), 2.0);
  for (const double t : {0.3, 1.0, 2.2, 3.9}) {
    CAPTURE(t);
    const double swing = 2.0 / 7.0 * 1.5 * (std::cos(0.5 * M_PI * t) - 1.0);
    const double turn = 2.0 / 7.0 * 2.0 * t;
    for (const auto& [sim, angle] : {std::pair{&swung, swing}, {&turned, turn}}) {
      const Vector3 p = sim->trajectory.at(1, Instant{} + t).pose.position;
      const Vector3 known(0.5 * std::cos(angle), 0.1, -0.5 * std::sin(angle));
      CHECK((p - known).norm() <= 1e-9);
    }
  }
}

TEST_CASE("driven, turning: a stack rides on a lift and on a table that shakes",
          "[driven][turning]") {
  // 2 m/s^2 of g; and of 0.5 g, which friction gives.
  for (const Vector3& amplitude : {Vector3(0, 0.2, 0), Vector3(0.2, 0.1, 0)}) {
    CAPTURE(amplitude.transpose());
    std::string boxes;
    for (int k = 0; k < 3; ++k) {
      boxes +=
          load(fmt::format("box-{}", k), "half_extents = [0.2, 0.1, 0.2]",
               fmt::format("position = [{}, {}, 0]", amplitude.x(), amplitude.y() + 0.1 + 0.2 * k));
    }
    const std::string text =
        on_table(3.0, 0.5,
                 fmt::format("drive = {{frequency = 0.5, amplitude = [{}, {}, 0], phase = "
                             "1.5707963267948966}}",
                             amplitude.x(), amplitude.y()),
                 boxes);
    const Simulation sim = run(text);
    for (const Event& event : sim.trajectory.events()) {
      // At first it has the velocity of a cosine of pi / 2 in doubles: that is passed on.
      CHECK((event.kind != EventKind::impact || event.time == Instant{}));
    }
    double kinetic = 0.0;
    double height = 0.0;
    for (std::size_t k = 1; k <= 3; ++k) {
      for (const double t : {0.4, 1.3, 2.9}) {
        const BodyState box = sim.trajectory.at(k, Instant{} + t);
        const Vector3 moved = amplitude * std::cos(M_PI * t);
        const Vector3 known = Vector3(0, 0.2 * static_cast<double>(k) - 0.1, 0) + moved;
        CHECK((box.pose.position - known).norm() <= 2e-9);
        CHECK(box.twist.angular.norm() <= 1e-9);
      }
      const BodyState end = sim.trajectory.at(k, Instant{} + 3.0);
      kinetic += 0.5 * end.twist.linear.squaredNorm();
      height += end.pose.position.y() - (amplitude.y() + 0.2 * static_cast<double>(k) - 0.1);
    }
    const double work = sim.result.ledger.line(EnergyLine::driven_work);
    CHECK(std::abs(work - (kinetic + g * height)) <= 1e-8);
    CHECK(sim.result.ledger.line(EnergyLine::friction) >= -1e-12);
  }
}

// It is pressed as long as the pusher brakes less than friction would, and stops with it.
TEST_CASE("driven, turning: a box is pushed over a floor", "[driven][turning]") {
  const double w = 0.2 * M_PI;
  const std::string text =
      fmt::format(
          "duration = 7\nframe = \"1/60\"\nG = {}\nfriction = 0.3\n"
          "[[body]]\nname = \"floor\"\nentity = \"wall\"\nshape = \"half-space\"\n"
          "[[body]]\nname = \"pusher\"\nentity = \"wall\"\nhalf_extents = [0.05, 0.05, 0.2]\n"
          "position = [-0.25, 0.11, 0]\nfriction = 0\n"
          "drive = {{frequency = 0.1, amplitude = [0.5, 0, 0], phase = "
          "-1.5707963267948966}}\n",
          g) +
      load("box", "half_extents = [0.2, 0.1, 0.2]", "position = [-0.5, 0.1, 0]");
  const Simulation sim = run(text);
  // -0.25 - 0.5 cos w t + 0.25
  for (const double t : {0.5, 2.0, 4.9, 6.5}) {
    CAPTURE(t);
    const BodyState box = sim.trajectory.at(2, Instant{} + t);
    CHECK(std::abs(box.pose.position.x() - -0.5 * std::cos(w * std::min(t, 5.0))) <= 1e-8);
    CHECK(box.twist.angular.norm() <= 1e-9);
  }
  // Friction is of all the weight, over 1 m.
  CHECK(std::abs(sim.result.ledger.line(EnergyLine::friction) + 0.3 * g) <= 1e-7);
  CHECK(std::abs(sim.result.ledger.line(EnergyLine::driven_work) - 0.3 * g) <= 1e-7);
}

// A box stands while the table is accelerated by less than g width / height.
TEST_CASE("driven, turning: a table that shakes tips a tall box", "[driven][turning]") {
  const double w = 2.0 * M_PI;
  const double tips = g * 0.05 / 0.3;
  for (const double share : {0.98, 1.02}) {
    CAPTURE(share);
    const double amplitude = share * tips / (w * w);
    // Sine: no acceleration at first, and the box has the velocity of the table.
    const std::string text = on_table(
        0.3, 0.9, fmt::format("drive = {{frequency = 1, amplitude = [{:.17g}, 0, 0]}}", amplitude),
        load("box", "half_extents = [0.05, 0.3, 0.05]",
             fmt::format("position = [0, 0.3, 0]\nvelocity = [{:.17g}, 0, 0]", w * amplitude)));
    const Simulation sim = run(text);
    const double begins = share > 1.0 ? std::asin(1.0 / share) / w : 0.0;
    const auto spin = [&](double t) {
      return sim.trajectory.at(1, Instant{} + t).twist.angular.norm();
    };
    if (share > 1.0) {
      CHECK(spin(begins - 1e-6) <= 1e-12);
      CHECK(spin(begins + 0.01) > 1e-5);
    } else {
      CHECK(spin(0.25) <= 1e-12);
    }
  }
}

// What happens on a table that goes straight on is what happens on one at rest: exact steps are as
// exact there; implicit ones, in which a box that has fallen comes to rest, are of first order and
// begin elsewhere.
TEST_CASE("driven, turning: nothing tells that a table goes straight on", "[driven][turning]") {
  const Vector3 velocity(0.7, 0.3, -0.4);
  const std::string shapes[] = {
      "half_extents = [0.1, 0.2, 0.15]\naxis_angle = [1, 0.5, 2, 0.7]\nposition = [0, 0.5, 0]",
      "shape = \"capsule\"\nradius = 0.1\nlength = 0.4\naxis_angle = [1, 0, 0.2, 0.8]\n"
      "position = [0, 0.5, 0]",
      "shape = \"sphere\"\nradius = 0.1\nposition = [0, 0.1, 0]",
  };
  for (const std::string& shape : shapes) {
    CAPTURE(shape);
    const auto moving = [&](const Vector3& along) {
      const Vector3 v = Vector3(0.5, 0.0, 0.2) + along;
      return on_table(
          1.0, 0.4, "",
          load("body", shape,
               fmt::format("velocity = [{:.17g}, {:.17g}, {:.17g}]", v.x(), v.y(), v.z())));
    };
    const Simulation there = run(moving(velocity), velocity, 0.0);
    const Simulation here = run(moving(Vector3::Zero()));
    for (const double t : {0.2, 0.5, 0.8, 1.0}) {
      CAPTURE(t);
      const BodyState seen = there.trajectory.at(1, Instant{} + t);
      const BodyState known = here.trajectory.at(1, Instant{} + t);
      const double off = t <= 0.2 ? 1e-8 : 2e-6;
      CHECK((seen.pose.position - t * velocity - known.pose.position).norm() <= off);
      if (shape.find("sphere") == std::string::npos) {  // how a ball is turned is not followed
        CHECK((seen.pose.orientation.toRotationMatrix() - known.pose.orientation.toRotationMatrix())
                  .norm() <= 20.0 * off);
      }
    }
  }
}

// Found by an attack: bodies that fall on a slab that is driven.
TEST_CASE("driven, turning: what was attacked", "[driven][turning]") {
  const auto slab = [](double duration, const std::string& mu, const std::string& floor,
                       const std::string& drive) {
    return fmt::format(
        "duration = {}\nframe = \"1/60\"\nG = {}\nfriction = {}\n"
        "[[body]]\nname = \"floor\"\nentity = \"wall\"\nshape = \"half-space\"\n{}\n"
        "[[body]]\nname = \"slab\"\nentity = \"wall\"\nhalf_extents = [0.5, 0.1, 0.5]\n"
        "position = [0, 0.45, 0]\n{}\n",
        duration, g, mu, floor, drive);
  };
  // Struck on the slab by another, it strikes the slab where that is then. It was taken where it
  // was when it was last asked: 3 mm off.
  const Simulation struck =
      run(slab(0.5, "1", "",
               "axis_angle = [1, 0, 0.3, -0.117753]\n"
               "drive = {frequency = 1, amplitude = [-0.0589177, 0.0423037, 0.0912592], "
               "rotation_axis = [0, 1, 0], rotation_amplitude = 0.121348}") +
          load("ball", "shape = \"sphere\"\nradius = 0.105553",
               "orientation = [-0.40521911368253016, 0.23083527542691717, -0.1255728961531995, "
               "0.8756391912635145]\nposition = [0.0104514, 1, -0.140497]\n"
               "velocity = [0.828836, 0, -0.348854]\nangular_velocity = [-2.58692, 0, 2.47731]") +
          "[[body]]\nname = \"can\"\nentity = \"body\"\nshape = \"cylinder\"\nradius = 0.1\n"
          "length = 0.3\nmass = 0.01\nrestitution = 0\nposition = [0.0748969, 1.7, 0.0251102]\n"
          "velocity = [0.813613, 0, -0.630799]\nangular_velocity = [1.36776, -2.40467, 0]\n");
  int on_slab = 0;
  for (const Event& event : struck.trajectory.events()) {
    if (event.kind == EventKind::impact) {
      CHECK(std::abs(event.contact.gap) <= 1e-9);
      on_slab += event.a == 1 || event.b == 1 ? 1 : 0;
    }
  }
  CHECK(on_slab >= 2);
  // A capsule across the rim of the slab: held there in two places side by side its far end turned
  // through the slab.
  (void)run(
      slab(0.5605, "0", "normal = [-0.070206, 1, 0]",
           "axis_angle = [1, 0, 0.3, 0.0726003]\n"
           "drive = {frequency = 0.3, amplitude = [0.0591773, 0, -0.0690652]}") +
      "[[body]]\nname = \"light\"\nentity = \"body\"\nshape = \"capsule\"\nradius = 0.05943\n"
      "length = 0.355067\nmass = 0.01\nrestitution = 0.3\n"
      "orientation = [0.23097963363141424, 0.8161249474196749, -0.3304258760182206, "
      "0.4140135499042537]\nposition = [0.190606, 1, 0.118989]\n"
      "velocity = [-0.81542, 0, 0.22947]\nangular_velocity = [0, 1.76187, 2.29944]\n"
      "[[body]]\nname = \"heavy\"\nentity = \"body\"\nshape = \"capsule\"\nradius = 0.125937\n"
      "length = 0.172117\nmass = 1\nrestitution = 0.3\n"
      "orientation = [-0.19021193991876628, 0.28546388827326735, 0.9370642641184376, "
      "-0.06511797997802425]\nposition = [-0.170409, 1.7, -0.0626175]\n"
      "velocity = [-0.0467471, 0, -0.976037]\n"
      "angular_velocity = [-0.821461, -0.149074, 1.03021]\n");
  // Rough, and shaken until nothing presses it: what a step took for smooth stuck at its end, and
  // 0.1 J went there.
  const Simulation rough =
      run(slab(0.33, "inf", "normal = [0.243426, 1, 0]",
               "drive = {frequency = 5, amplitude = [-0.0390788, 0, 0.0192256]}") +
          load("capsule", "shape = \"capsule\"\nradius = 0.0832045\nlength = 0.379865",
               "orientation = [0.29351500881791825, -0.4196314339856804, -0.8589285276984235, "
               "-0.00042838715827446137]\nposition = [0.169038, 1, 0.163943]\n"
               "velocity = [-0.278298, 0, -0.707713]\nangular_velocity = [0, 0, 2.20077]"));
  CHECK(std::abs(rough.result.ledger.line(EnergyLine::truncation)) <= 1e-6);
  // Rough, and lifted off by what holds it along the surface: it slides then, hardly pressed.
  // Forces of steps were those of longer ones, and what parted counted as what sticks: 0.5 J.
  const std::string shaken =
      slab(0.6, "inf", "normal = [-0.047021, 1, 0]",
           "axis_angle = [1, 0, 0.3, 0.133957]\n"
           "drive = {frequency = 5, amplitude = [0.0631309, -0.0333425, 0]}") +
      load("heavy", "shape = \"capsule\"\nradius = 0.0957665\nlength = 0.122172",
           "orientation = [-0.012060608492570079, -0.7254044435983056, -0.28385299974480793, "
           "0.6269532753455362]\nposition = [-0.105377, 1, 0.168072]\n"
           "velocity = [0.87513, 0, -0.9378]\nangular_velocity = [-0.425885, 1.52327, 1.65111]");
  (void)run(shaken);
}

// The plank and the slab part within a step that the slab's motion ends, and the plank stays on the
// post: that it was to go on then was forgotten, and it turned into the slab, by 10 mm.
TEST_CASE("driven, turning: a plank turns on while what carried it falls away",
          "[driven][turning]") {
  for (const double at : {0.181, 0.25}) {
    const std::string scene = fmt::format(
        "duration = 0.6\nframe = \"1/60\"\nG = {}\nfriction = 0.6\n"
        "[[body]]\nname = \"post\"\nentity = \"wall\"\nhalf_extents = [0.05, 0.2, 0.3]\n"
        "position = [0, 0.2, 0]\n"
        "[[body]]\nname = \"slab\"\nentity = \"wall\"\nhalf_extents = [0.2, 0.1, 0.3]\n"
        "position = [0.5, 0.231, 0]\ndrive = {{frequency = 4, amplitude = [0, 0.0242, 0]}}\n"
        "[[body]]\nname = \"plank\"\nentity = \"body\"\nhalf_extents = [0.5, 0.02, 0.1]\n"
        "mass = 2\nrestitution = 0\nposition = [{}, 0.42, 0]\n",
        g, at);
    (void)run(scene);
  }
}

// Implicit steps are of second order where something drives: 0.1 J of 670 J went in steps of first.
TEST_CASE("driven, turning: what steps cost where a table is shaken hard", "[driven][turning]") {
  const std::string scene =
      fmt::format(
          "duration = 1.5\nframe = \"1/60\"\nG = {}\nfriction = 1\n"
          "[[body]]\nname = \"slab\"\nentity = \"wall\"\n"
          "half_extents = [0.5, 0.1, 0.5]\nposition = [0, 0.45, 0]\n"
          "axis_angle = [1, 0, 0.3, -0.0405907]\n"
          "drive = {{frequency = 5, amplitude = [0.0280816, 0, -0.087126]}}\n",
          g) +
      load("capsule", "shape = \"capsule\"\nradius = 0.0891871\nlength = 0.126537",
           "orientation = [0.27173793770008137, 0.5773512228624255, 0.3465834082003757, "
           "-0.6875347262749574]\nposition = [-0.0861524, 1, 0.19283]\n"
           "velocity = [0.322898, 0, 0.0567614]\nangular_velocity = [-1.20865, 0, 0.18949]");
  (void)run(scene);
}
