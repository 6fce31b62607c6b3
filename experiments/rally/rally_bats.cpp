#include "experiments/rally/rally_bats.hpp"

#include "core/drives/track.hpp"
#include "core/mesh_body.hpp"
#include "core/model.hpp"
#include "core/reading/mesh_file.hpp"
#include "simulation/registry.hpp"
#include "simulation/scene_library.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace kairos::experiments {
namespace {

/// The blade of meshes/bat.off, about the origin: half its width and height, m.
constexpr double blade_width = 0.075;
constexpr double blade_height = 0.08;
/// Differences that no player sees, m.
constexpr double unseen = 1e-4;

}  // namespace

Shape bat_mesh() {
  const std::filesystem::path file =
      std::filesystem::path(find_scene("table-tennis")).parent_path() / "meshes" / "bat.off";
  return Mesh{mesh_in_place(read_mesh(file.string()).mesh, CollisionMesh::Kind::solid)};
}

void take_bat(Scene& scene, const RallyRecording& rally, const Shape& mesh, Bounds bounds) {
  const auto bat = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                [](const Body& body) { return body.name == "bat"; });
  bat->shape = mesh;
  bat->bounds = bounds;
  std::vector<TrackSample> samples = rally.bat.samples;
  for (TrackSample& sample : samples) {
    sample.pose.orientation.normalize();  // the files hold seven digits
  }
  const double reach = bounding_radius(bounding_box(mesh));
  bat->drive = std::make_shared<const Track>(
      std::move(samples), Track::Options{.reach = reach, .gestures = rally.bat.gestures});
}

BatWatch::BatWatch(Shape mesh)
    : seen_bat_(std::move(mesh)), detector_(find_detector("certified")) {}

void BatWatch::begin(const Model& model) {
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
  ball_shape_ = model.body(ball_).shape;
  inner_ball_ = Sphere{std::get<Sphere>(ball_shape_).radius * (1.0 - 1e-9)};
}

void BatWatch::event(const Event& event) {
  if (event.kind == EventKind::grasped || event.kind == EventKind::released) {
    held_ = event.kind == EventKind::grasped;
    seen_ = false;
  } else if (event.kind == EventKind::impact && std::min(event.a, event.b) == bat_ &&
             std::max(event.a, event.b) == ball_) {
    ++hits;
    hit_ = true;
    const bool bat_first = event.a == bat_;
    const Pose& bat = (bat_first ? event.before_a : event.before_b).pose;
    const Pose& ball = (bat_first ? event.before_b : event.before_a).pose;
    const double gap = std::max(0.0, detector_->overlap(seen_bat_, bat, ball_shape_, ball).gap);
    early += gap > unseen ? 1 : 0;
    farthest = std::max(farthest, gap);
    sum_of_gaps += gap;
  }
}

void BatWatch::frame(const Frame& frame) {
  if (held_) {
    return;
  }
  const Pose& bat = frame.bodies[bat_].pose;
  const Pose& ball = frame.bodies[ball_].pose;
  inside += detector_->overlaps(shape_, bat, inner_ball_, ball) ? 1 : 0;
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

}  // namespace kairos::experiments
