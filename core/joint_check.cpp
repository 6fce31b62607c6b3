#include "core/joint_check.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kairos {
inline namespace core {
namespace {

class JointCheck {
 public:
  JointCheck(const Scene& scene, std::size_t index)
      : scene_(scene),
        joint_(scene.joints[index]),
        path_(joint_.name.empty() ? fmt::format("joint[{}]", index) : "joint." + joint_.name) {}

  void run() const {
    check_sides();
    check_drives();
    check_assembly();
  }

 private:
  [[noreturn]] void fail(std::string_view key, const std::string& reason) const {
    throw InputError(scene_.path, joint_.line, fmt::format("{}.{}", path_, key), reason);
  }
  void need(bool holds, std::string_view key, const std::string& reason) const {
    if (!holds) {
      fail(key, reason);
    }
  }
  [[nodiscard]] const Body* body(const JointSide& side) const {
    return side.body ? &scene_.bodies[*side.body] : nullptr;
  }
  [[nodiscard]] bool is_free(const JointSide& side) const {
    return side.body && body(side)->entity->mobility() == Mobility::free;
  }

  void check_sides() const {
    for (const JointSide* side : {&joint_.a, &joint_.b}) {
      need(!side->body || *side->body < scene_.bodies.size(), "bodies",
           "names no body of the scene");
      need(side->point.allFinite(), "anchor", "must be finite");
      need(std::abs(side->frame.norm() - 1.0) <= 1e-12, "axis", "must be a unit quaternion's");
    }
    need(!joint_.a.body || joint_.a.body != joint_.b.body, "bodies", "names a body twice");
    need(is_free(joint_.a) || is_free(joint_.b), "bodies",
         "none of them can move; a joint needs at least one body that moves freely");
    need(joint_.kind != JointKind::rod || (joint_.length > 0.0 && std::isfinite(joint_.length)),
         "length", "must be > 0 and finite (m)");
    for (const JointSide* side : {&joint_.a, &joint_.b}) {
      if (is_free(*side) && !body(*side)->entity->rotates() && turns(joint_, *side)) {
        fail("bodies",
             fmt::format("this {} turns what it holds, and \"{}\", a {}, does not turn; "
                         "allowed: the entity \"body\", or a rod or ball joint at its "
                         "centre",
                         to_string(joint_.kind), body(*side)->name, body(*side)->entity->kind()));
      }
    }
  }

  void check_drives() const {
    for (const JointSide* side : {&joint_.a, &joint_.b}) {
      if (side->body && body(*side)->drive != nullptr) {
        need(body(*side)->drive->smooth(), "bodies",
             fmt::format(
                 "the velocity of \"{}\" jumps ({}), and a body that hangs on it would be torn "
                 "along; allowed: a drive without jumps, such as a sinusoid",
                 body(*side)->name, body(*side)->drive->description()));
      }
    }
  }

  [[nodiscard]] JointEnd end(const JointSide& side) const {
    const Body* b = body(side);
    if (b == nullptr) {
      return {};
    }
    if (b->drive != nullptr) {
      const Motion motion = b->drive->motion(Instant{}, scene_.duration);
      return {motion.pose(0.0), motion.twist(0.0), {}};
    }
    return {b->initial.pose, is_free(side) ? b->initial.twist : Twist{}, {}};
  }

  /// A speed that a driven side reaches soon, m/s: at a turning point its own is roundoff of that.
  [[nodiscard]] double reached(const JointSide& side, double size) const {
    if (!side.body || body(side)->drive == nullptr) {
      return 0.0;
    }
    const Motion motion = body(side)->drive->motion(Instant{}, scene_.duration);
    return motion.speed_bound(0.0, motion.duration) +
           size * motion.angular_speed_bound(0.0, motion.duration);
  }

  void check_assembly() const {
    const JointEnd a = end(joint_.a);
    const JointEnd b = end(joint_.b);
    const Vector3 point_a = a.pose.to_world(joint_.a.point);
    const Vector3 point_b = b.pose.to_world(joint_.b.point);
    const double size =
        std::max({joint_.length, joint_.a.body ? joint_.a.point.norm() : 0.0,
                  joint_.b.body ? joint_.b.point.norm() : 0.0, reach(joint_.a), reach(joint_.b)});
    if (joint_.kind == JointKind::rod) {
      const double apart = (point_b - point_a).norm();
      need(std::abs(apart - joint_.length) <= assembly_tolerance * size, "length",
           fmt::format("is {} m, and at t = 0 its points are {} m apart; allowed: their "
                       "distance, or no length",
                       joint_.length, apart));
    }
    std::array<JointRow, most_joint_rows> rows;
    const std::size_t count = row_count(joint_.kind);
    joint_rows(joint_, a, b, std::span(rows).first(count));
    double residual = 0.0;
    double rate = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      const double length = rows[k].turns_only ? size : 1.0;
      residual = std::max(residual, length * std::abs(rows[k].residual));
      rate = std::max(rate, length * std::abs(rows[k].rate(a.twist, b.twist)));
    }
    need(residual <= assembly_tolerance * size, "bodies",
         fmt::format("cannot be put together: at t = 0 its two sides are {:.6g} m off what a {} "
                     "allows; allowed: {:.3g} m",
                     residual, to_string(joint_.kind), assembly_tolerance * size));
    const double speed = std::max(a.twist.linear.norm() + b.twist.linear.norm() +
                                      size * (a.twist.angular.norm() + b.twist.angular.norm()),
                                  reached(joint_.a, size) + reached(joint_.b, size));
    need(rate <= assembly_tolerance * speed, "bodies",
         fmt::format("part at {:.6g} m/s at t = 0, which a {} does not allow: velocity and "
                     "angular_velocity of its bodies must fit each other (to {:.3g} m/s)",
                     rate, to_string(joint_.kind), assembly_tolerance * speed));
  }

  [[nodiscard]] double reach(const JointSide& side) const {
    return is_free(side) ? bounding_radius(body(side)->shape) : 0.0;
  }

  const Scene& scene_;
  const Joint& joint_;
  std::string path_;
};

}  // namespace

void check_joints(const Scene& scene) {
  for (std::size_t k = 0; k < scene.joints.size(); ++k) {
    JointCheck(scene, k).run();
  }
}

}  // namespace core
}  // namespace kairos
