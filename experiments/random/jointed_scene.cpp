#include "experiments/random/scene_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace kairos::experiments {
namespace {

/// Makes one scene, up along y. A mechanism is built first; what it may meet is put where it
/// overlaps nothing.
class Builder : SceneBuilder {
 public:
  Builder(std::uint64_t seed, std::uint64_t index)
      : SceneBuilder(~seed - 3, index, fmt::format("jointed-{}-{}", seed, index)) {}

  RandomScene make() {
    scene_.G = chance(0.8) ? 9.8 : 0.0;
    scene_.duration = random_.uniform(0.5, 3.0);
    scene_.frame = scene_.duration / 64.0;
    switch (random_.below(8)) {
      case 0:
        pendulum();
        break;
      case 1:
        chain();
        break;
      case 2:
        rods();
        break;
      case 3:
        door();
        break;
      case 4:
        rail();
        break;
      case 5:
        welded();
        break;
      case 6:
        cradle();
        break;
      default:
        hand();
    }
    surroundings();
    if (chance(0.5)) {
      for (RandomBody& b : scene_.bodies) {
        b.friction = hangs(b) ? 0.0 : random_friction(random_);
      }
      for (RandomBody& b : scene_.bodies) {
        b.friction = hangs(b) && chance(0.8) ? random_friction(random_) : b.friction;
      }
    }
    return std::move(scene_);
  }

 private:
  [[nodiscard]] bool hangs(const RandomBody& b) const {
    return b.moves() &&
           std::any_of(scene_.joints.begin(), scene_.joints.end(), [&](const RandomJoint& joint) {
             return std::find(joint.bodies.begin(), joint.bodies.end(), b.name) !=
                    joint.bodies.end();
           });
  }
  RandomJoint& join(const std::string& kind, std::vector<std::string> bodies,
                    const Vector3& anchor = Vector3::Zero(),
                    const Vector3& axis = Vector3::Zero()) {
    scene_.joints.push_back({kind, std::move(bodies), anchor, axis});
    return scene_.joints.back();
  }
  /// All bodies so far turn about a point as one, which every joint allows; a hinge about its axis.
  void turn_about(const Vector3& point, const Vector3& spin) {
    for (RandomBody& b : scene_.bodies) {
      b.velocity = spin.cross(b.position - point);
      b.spin = b.entity == "ball" ? Vector3(Vector3::Zero()) : spin;
    }
  }
  Vector3 some_spin() { return chance(0.4) ? Vector3(Vector3::Zero()) : vector(0.0, 6.0); }
  /// A direction away from the anchor, seldom straight up.
  Vector3 hanging() {
    if (chance(0.3)) {
      return Vector3::UnitX();
    }
    const double z = chance(0.5) ? 0.0 : random_.uniform(-1.0, 1.0);
    const double y = random_.uniform(-1.0, 0.3);
    return Vector3(random_.uniform(-1.0, 1.0), y, z).normalized();
  }
  /// A link from one end to the other: a box along the way.
  RandomBody& link(const Vector3& from, const Vector3& to) {
    const double half = 0.5 * (to - from).norm();
    RandomBody& b = box(0.5 * (from + to),
                        {half, random_.uniform(0.1, 0.4) * half, random_.uniform(0.1, 0.4) * half});
    const Eigen::AngleAxisd turn(Quaternion::FromTwoVectors(Vector3::UnitX(), to - from));
    b.turned = turn.axis() * turn.angle();
    return b;
  }

  /// One body on a hinge, a ball joint or a rod.
  void pendulum() {
    const double length = random_.uniform(0.3, 1.0);
    const Vector3 away = hanging() * length;
    const double kind = random_.uniform();
    if (kind < 0.3) {
      const std::string name = ball(away, 0.3 * away.norm()).name;
      join("rod", {name});
      Vector3 spin = some_spin();
      turn_about(Vector3::Zero(), spin);
    } else if (kind < 0.65) {
      const std::string name = link(Vector3::Zero(), 2.0 * away).name;
      join("ball", {name});
      turn_about(Vector3::Zero(), some_spin());
    } else {
      const std::string name = link(Vector3::Zero(), 2.0 * away).name;
      const Vector3 axis = away.unitOrthogonal();
      join("hinge", {name}, Vector3::Zero(), axis);
      turn_about(Vector3::Zero(), axis * random_.uniform(-5.0, 5.0));
    }
  }

  /// Two to five links that hang at one end, at both, or fly.
  void chain() {
    const std::uint64_t n = 2 + random_.below(4);
    const Vector3 along = hanging();
    const Vector3 side = along.unitOrthogonal();
    const bool hinged = chance(0.4);
    const double fixed = random_.uniform();
    Vector3 at = Vector3::Zero();
    std::string before;
    for (std::uint64_t k = 0; k < n; ++k) {
      const double zigzag = chance(0.5) ? 0.0 : random_.uniform(-0.3, 0.3);
      const Vector3 to = at + 0.4 * along + 0.4 * zigzag * side;
      const std::string name = link(at, to).name;
      if (k > 0 || fixed < 0.8) {
        const std::vector<std::string> pair = k > 0 ? std::vector{before, name} : std::vector{name};
        // The plane of the zigzag is the plane that hinges leave.
        join(hinged ? "hinge" : "ball", pair, at,
             hinged ? Vector3(along.cross(side)) : Vector3(Vector3::Zero()));
      }
      before = name;
      at = to;
    }
    if (fixed < 0.3) {
      join(hinged ? "hinge" : "ball", {before}, at,
           hinged ? Vector3(along.cross(side)) : Vector3(Vector3::Zero()));
      return;  // at both ends: at rest
    }
    const Vector3 axis = along.cross(side);
    const bool in_plane = hinged && fixed < 0.8;
    turn_about(fixed < 0.8 ? Vector3(Vector3::Zero()) : at,
               in_plane ? Vector3(axis * random_.uniform(-4.0, 4.0)) : some_spin());
  }

  /// Two or three balls on rods, one on the other.
  void rods() {
    const std::uint64_t n = 2 + random_.below(2);
    Vector3 at = Vector3::Zero();
    std::string before;
    for (std::uint64_t k = 0; k < n; ++k) {
      // Not onto one of those before.
      const Vector3 from = at;
      do {
        const double length = random_.uniform(0.4, 0.8);
        at = from + hanging() * length;
      } while (std::any_of(scene_.bodies.begin(), scene_.bodies.end(),
                           [&](const RandomBody& b) { return (b.position - at).norm() < 0.17; }));
      const std::string name = ball(at, 0.08).name;
      join("rod", k > 0 ? std::vector{before, name} : std::vector{name});
      before = name;
    }
    turn_about(Vector3::Zero(), some_spin());
  }

  /// A plate on an upright hinge.
  void door() {
    const double high = random_.uniform(0.3, 0.6);
    const Vector3 half(random_.uniform(0.3, 0.6), high, 0.05);
    const std::string name = box({half.x(), 0.0, 0.0}, half).name;
    const Vector3 axis = chance(0.8) ? Vector3(Vector3::UnitY()) : Vector3(0.3, 1.0, 0.0);
    join("hinge", {name}, Vector3::Zero(), axis);
    turn_about(Vector3::Zero(), axis.normalized() * random_.uniform(-4.0, 4.0));
  }

  /// A box on a rail, and maybe something that hangs from it.
  void rail() {
    const Vector3 along = chance(0.5) ? Vector3(Vector3::UnitX()) : random_.direction();
    RandomBody& slide = box(Vector3::Zero(), {0.15, 0.1, 0.1});
    const std::string name = slide.name;
    join("slider", {name}, Vector3::Zero(), along);
    const Vector3 velocity = along.normalized() * random_.uniform(-3.0, 3.0);
    if (chance(0.5)) {
      const Vector3 to = hanging() * 0.6;
      const std::string hangs = ball(to, 0.1).name;
      join("rod", {name, hangs});
    }
    for (RandomBody& b : scene_.bodies) {
      b.velocity = velocity;
    }
  }

  /// Two boxes that are one, thrown.
  void welded() {
    const std::string a = box(Vector3::Zero(), {0.3, 0.1, 0.1}).name;
    const std::string b = box({0.2, 0.25, 0.0}, {0.1, 0.15, 0.1}).name;
    join("weld", {a, b});
    turn_about(Vector3(0.1, 0.1, 0.0), some_spin());
    const Vector3 v = vector(0.0, 4.0);
    for (RandomBody& body : scene_.bodies) {
      body.velocity += v;
    }
  }

  /// Balls on rods side by side, that touch or nearly so; the first swings in.
  void cradle() {
    const std::uint64_t n = 2 + random_.below(4);
    const double r = 0.1;
    const double space = chance(0.5) ? 0.0 : 0.01;
    const bool alike = chance(0.6);
    const double e = restitution();
    for (std::uint64_t k = 0; k < n; ++k) {
      const double x = static_cast<double>(k) * (2.0 * r + space);
      const double angle = k == 0 ? random_.uniform(0.2, 1.2) : 0.0;
      const Vector3 at(x - std::sin(angle), -std::cos(angle), 0.0);
      RandomBody& b = ball(at, r * (1.0 - 0x1p-46));
      b.mass = alike ? 1.0 : b.mass;
      b.restitution = alike ? e : b.restitution;
      join("rod", {b.name}, {x, 0.0, 0.0});
    }
  }

  /// A body that hangs from something driven.
  void hand() {
    RandomBody& driver = box(Vector3::Zero(), {0.1, 0.1, 0.1});
    driver.entity = "wall";
    driver.swing = vector(0.02, 0.3);
    driver.frequency = random_.log_uniform(0.2, 3.0);
    driver.phase = chance(0.5) ? 0.0 : random_.uniform(0.0, 6.0);
    const std::string from = driver.name;
    // What hangs has the velocity of what it hangs from: at the start, 2 pi f A cos(phase).
    const Vector3 velocity =
        2.0 * std::numbers::pi * driver.frequency * std::cos(driver.phase) * driver.swing;
    const Vector3 start = std::sin(driver.phase) * driver.swing;
    const Vector3 to = start + hanging() * 0.7;
    const std::string name = ball(to, 0.1).name;
    scene_.bodies.back().velocity = velocity;
    join("rod", {from, name});
  }

  /// Walls around, or a floor, or nothing; free bodies that fly about.
  void surroundings() {
    double reach = 0.0;
    for (const RandomBody& b : scene_.bodies) {
      reach = std::max(reach, b.position.norm() + b.reach());
    }
    const double u = random_.uniform();
    const bool room = u < 0.3;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        const bool floor = axis == 1 && side < 0.0;
        if (room || (floor && u < 0.6) || (axis == 0 && side > 0.0 && u > 0.7 && u < 0.85)) {
          const double away = reach * (chance(0.5) ? 1.02 : random_.uniform(1.02, 1.6));
          plane(-side * Vector3::Unit(axis), side * away * Vector3::Unit(axis)).restitution =
              restitution();
        }
      }
    }
    for (std::uint64_t k = random_.below(4); k > 0; --k) {
      RandomBody& b = chance(0.6) ? ball(Vector3::Zero(), random_.uniform(0.05, 0.15))
                                  : box(Vector3::Zero(), {0.1, random_.uniform(0.05, 0.2), 0.1});
      b.velocity = vector(0.0, 3.0);
      if (b.entity == "body" && chance(0.5)) {
        b.turned = vector(0.0, 3.0);
        b.spin = vector(0.0, 5.0);
      }
      place_last(1.5 * reach);
    }
  }

  /// Puts the last body where it overlaps nothing, or leaves it out.
  void place_last(double within) {
    RandomBody b = scene_.bodies.back();
    scene_.bodies.pop_back();
    for (int attempt = 0; attempt < 20; ++attempt) {
      b.position = {random_.uniform(-within, within), random_.uniform(-within, within),
                    random_.uniform(-within, within)};
      if (std::all_of(scene_.bodies.begin(), scene_.bodies.end(), [&b](const RandomBody& other) {
            return apart(b, other, other.swing.norm());
          })) {
        scene_.bodies.push_back(b);
        return;
      }
    }
  }
};

}  // namespace

RandomScene jointed_scene(std::uint64_t seed, std::uint64_t index) {
  return Builder(seed, index).make();
}

}  // namespace kairos::experiments
