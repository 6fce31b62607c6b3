#include "core/drives/track.hpp"
#include "core/mesh_body.hpp"
#include "core/reading/mesh_file.hpp"
#include "experiments/bench/bench.hpp"
#include "experiments/processor_time.hpp"
#include "experiments/rally/rally_run.hpp"
#include "simulation/registry.hpp"
#include "simulation/scene_library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

namespace kairos::experiments {
namespace {

/// What the bat of a rally is: the scene's box, or a blade with a handle as one of its bounds.
struct Bat {
  const char* name;
  bool mesh;
  Bounds bounds;
};
constexpr std::array<Bat, 4> bats{{{"the scene's box", false, Bounds::shape},
                                   {"mesh, its box", true, Bounds::obb},
                                   {"mesh, its hull", true, Bounds::hull},
                                   {"mesh, itself", true, Bounds::shape}}};
/// The blade of meshes/bat.off, about the origin: half its width and height, m.
constexpr double blade_width = 0.075;
constexpr double blade_height = 0.08;

/// Counts what happens between bat and ball while no hand holds it.
class BatWatch : public Recorder {
 public:
  void begin(const Model& model) override {
    for (BodyIndex i = 0; i < model.size(); ++i) {
      if (model.body(i).name == "bat") {
        bat_ = i;
      } else if (model.body(i).name == "ball") {
        ball_ = i;
      }
    }
    held_ = true;  // until the hand opens for the first time
    seen_ = hit_ = false;
    shape_ = model.body(bat_).shape;
    // A ball that touches is not inside.
    ball_shape_ = Sphere{std::get<Sphere>(model.body(ball_).shape).radius * (1.0 - 1e-9)};
  }

  void event(const Event& event) override {
    if (event.kind == EventKind::grasped || event.kind == EventKind::released) {
      held_ = event.kind == EventKind::grasped;
      seen_ = false;
    } else if (event.kind == EventKind::impact && std::min(event.a, event.b) == bat_ &&
               std::max(event.a, event.b) == ball_) {
      ++hits;
      hit_ = true;
    }
  }

  void frame(const Frame& frame) override {
    if (held_) {
      return;
    }
    const Pose& bat = frame.bodies[bat_].pose;
    const Pose& ball = frame.bodies[ball_].pose;
    inside += detector_->overlaps(shape_, bat, ball_shape_, ball) ? 1 : 0;
    const Vector3 now = bat.to_body(ball.position);
    if (seen_ && !hit_ && (now.z() > 0.0) != (last_.z() > 0.0)) {
      const Vector3 at = last_ + (last_.z() / (last_.z() - now.z())) * (now - last_);
      const double x = at.x() / blade_width;
      const double y = at.y() / blade_height;
      passed += x * x + y * y < 1.0 ? 1 : 0;
    }
    seen_ = true;
    hit_ = false;
    last_ = now;
  }

  std::int64_t hits = 0;    ///< impacts
  std::int64_t inside = 0;  ///< frames with the ball in the bat, whatever that collides as
  std::int64_t passed = 0;  ///< frames between which it went through the blade without an impact

 private:
  BodyIndex bat_ = 0;
  BodyIndex ball_ = 0;
  Shape shape_ = Sphere{1.0};
  Shape ball_shape_ = Sphere{1.0};
  std::shared_ptr<const ContactDetector> detector_ = find_detector("certified");
  Vector3 last_ = Vector3::Zero();
  bool held_ = true;
  bool seen_ = false;
  bool hit_ = false;
};

void take_bat(Scene& scene, const RallyRecording& rally, const Shape& shape, Bounds bounds) {
  const auto bat = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                [](const Body& body) { return body.name == "bat"; });
  bat->shape = shape;
  bat->bounds = bounds;
  std::vector<TrackSample> samples = rally.bat.samples;
  for (TrackSample& sample : samples) {
    sample.pose.orientation.normalize();  // the files hold seven digits
  }
  const double reach = bounding_radius(bounding_box(shape));
  bat->drive = std::make_shared<const Track>(
      std::move(samples), Track::Options{.reach = reach, .gestures = rally.bat.gestures});
}

}  // namespace

void bench_bats(int rallies) {
  const std::filesystem::path file =
      std::filesystem::path(find_scene("table-tennis")).parent_path() / "meshes" / "bat.off";
  const Shape mesh = Mesh{mesh_in_place(read_mesh(file.string()).mesh, CollisionMesh::Kind::solid)};
  fmt::print(
      "{} rallies, event-driven, certified; the bat is a blade with a handle of {} triangles\n",
      rallies, std::get<Mesh>(mesh).body->mesh.triangles().size());
  fmt::print("{:<18}{:>8}{:>10}{:>10}{:>10}{:>12}\n", "the bat is", "hits", "inside", "passed",
             "stopped", "ms a rally");
  for (const Bat& bat : bats) {
    BatWatch watch;
    std::int64_t stopped = 0;
    double spent = 0.0;  // s, of the processor
    for (int r = 0; r < rallies; ++r) {
      const RallyRecording rally = make_rally({.seed = 1999 + static_cast<std::uint64_t>(r)});
      Scene scene = rally_scene(rally, {.name = "event-driven"});
      if (bat.mesh) {
        take_bat(scene, rally, mesh, bat.bounds);
      }
      const Model model(std::move(scene));
      const double start = processor_seconds();
      stopped += simulate(model, {}, watch).status == RunStatus::completed ? 0 : 1;
      spent += processor_seconds() - start;
    }
    fmt::print("{:<18}{:>8}{:>10}{:>10}{:>10}{:>12.2f}\n", bat.name, watch.hits, watch.inside,
               watch.passed, stopped, 1e3 * spent / rallies);
  }
}

}  // namespace kairos::experiments
