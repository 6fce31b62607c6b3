#include "core/scene_check.hpp"

#include "core/error.hpp"
#include "core/joint_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace kairos {
inline namespace core {
namespace {

/// Checks of one body; each names the key as a scene file would.
class BodyCheck {
 public:
  BodyCheck(const Scene& scene, const Body& body) : scene_(scene), body_(body) {}

  void run() const {
    need(body_.entity != nullptr, "entity", "is missing");
    check_shape();
    check_state();
    need(std::isfinite(body_.G), "G", "must be finite");
    need(body_.restitution >= 0.0 && body_.restitution <= 1.0, "restitution",
         "must be from 0 to 1");
    need(body_.friction >= 0.0, "friction", "must be >= 0, or infinite");
    need(body_.scale > 0.0 && std::isfinite(body_.scale), "scale", "must be > 0 and finite");
    need(is_unit(body_.normal_B.norm()), "normal", "must be a unit vector");
    check_mobility();
  }

 private:
  void need(bool holds, const char* key, const std::string& reason) const {
    if (!holds) {
      throw InputError(scene_.path, body_.line, fmt::format("body.{}.{}", body_.name, key), reason);
    }
  }

  /// To roundoff: readers and drives normalise exactly.
  static bool is_unit(double norm) { return std::abs(norm - 1.0) <= 1e-12; }
  static bool positive(double x) { return x > 0.0 && std::isfinite(x); }

  void check_shape() const {
    if (const auto* sphere = std::get_if<Sphere>(&body_.shape)) {
      need(positive(sphere->radius), "radius", "must be > 0 and finite");
    }
    if (const auto* box = std::get_if<Box>(&body_.shape)) {
      need((box->half_extents.array() > 0.0).all() && box->half_extents.allFinite(), "half_extents",
           "must all be > 0 and finite");
    }
    if (const auto* capsule = std::get_if<Capsule>(&body_.shape)) {
      need(positive(capsule->radius), "radius", "must be > 0 and finite");
      need(positive(capsule->length), "length", "must be > 0 and finite");
    }
    if (const auto* cylinder = std::get_if<Cylinder>(&body_.shape)) {
      need(positive(cylinder->radius), "radius", "must be > 0 and finite");
      need(positive(cylinder->length), "length", "must be > 0 and finite");
    }
    if (const auto* cone = std::get_if<Cone>(&body_.shape)) {
      need(positive(cone->radius), "radius", "must be > 0 and finite");
      need(positive(cone->height), "height", "must be > 0 and finite");
    }
    if (const auto* mesh = std::get_if<Mesh>(&body_.shape)) {
      need(mesh->body != nullptr, "file", "is missing");
    }
    if (const auto* compound = std::get_if<Compound>(&body_.shape)) {
      need(compound->body != nullptr, "part", "is missing");
    }
    if (const auto* hull = std::get_if<Hull>(&body_.shape)) {
      need(hull->core != nullptr, "points", "are missing");
      need(hull->rounding >= 0.0 && std::isfinite(hull->rounding), "rounding",
           "must be >= 0 and finite");
    }
  }

  void check_state() const {
    const BodyState& s = body_.initial;
    need(s.pose.position.allFinite(), "position", "must be finite");
    need(is_unit(s.pose.orientation.norm()), "orientation", "must be a unit quaternion");
    need(s.twist.linear.allFinite(), "velocity", "must be finite");
    need(s.twist.angular.allFinite(), "angular_velocity", "must be finite");
  }

  void check_mobility() const {
    const Mobility mobility = body_.entity->mobility();
    const bool is_free = mobility == Mobility::free;
    need(!is_free || positive(body_.mass), "mass", "must be > 0 and finite: the body moves freely");
    need(!is_free || ((body_.inertia.array() > 0.0).all() && body_.inertia.allFinite()), "inertia",
         "must be > 0 and finite: the body moves freely");
    need(!is_free || !std::holds_alternative<HalfSpace>(body_.shape), "shape",
         "a half-space cannot move freely");
    need(!is_free || body_.drive == nullptr, "drive", "the body moves freely");
    need(mobility != Mobility::driven || body_.drive != nullptr, "drive",
         fmt::format("is missing; a {} needs to be driven", body_.entity->kind()));
    if (body_.entity->is_hand()) {
      check_hand();
    }
  }

  void check_hand() const {
    need(body_.drive->has_gestures(), "drive", "has no gestures");
    const auto held = std::find_if(scene_.bodies.begin(), scene_.bodies.end(),
                                   [this](const Body& b) { return b.name == body_.holds; });
    need(held != scene_.bodies.end(), "holds",
         fmt::format("the scene has no \"{}\" to hold", body_.holds));
    need(held->entity->mobility() == Mobility::free, "holds",
         fmt::format("\"{}\" does not move freely; a hand holds only bodies that do", body_.holds));
    const auto others = std::count_if(scene_.bodies.begin(), scene_.bodies.end(),
                                      [this](const Body& b) { return b.holds == body_.holds; });
    need(others == 1, "holds",
         fmt::format("two hands hold \"{}\"; allowed: one hand for a body", body_.holds));
  }

  const Scene& scene_;
  const Body& body_;
};

void check_forces(const Scene& scene) {
  for (const SceneForce& force : scene.forces) {
    std::set<BodyIndex> seen;
    for (const BodyIndex i : force.bodies) {
      const bool known = i < scene.bodies.size() &&
                         scene.bodies[i].entity->mobility() == Mobility::free &&
                         seen.insert(i).second;
      if (!known) {
        throw InputError(scene.path, 0, "force",
                         "acts on a body that does not exist, is not free, or is named twice");
      }
    }
  }
}

void check_frames(const Scene& scene) {
  const auto positive = [](double x) { return x > 0.0 && std::isfinite(x); };
  const auto* listed = std::get_if<ListedFrames>(&scene.frames);
  const bool all_positive = listed == nullptr || std::all_of(listed->durations.begin(),
                                                             listed->durations.end(), positive);
  if (!all_positive || !positive(mean_frame_duration(scene.frames))) {
    throw InputError(scene.path, 0, "frame", "must be > 0 and finite");
  }
}

}  // namespace

void check_scene(const Scene& scene) {
  if (!(scene.duration > 0.0) || !std::isfinite(scene.duration)) {
    throw InputError(scene.path, 0, "duration", "must be > 0 and finite");
  }
  if (scene.bodies.empty()) {
    throw InputError(scene.path, 0, "body", "the scene is empty; needed: at least one body");
  }
  check_frames(scene);
  std::set<std::string> names;
  for (const Body& body : scene.bodies) {
    BodyCheck(scene, body).run();
    if (!names.insert(body.name).second) {
      throw InputError(scene.path, body.line, "body." + body.name + ".name",
                       "is there twice; allowed: each name once");
    }
  }
  check_forces(scene);
  check_joints(scene);
  check_periodic(scene);
}

}  // namespace core
}  // namespace kairos
