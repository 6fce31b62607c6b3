#include "core/reading/force_reader.hpp"

#include "core/forces/buoyancy.hpp"
#include "core/forces/drag.hpp"
#include "core/forces/magnus.hpp"
#include "core/forces/spring.hpp"
#include "core/nearest_name.hpp"
#include "core/reading/scene_keys.hpp"
#include "core/reading/scene_limits.hpp"
#include "core/solid_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace kairos {
inline namespace core {
namespace {

/// A `[[force]]` while it is read.
struct Reading {
  const TableReader& table;
  double G;
  Scene& scene;

  [[nodiscard]] double number(std::string_view key, const Range& range, double fallback) const {
    const auto item = table.find(key);
    return item ? item->number(range) : fallback;
  }
  [[nodiscard]] double needed(std::string_view key, const Range& range) const {
    return table.need(key, range.text()).number(range);
  }
  [[nodiscard]] Vector3 vector(std::string_view key, const Range& range) const {
    const auto item = table.find(key);
    return item ? item->vector(range) : Vector3(Vector3::Zero());
  }
  void add(std::shared_ptr<const Force> force, std::vector<BodyIndex> bodies) const {
    refuse_turning(*force, bodies);
    scene.forces.push_back({std::move(force), std::move(bodies)});
  }

 private:
  /// A thing that never turns has no spin, and no torque does anything to it.
  void refuse_turning(const Force& force, const std::vector<BodyIndex>& bodies) const {
    for (const BodyIndex i : bodies) {
      const Body& body = scene.bodies[i];
      if (force.involves_rotation() && !body.entity->rotates()) {
        table.fail("bodies", fmt::format("this {} involves rotation, and \"{}\", a {}, does not "
                                         "turn; allowed: the entity \"body\"",
                                         force.description(), body.name, body.entity->kind()));
      }
    }
  }
};

std::string names_of_free_bodies(const Scene& scene) {
  std::vector<std::string_view> names;
  for (const Body& body : scene.bodies) {
    if (body.entity->mobility() == Mobility::free) {
      names.push_back(body.name);
    }
  }
  return names.empty() ? "none, as nothing in this scene moves freely" : listed(names);
}

BodyIndex find_body(const Item& item, const Scene& scene) {
  std::vector<std::string_view> names;
  for (const Body& body : scene.bodies) {
    names.push_back(body.name);
  }
  return item.choice(names);
}

/// What `bodies` names, in order; nothing where it is left out.
std::vector<BodyIndex> read_bodies(const Reading& reading) {
  std::vector<BodyIndex> result;
  const auto item = reading.table.find("bodies");
  if (!item) {
    return result;
  }
  const Array& array = item->array();
  for (std::size_t k = 0; k < array.size(); ++k) {
    const Item element(array[k], fmt::format("{}[{}]", item->path(), k));
    const BodyIndex i = find_body(element, reading.scene);
    if (std::find(result.begin(), result.end(), i) != result.end()) {
      element.fail(fmt::format("\"{}\" is named twice; allowed: each body once", element.text()));
    }
    result.push_back(i);
  }
  if (result.empty()) {
    item->fail("is empty; allowed: names of bodies that move freely: " +
               names_of_free_bodies(reading.scene));
  }
  return result;
}

bool moves_freely(const Reading& reading, BodyIndex i) {
  return reading.scene.bodies[i].entity->mobility() == Mobility::free;
}

/// The bodies that a force acts on one by one: those that are named, or all that move freely.
std::vector<BodyIndex> each_body(const Reading& reading) {
  std::vector<BodyIndex> result = read_bodies(reading);
  for (const BodyIndex i : result) {
    if (!moves_freely(reading, i)) {
      const Body& body = reading.scene.bodies[i];
      reading.table.fail("bodies",
                         fmt::format("\"{}\", a {}, is not moved by forces; allowed: {}", body.name,
                                     body.entity->kind(), names_of_free_bodies(reading.scene)));
    }
  }
  if (!result.empty()) {
    return result;
  }
  for (BodyIndex i = 0; i < reading.scene.bodies.size(); ++i) {
    if (moves_freely(reading, i)) {
      result.push_back(i);
    }
  }
  if (result.empty()) {
    reading.table.fail(
        "", "acts on nothing: no body of the scene moves freely; allowed: with one that does");
  }
  return result;
}

double sphere_radius(const Shape& shape) {
  const auto* sphere = std::get_if<Sphere>(&shape);
  return sphere != nullptr ? sphere->radius : 0.0;
}

/// Area seen from ahead; of what is no ball the mean over all directions, a quarter of its surface
/// (Cauchy).
double seen_area(const Shape& shape) {
  if (const double r = sphere_radius(shape); r > 0.0) {
    return std::numbers::pi * r * r;
  }
  return 0.25 * surface_area(shape);
}

void read_quadratic_drag(const Reading& reading) {
  QuadraticDrag::Parameters p;
  p.density = reading.number("density", limits::density, p.density);
  p.drag_coefficient = reading.number("drag_coefficient", limits::coefficient, p.drag_coefficient);
  p.wind = reading.vector("wind", limits::velocity);
  for (const BodyIndex i : each_body(reading)) {
    p.area = reading.number("area", limits::area, seen_area(reading.scene.bodies[i].shape));
    reading.add(std::make_shared<const QuadraticDrag>(p), {i});
  }
}

void read_linear_drag(const Reading& reading) {
  LinearDrag::Parameters p;
  p.coefficient = reading.needed("coefficient", limits::damping);
  p.rotational = reading.number("rotational", limits::rotational_damping, p.rotational);
  p.wind = reading.vector("wind", limits::velocity);
  for (const BodyIndex i : each_body(reading)) {
    reading.add(std::make_shared<const LinearDrag>(p), {i});
  }
}

void read_magnus_lift(const Reading& reading) {
  MagnusLift::Parameters p;
  p.density = reading.number("density", limits::density, p.density);
  p.lift_coefficient = reading.number("lift_coefficient", limits::coefficient, p.lift_coefficient);
  p.wind = reading.vector("wind", limits::velocity);
  for (const BodyIndex i : each_body(reading)) {
    const double radius = sphere_radius(reading.scene.bodies[i].shape);
    p.radius = radius > 0.0 ? reading.number("radius", limits::extent, radius)
                            : reading.needed("radius", limits::extent);
    reading.add(std::make_shared<const MagnusLift>(p), {i});
  }
}

void read_buoyancy(const Reading& reading) {
  Buoyancy::Parameters p;
  p.density = reading.number("density", limits::density, p.density);
  // Under the thesis' gravity G is a force: it is not what a fluid's weight comes from.
  const double G = reading.scene.gravity == GravityMode::acceleration
                       ? reading.number("G", limits::G, reading.G)
                       : reading.needed("G", limits::G);
  p.gravity = {0.0, -G, 0.0};
  p.centre_B = reading.vector("centre", limits::position);
  for (const BodyIndex i : each_body(reading)) {
    p.volume =
        reading.number("volume", limits::volume, solid_volume(reading.scene.bodies[i].shape));
    reading.add(std::make_shared<const Buoyancy>(p), {i});
  }
}

/// The other end of a spring that has one free body: an anchor, or a point of a fixed body.
Vector3 fixed_end(const Reading& reading, const std::vector<BodyIndex>& bodies) {
  if (bodies.size() == 1) {
    return reading.table.need("anchor", "a point of the world (m), or a second body")
        .vector(limits::position);
  }
  const Body& body = reading.scene.bodies[bodies[1]];
  if (body.drive != nullptr) {
    reading.table.fail("bodies", fmt::format("\"{}\" is driven; allowed: a body that moves freely, "
                                             "one that never moves, or an anchor",
                                             body.name));
  }
  return body.initial.pose.to_world(reading.vector("point_b", limits::position));
}

void read_spring_between(const Reading& reading, Spring::Parameters p) {
  (void)reading.table.need("bodies", "one body and an anchor, or two bodies");
  const std::vector<BodyIndex> bodies = read_bodies(reading);
  if (bodies.size() > 2) {
    reading.table.fail("bodies", fmt::format("names {} bodies; allowed: 1 or 2", bodies.size()));
  }
  if (bodies.size() == 2 && reading.table.has("anchor")) {
    reading.table.fail("anchor", "two bodies are given too; allowed: one of them");
  }
  if (bodies.size() == 1 && reading.table.has("point_b")) {
    reading.table.fail("point_b", "there is one body only; allowed: anchor");
  }
  if (!moves_freely(reading, bodies[0])) {
    reading.table.fail("bodies", fmt::format("\"{}\" is not moved by forces; allowed as the first "
                                             "body: {}",
                                             reading.scene.bodies[bodies[0]].name,
                                             names_of_free_bodies(reading.scene)));
  }
  p.point_A = reading.vector("point_a", limits::position);
  if (bodies.size() == 2 && moves_freely(reading, bodies[1])) {
    p.point_B = reading.vector("point_b", limits::position);
    reading.add(std::make_shared<const Spring>(p), bodies);
  } else {
    p.anchor_W = fixed_end(reading, bodies);
    reading.add(std::make_shared<const Spring>(p), {bodies[0]});
  }
}

void read_spring(const Reading& reading) {
  Spring::Parameters p;
  p.stiffness = reading.needed("stiffness", limits::stiffness);
  p.damping = reading.number("damping", limits::damping, p.damping);
  p.rest_length = reading.number("rest_length", limits::length, p.rest_length);
  read_spring_between(reading, p);
}

void read_damper(const Reading& reading) {
  Spring::Parameters p;
  p.damping = reading.needed("damping", limits::damping);
  read_spring_between(reading, p);
}

struct Kind {
  std::string_view name;
  void (*read)(const Reading&);
};
constexpr Kind kinds[] = {
    {"quadratic-drag", read_quadratic_drag},
    {"linear-drag", read_linear_drag},
    {"magnus-lift", read_magnus_lift},
    {"buoyancy", read_buoyancy},
    {"spring", read_spring},
    {"damper", read_damper},
};

const Kind& read_kind(const TableReader& table) {
  std::vector<std::string_view> names;
  for (const Kind& kind : kinds) {
    names.push_back(kind.name);
  }
  return kinds[table.need("kind", "one of " + listed(names)).choice(names)];
}

}  // namespace

void read_force(const Item& item, double G, Scene& scene) {
  const TableReader table(item);
  const Kind& kind = read_kind(table);
  std::vector<std::string_view> known = scene_keys_of("force");
  for (const std::string_view key : scene_keys_of("force." + std::string(kind.name))) {
    known.push_back(key);
  }
  table.refuse_unknown(known);
  kind.read({table, G, scene});
}

}  // namespace core
}  // namespace kairos
