// Contact that lasts, of the shipped scenes, where nothing may change: in other units, moved,
// turned, mirrored.

#include "core/reading/scene_reader.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

using namespace kairos;

namespace {

struct Touching {
  std::string name;
  double duration;  ///< s
  bool turns;       ///< while it touches, which is integrated
};

/// Scenes that slide, roll, stick, tip and land.
const std::vector<Touching>& touching() {
  static const std::vector<Touching> scenes{{"incline", 0.5, false},    {"rolling", 1.0, false},
                                            {"groove", 2.0, false},     {"stack", 0.5, false},
                                            {"pyramid", 0.5, false},    {"ladder", 0.6, true},
                                            {"box-landing", 0.6, true}, {"dominoes", 0.4, true}};
  return scenes;
}

RunResult run(const Scene& scene, double duration, double frame) {
  RunChoice choice;
  choice.duration = duration;
  choice.frames = FixedFrames{frame};
  choice.stepper.absolute_tolerance = 0.0;  // the only length or time of the library
  Recorder nobody;
  return simulate(Model(scene), choice, nobody);
}

/// The scene in units of so many metres, seconds and kilograms.
Scene in_units(Scene scene, double length, double time, double mass) {
  for (Body& b : scene.bodies) {
    if (auto* const ball = std::get_if<Sphere>(&b.shape)) {
      ball->radius *= length;
    } else if (auto* const box = std::get_if<Box>(&b.shape)) {
      box->half_extents *= length;
    }
    b.initial.pose.position *= length;
    b.initial.twist.linear *= length / time;
    b.initial.twist.angular /= time;
    b.G *= length / (time * time);
    if (b.mass > 0.0) {
      b.mass *= mass;
      b.inertia *= mass * length * length;
    }
  }
  return scene;
}

/// p -> turn p + shift, and before that z -> -z where it is mirrored.
struct Place {
  Quaternion turn = Quaternion::Identity();
  Vector3 shift = Vector3::Zero();
  bool mirrored = false;

  [[nodiscard]] Vector3 vector(const Vector3& v) const {
    return turn * Vector3(v.x(), v.y(), mirrored ? -v.z() : v.z());
  }
  /// Angular velocities: a mirror turns them the other way round.
  [[nodiscard]] Vector3 axial(const Vector3& v) const {
    const double sign = mirrored ? -1.0 : 1.0;
    return turn * Vector3(sign * v.x(), sign * v.y(), v.z());
  }
  [[nodiscard]] BodyState operator()(const BodyState& s) const {
    const Quaternion& q = s.pose.orientation;
    const Quaternion seen = mirrored ? Quaternion(q.w(), -q.x(), -q.y(), q.z()) : Quaternion(q);
    return {{vector(s.pose.position) + shift, turn * seen},
            {vector(s.twist.linear), axial(s.twist.angular)}};
  }
  [[nodiscard]] Scene operator()(Scene scene) const {
    for (Body& b : scene.bodies) {
      if (auto* const plane = std::get_if<HalfSpace>(&b.shape)) {
        plane->normal_B = vector(plane->normal_B);
        b.initial.pose.position = vector(b.initial.pose.position) + shift;
      } else {
        b.initial = (*this)(b.initial);
      }
    }
    return scene;
  }
};

}  // namespace

TEST_CASE("lasting contact that does not turn is the same in units of powers of two, bit for bit",
          "[modes][friction][invariance]") {
  for (const auto& [name, duration, turns] : touching()) {
    if (turns) {
      continue;  // its integrator has an absolute tolerance, which has a unit
    }
    const Scene scene = read_scene(find_scene(name));
    const RunResult plain = run(scene, duration, 1.0 / 64.0);
    for (const auto& [length, time, mass] :
         {std::tuple{0x1p-10, 1.0, 1.0}, std::tuple{1.0, 4.0, 1.0}, std::tuple{1.0, 1.0, 0x1p7},
          std::tuple{8.0, 0.5, 0x1p-9}}) {
      CAPTURE(name, length, time, mass);
      const RunResult other =
          run(in_units(scene, length, time, mass), time * duration, time / 64.0);
      CHECK(other.status == plain.status);
      CHECK(other.end.seconds == time * plain.end.seconds);
      CHECK(other.cost.events == plain.cost.events);
      const double joule = mass * length * length / (time * time);
      CHECK(other.ledger.line(EnergyLine::friction) ==
            joule * plain.ledger.line(EnergyLine::friction));
      for (std::size_t i = 0; i < plain.state.size(); ++i) {
        CHECK(other.state[i].pose.position == length * plain.state[i].pose.position);
        CHECK(other.state[i].pose.orientation.coeffs() == plain.state[i].pose.orientation.coeffs());
        CHECK(other.state[i].twist.linear == length / time * plain.state[i].twist.linear);
        CHECK(other.state[i].twist.angular == plain.state[i].twist.angular / time);
      }
    }
  }
}

TEST_CASE("lasting contact moved, turned and mirrored is the same, to what steps are off",
          "[modes][friction][invariance]") {
  const auto about_y = [](double angle) {
    return Quaternion(Eigen::AngleAxisd(angle, Vector3::UnitY()));
  };
  const std::pair<const char*, Place> places[] = {
      {"moved", {Quaternion::Identity(), {4.0, -2.0, 1.0}, false}},
      {"turned by half", {Quaternion(0.0, 0.0, 1.0, 0.0), Vector3::Zero(), false}},
      {"turned by a quarter", {about_y(0.5 * M_PI), Vector3::Zero(), false}},
      {"turned", {about_y(0.7), Vector3::Zero(), false}},
      {"mirrored", {Quaternion::Identity(), Vector3::Zero(), true}}};
  for (const auto& [name, duration, turns] : touching()) {
    const Scene scene = read_scene(find_scene(name));
    const RunResult plain = run(scene, duration, 1.0 / 64.0);
    for (const auto& [what, place] : places) {
      CAPTURE(name, what, turns);
      const RunResult other = run(place(scene), duration, 1.0 / 64.0);
      CHECK(other.status == plain.status);
      double off = 0.0;
      for (std::size_t i = 0; i < plain.state.size(); ++i) {
        const BodyState expected = place(plain.state[i]);
        off = std::max(off, (other.state[i].pose.position - expected.pose.position).norm());
        off = std::max(off, (other.state[i].twist.linear - expected.twist.linear).norm());
        off = std::max(off, (other.state[i].twist.angular - expected.twist.angular).norm());
      }
      // Impacts of what tips multiply roundoff; steps are controlled to 1e-10.
      CHECK(off <= 1e-8);
    }
  }
}
