#include "core/reading/joint_reader.hpp"

#include "core/nearest_name.hpp"
#include "core/reading/scene_keys.hpp"
#include "core/reading/scene_limits.hpp"
#include "core/rotation_between.hpp"

#include <fmt/format.h>

namespace kairos {
inline namespace core {
namespace {

/// A `[[joint]]` while it is read.
struct Reading {
  const TableReader& table;
  const Scene& scene;
  Joint& joint;
};

/// Where a side is at t = 0; the world does not move.
Pose pose_of(const Scene& scene, const JointSide& side) {
  if (!side.body) {
    return {};
  }
  const Body& body = scene.bodies[*side.body];
  return body.drive != nullptr ? body.drive->motion(Instant{}, scene.duration).pose(0.0)
                               : body.initial.pose;
}

void read_sides(const Reading& reading) {
  std::vector<std::string_view> names;
  for (const Body& body : reading.scene.bodies) {
    names.push_back(body.name);
  }
  const Item item = reading.table.need("bodies", "one body (the other side is the world), or two");
  const Array& array = item.array();
  if (array.empty() || array.size() > 2) {
    item.fail(fmt::format("names {} bodies; allowed: 1 (the other side is the world) or 2",
                          array.size()));
  }
  const auto side = [&](std::size_t k) {
    return Item(array[k], fmt::format("{}[{}]", item.path(), k)).choice(names);
  };
  reading.joint.a.body = side(0);
  if (array.size() == 2) {
    reading.joint.b.body = side(1);
    if (reading.joint.a.body == reading.joint.b.body) {
      item.fail(fmt::format("\"{}\" is named twice; allowed: two different bodies",
                            names[*reading.joint.a.body]));
    }
  }
}

/// From a point of the first body to one of the second, or to an anchor in the world.
void read_rod_points(const Reading& reading) {
  const TableReader& table = reading.table;
  Joint& joint = reading.joint;
  const auto point = [&](std::string_view key) {
    const auto item = table.find(key);
    return item ? item->vector(limits::position) : Vector3(Vector3::Zero());
  };
  joint.a.point = point("point_a");
  if (joint.b.body) {
    if (table.has("anchor")) {
      table.fail("anchor", "two bodies are given too; allowed: point_a and point_b");
    }
    joint.b.point = point("point_b");
  } else {
    joint.b.point =
        table.need("anchor", "a point of the world (m), or a second body").vector(limits::position);
  }
}

/// Of each side the point that is its own, or where the anchor is at t = 0.
void read_points(const Reading& reading) {
  const TableReader& table = reading.table;
  Joint& joint = reading.joint;
  const bool both = table.has("point_a") && table.has("point_b");
  if (both && table.has("anchor")) {
    table.fail("anchor", "both points are given too; allowed: two of anchor, point_a, point_b");
  }
  // A weld does the same wherever it is.
  const bool anywhere =
      joint.kind == JointKind::weld && !table.has("point_a") && !table.has("point_b");
  Vector3 at = pose_of(reading.scene, joint.a).position;
  if (table.has("anchor") || !(both || anywhere)) {
    at = table
             .need("anchor", joint.b.body ? "a point of the world at t = 0 (m), or both points"
                                          : "a point of the world (m)")
             .vector(limits::position);
  }
  const auto point = [&](std::string_view key, const JointSide& side) {
    const auto own = table.find(key);
    return own ? own->vector(limits::position) : pose_of(reading.scene, side).to_body(at);
  };
  joint.a.point = point("point_a", joint.a);
  joint.b.point = point("point_b", joint.b);
}

/// The frame of the joint, alike for both sides at t = 0: its x axis is `axis`.
void read_axis(const Reading& reading) {
  Quaternion frame = Quaternion::Identity();
  if (reading.joint.kind == JointKind::hinge || reading.joint.kind == JointKind::slider) {
    const Item item = reading.table.need("axis", "a direction of the world at t = 0");
    const Vector3 axis = item.vector(limits::component);
    if (axis.isZero(0.0)) {
      item.fail("is [0, 0, 0]; allowed: a direction, of any length");
    }
    frame = rotation_between(Vector3::UnitX(), axis.normalized()).normalized();
  }
  for (JointSide* side : {&reading.joint.a, &reading.joint.b}) {
    side->frame = (pose_of(reading.scene, *side).orientation.conjugate() * frame).normalized();
  }
}

void read_length(const Reading& reading) {
  Joint& joint = reading.joint;
  if (const auto length = reading.table.find("length")) {
    joint.length = length->number(limits::extent);
    return;
  }
  joint.length = (pose_of(reading.scene, joint.b).to_world(joint.b.point) -
                  pose_of(reading.scene, joint.a).to_world(joint.a.point))
                     .norm();
  if (!(joint.length >= limits::extent.lowest)) {
    reading.table.fail("", "its two points are in one place; allowed: apart, or a ball joint");
  }
}

}  // namespace

void read_joint(const Item& item, Scene& scene) {
  const TableReader table(item);
  Joint joint;
  joint.line = item.value().line;
  joint.kind = static_cast<JointKind>(
      table.need("kind", "one of " + listed(joint_kind_names)).choice(joint_kind_names));
  std::vector<std::string_view> known = scene_keys_of("joint");
  for (const std::string_view key : scene_keys_of("joint." + std::string(to_string(joint.kind)))) {
    known.push_back(key);
  }
  table.refuse_unknown(known);
  if (const auto name = table.find("name")) {
    joint.name = name->text();
  }
  if (const auto collide = table.find("collide")) {
    joint.collide = collide->flag();
  }
  const Reading reading{table, scene, joint};
  read_sides(reading);
  if (table.has("point_b") && !joint.b.body) {
    table.fail("point_b", "there is one body only; allowed: anchor, a point of the world");
  }
  if (joint.kind == JointKind::rod) {
    read_rod_points(reading);
    read_length(reading);
  } else {
    read_points(reading);
  }
  read_axis(reading);
  scene.joints.push_back(std::move(joint));
}

}  // namespace core
}  // namespace kairos
