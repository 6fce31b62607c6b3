#include "core/periodic_box.hpp"

#include "core/error.hpp"
#include "core/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

constexpr const char* axis_names[] = {"x", "y", "z"};

/// Complaints about a body, as a scene file names its keys.
class PeriodicCheck {
 public:
  PeriodicCheck(const Scene& scene, const PeriodicBox& box) : scene_(scene), box_(box) {}

  void box() const {
    for (int k = 0; k < 3; ++k) {
      const double side = box_.highest[k] - box_.lowest[k];
      if (repeats(k) && !(side > 0.0 && std::isfinite(side))) {
        throw InputError(scene_.path, 0, "periodic.max", "must be above min along its axes");
      }
    }
  }

  void body(const Body& b) const {
    need(b, !b.entity->is_field(), "entity", "is a field, which ends where it is written");
    need(b, b.drive == nullptr, "drive", "moves one image of it");
    const Shape shape = b.collision_shape();
    if (const auto* plane = std::get_if<HalfSpace>(&shape)) {
      return this->plane(b, *plane);
    }
    const Vector3& p = b.initial.pose.position;
    for (int k = 0; k < 3; ++k) {
      need(b, !repeats(k) || (p[k] >= box_.lowest[k] && p[k] <= box_.highest[k]), "position",
           fmt::format("{} = {} m is not within the box; allowed: {} to {}", axis_names[k], p[k],
                       box_.lowest[k], box_.highest[k]));
    }
    const bool falls = b.entity->mobility() == Mobility::free && b.G != 0.0 &&
                       !b.entity->gravity_direction().isZero(0.0);
    need(b, !falls || !repeats(1), "G",
         "lets it fall for ever along y; allowed: 0, or axes = [\"x\", \"z\"]");
  }

  /// No body may touch two images of another at once: contact is sought with the nearest alone.
  void room() const {
    double first = 0.0;
    double second = 0.0;
    const Body* largest = nullptr;
    for (const Body& b : scene_.bodies) {
      const double radius = bounding_radius(b.collision_shape());
      if (!std::isfinite(radius)) {
        continue;
      }
      if (radius > first) {
        second = std::exchange(first, radius);
        largest = &b;
      } else {
        second = std::max(second, radius);
      }
    }
    constexpr double more = 1.0 + 1e-6;  // room for the gap that two may have in touch
    for (int k = 0; k < 3; ++k) {
      const double side = box_.highest[k] - box_.lowest[k];
      if (repeats(k) && !(side > 2.0 * more * (first + second))) {
        throw InputError(scene_.path, 0, "periodic.max",
                         fmt::format("the box is {} m wide along {}, which is too narrow for "
                                     "\"{}\": it could meet two images of one body at once; "
                                     "allowed: more than {} m",
                                     side, axis_names[k], largest->name, 2.0 * (first + second)));
      }
    }
  }

 private:
  [[nodiscard]] bool repeats(int k) const { return box_.along[static_cast<std::size_t>(k)]; }
  void need(const Body& b, bool holds, const char* key, const std::string& reason) const {
    if (!holds) {
      throw InputError(scene_.path, b.line, fmt::format("body.{}.{}", b.name, key),
                       fmt::format("{} (the scene is periodic)", reason));
    }
  }
  void plane(const Body& b, const HalfSpace& plane) const {
    constexpr double roundoff = 1e-12;  // rounding error of a normal that was turned
    const Vector3 normal = half_space_normal(plane, b.initial.pose);
    for (int k = 0; k < 3; ++k) {
      need(b, !repeats(k) || std::abs(normal[k]) <= roundoff, "normal",
           fmt::format("a half-space is not the same one box on along {}; allowed: a normal "
                       "across the axes that repeat",
                       axis_names[k]));
    }
  }

  const Scene& scene_;
  const PeriodicBox& box_;
};

}  // namespace

Vector3 PeriodicBox::period() const {
  Vector3 result = Vector3::Zero();
  for (int k = 0; k < 3; ++k) {
    result[k] = along[static_cast<std::size_t>(k)] ? highest[k] - lowest[k] : 0.0;
  }
  return result;
}

Vector3 PeriodicBox::shift(const Image& n) const {
  return period().cwiseProduct(
      Vector3(static_cast<double>(n[0]), static_cast<double>(n[1]), static_cast<double>(n[2])));
}

Image PeriodicBox::nearest(const Vector3& d) const {
  Image n{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    if (along[k]) {
      n[k] = static_cast<std::int32_t>(-std::round(d[axis] / (highest[axis] - lowest[axis])));
    }
  }
  return n;
}

Vector3 PeriodicBox::wrapped(const Vector3& p) const {
  Vector3 result = p;
  for (int k = 0; k < 3; ++k) {
    if (along[static_cast<std::size_t>(k)]) {
      const double side = highest[k] - lowest[k];
      result[k] -= side * std::floor((p[k] - lowest[k]) / side);
    }
  }
  return result;
}

void check_periodic(const Scene& scene) {
  if (!scene.periodic) {
    return;
  }
  const PeriodicCheck check(scene, *scene.periodic);
  check.box();
  for (const Body& body : scene.bodies) {
    check.body(body);
  }
  check.room();
  for (const SceneForce& force : scene.forces) {
    if (!force.bodies.empty() && !force.force->uniform()) {
      throw InputError(scene.path, 0, "force",
                       "depends on where bodies are or how they move, of which a periodic scene "
                       "knows nothing; allowed: uniform forces");
    }
  }
  if (!scene.joints.empty()) {
    throw InputError(scene.path, 0, "joint",
                     "holds one image of a body to one of another, of which a periodic scene "
                     "knows nothing; allowed: a scene without joints");
  }
}

}  // namespace core
}  // namespace kairos
