#include "core/reading/body_reader.hpp"

#include "core/mesh_body.hpp"
#include "core/nearest_name.hpp"
#include "core/reading/drive_reader.hpp"
#include "core/reading/orientation_reader.hpp"
#include "core/reading/scene_keys.hpp"
#include "core/reading/scene_limits.hpp"
#include "core/reading/scene_name.hpp"
#include "core/reading/shape_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace kairos {
inline namespace core {
namespace {

constexpr std::string_view collision_names[] = {"square", "round"};

const EntityType& read_entity_type(const TableReader& table) {
  std::vector<std::string_view> kinds;
  for (const EntityType& type : entity_catalogue()) {
    kinds.push_back(type.kind);
  }
  const Item item = table.need("entity", "one of " + listed(kinds));
  return entity_catalogue()[item.choice(kinds)];
}

std::shared_ptr<const Entity> make_entity(const TableReader& table, const EntityType& type) {
  std::vector<double> values;
  for (const EntityKey& key : type.keys) {
    const auto item = table.find(key.key);
    const Range range{.lowest = key.lowest, .highest = key.highest, .unit = key.unit};
    values.push_back(item ? item->number(range) : key.default_value);
  }
  return type.make(values);
}

/// `normal` is given in the world at the start, and kept in the frame of the body. For a half-space
/// it is the whole shape.
void read_normal(const TableReader& table, Body& body) {
  const auto item = table.find("normal");
  if (!item) {
    return;
  }
  if (!body.entity->stationary()) {
    item->fail(fmt::format("a {} has no reflecting face; allowed: a normal for walls and conveyors",
                           body.entity->kind()));
  }
  const Vector3 normal = read_direction(*item, item->vector(limits::component));
  body.normal_B = body.initial.pose.orientation.conjugate() * normal;
  if (auto* half_space = std::get_if<HalfSpace>(&body.shape)) {
    if (table.has("orientation") || table.has("axis_angle")) {
      item->fail("an orientation is given too; allowed: one of them for a half-space");
    }
    half_space->normal_B = normal;
  }
}

Bounds read_bounds(const TableReader& table, const Body& body, Bounds fallback) {
  const auto item = table.find("bounds");
  const Bounds bounds = item ? static_cast<Bounds>(item->choice(bounds_names)) : fallback;
  if (const auto* mesh = std::get_if<Mesh>(&body.shape);
      mesh != nullptr && bounds == Bounds::hull) {
    try {
      (void)hull_in_place(mesh->body->mesh.vertices());
    } catch (const std::invalid_argument& error) {
      table.fail("bounds", error.what());
    }
  }
  if (!std::holds_alternative<HalfSpace>(body.shape)) {
    return bounds;
  }
  if (item && bounds != Bounds::shape) {
    item->fail("a half-space has no box around it; allowed: \"shape\"");
  }
  return Bounds::shape;
}

void read_inertia(const TableReader& table, Body& body) {
  const auto item = table.find("inertia");
  const auto* hull = std::get_if<Hull>(&body.shape);
  if (!item && hull != nullptr && hull->rounding > 0.0) {
    table.fail(
        "inertia",
        "is missing; needed for a hull with rounding: that of the polytope inside is not its "
        "own");
  }
  const auto* mesh = std::get_if<Mesh>(&body.shape);
  if (!item && mesh != nullptr && !mesh->body->mesh.solid()) {
    table.fail(
        "inertia",
        "is missing; allowed: 3 numbers > 0, as a surface that moves freely encloses no mass");
  }
  if (!item) {
    body.inertia = solid_inertia(body.shape, body.mass);
    body.inertia_axes = solid_axes(body.shape);
    return;
  }
  body.inertia = item->vector(limits::inertia);
  const Vector3& I = body.inertia;
  // Physical: no principal moment exceeds the sum of the others; roundoff of printed digits aside.
  if (2.0 * I.maxCoeff() > I.sum() * (1.0 + 1e-9)) {
    item->fail("one moment exceeds the sum of the other two; allowed: what a rigid body can have");
  }
}

/// A key that this kind of body does not take.
void refuse(const TableReader& table, std::string_view key, const std::string& reason) {
  if (table.has(key)) {
    table.fail(key, reason);
  }
}

void read_free(const TableReader& table, Body& body) {
  if (std::holds_alternative<HalfSpace>(body.shape)) {
    table.fail("shape",
               fmt::format("a half-space cannot move freely: a {} needs a body with an end",
                           body.entity->kind()));
  }
  refuse(table, "drive",
         fmt::format("a {} moves freely; allowed: a drive for fixed and driven bodies only",
                     body.entity->kind()));
  body.mass = table.need("mass", limits::mass.text()).number(limits::mass);
  read_inertia(table, body);
  if (const auto velocity = table.find("velocity")) {
    body.initial.twist.linear = velocity->vector(limits::velocity);
  }
  if (const auto spin = table.find("angular_velocity")) {
    body.initial.twist.angular = spin->vector(limits::angular_velocity);
    if (!body.entity->rotates() && !body.initial.twist.angular.isZero(0.0)) {
      spin->fail(fmt::format("a {} does not turn; allowed: [0, 0, 0], or the entity \"body\"",
                             body.entity->kind()));
    }
  }
}

void read_fixed_or_driven(const TableReader& table, Body& body, const EntityType& type,
                          const std::string& directory) {
  for (const std::string_view key : {"velocity", "angular_velocity"}) {
    refuse(table, key,
           fmt::format("a {} is not moved by forces; allowed: a drive", body.entity->kind()));
  }
  refuse(
      table, "inertia",
      fmt::format("nothing turns a {}; allowed: for bodies that move freely", body.entity->kind()));
  if (type.mobility == Mobility::driven) {
    body.mass = table.need("mass", limits::mass.text()).number(limits::mass);
  } else {
    refuse(table, "mass",
           fmt::format("a {} has infinite mass; allowed: for bodies that move freely",
                       body.entity->kind()));
  }
  if (const auto drive = table.find("drive")) {
    body.drive = read_drive(*drive, body, directory);
    const Motion motion = body.drive->motion(Instant{}, 1.0);
    body.initial = {motion.pose(0.0), motion.twist(0.0)};
  } else if (type.mobility == Mobility::driven) {
    table.fail("drive", fmt::format("is missing; a {} needs to be driven", body.entity->kind()));
  }
}

/// What a hand holds, and whether its drive can tell when.
void read_hand(const TableReader& table, Body& body) {
  if (!body.entity->is_hand()) {
    return refuse(table, "holds",
                  fmt::format("a {} has no fist; allowed: for hands", body.entity->kind()));
  }
  body.holds = table.need("holds", "the name of the body that the closed fist holds").text();
  if (!body.drive->has_gestures()) {
    table.fail("drive", "has no gestures; allowed: a track with the column gesture");
  }
}

void refuse_unknown_keys(const TableReader& table, const EntityType& type) {
  std::vector<std::string_view> known = scene_keys_of("body");
  for (const EntityKey& key : type.keys) {
    known.push_back(key.key);
  }
  table.refuse_unknown(known);
}

}  // namespace

double read_friction(const Item& item) {
  const auto* number = std::get_if<double>(&item.value().data);
  const auto* text = std::get_if<std::string>(&item.value().data);
  if ((number != nullptr && *number == std::numeric_limits<double>::infinity()) ||
      (text != nullptr && *text == "inf")) {
    return std::numeric_limits<double>::infinity();
  }
  const std::string allowed = limits::friction.text() + ", or inf (rough)";
  const auto* whole = std::get_if<std::int64_t>(&item.value().data);
  if (number == nullptr && whole == nullptr) {
    item.fail(fmt::format("is {}; allowed: {}", item.value().type_name(), allowed));
  }
  const double x = number != nullptr ? *number : static_cast<double>(*whole);
  if (!limits::friction.contains(x)) {
    item.fail(fmt::format("is {}; allowed: {}", x, allowed));
  }
  return x;
}

Body read_body(const Item& item, const BodyDefaults& defaults) {
  const TableReader table(item);
  Body body;
  body.line = item.value().line;
  body.name = read_name(table.need("name", "a name, unique in the scene"));
  const EntityType& type = read_entity_type(table);
  refuse_unknown_keys(table, type);
  body.entity = make_entity(table, type);
  body.shape = read_shape(table, defaults.directory, type.mobility == Mobility::free);
  body.bounds = read_bounds(table, body, defaults.bounds);
  if (const auto position = table.find("position")) {
    body.initial.pose.position = position->vector(limits::position);
  }
  body.initial.pose.orientation = read_orientation(table);
  read_normal(table, body);
  const auto number = [&table](std::string_view key, const Range& range, double fallback) {
    const auto value = table.find(key);
    return value ? value->number(range) : fallback;
  };
  body.restitution = number("restitution", limits::restitution, body.restitution);
  const auto friction = table.find("friction");
  body.friction = friction ? read_friction(*friction) : defaults.friction;
  body.G = number("G", limits::G, defaults.G);
  body.scale = number("scale", limits::scale, body.scale);
  if (const auto collision = table.find("collision_type")) {
    body.collision_type = static_cast<CollisionType>(collision->choice(collision_names));
  }
  if (type.mobility == Mobility::free) {
    read_free(table, body);
  } else {
    read_fixed_or_driven(table, body, type, defaults.directory);
  }
  read_hand(table, body);
  return body;
}

}  // namespace core
}  // namespace kairos
