#include "experiments/random/random_scene.hpp"

#include "core/random.hpp"
#include "experiments/random/random_shape.hpp"
#include "experiments/random/scene_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kairos::experiments {
namespace {

std::string vector(const Vector3& v) { return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]); }

void write_body(std::string& out, const RandomBody& b) {
  const auto line = [&out](std::string_view key, const std::string& value) {
    out += fmt::format("{} = {}\n", key, value);
  };
  const auto text = [&line](std::string_view key, const std::string& value) {
    line(key, '"' + value + '"');
  };
  out += "\n[[body]]\n";
  text("name", b.name);
  text("entity", b.entity);
  out += shape_toml(b);
  line("position", vector(b.position));
  if (b.moves()) {
    line("mass", fmt::format("{}", b.mass));
    if (b.gyration > 0.0) {
      line("inertia", vector(Vector3::Constant(b.mass * b.gyration)));
    }
    line("velocity", vector(b.velocity));
  }
  if (const double angle = b.turned.norm(); angle > 0.0) {
    line("axis_angle", fmt::format("[{}, {}, {}, {}]", b.turned[0] / angle, b.turned[1] / angle,
                                   b.turned[2] / angle, angle));
  }
  if (b.moves() && !b.spin.isZero(0.0)) {
    line("angular_velocity", vector(b.spin));
  }
  if (b.restitution != 1.0) {
    line("restitution", fmt::format("{}", b.restitution));
  }
  if (b.friction != 0.0) {
    line("friction", fmt::format("{}", b.friction));
  }
  if (!b.swing.isZero(0.0)) {
    out += "\n[body.drive]\n";
    line("amplitude", vector(b.swing));
    line("frequency", fmt::format("{}", b.frequency));
    line("phase", fmt::format("{}", b.phase));
  }
  out += parts_toml(b);
}

void write_joint(std::string& out, const RandomJoint& joint) {
  out += fmt::format("\n[[joint]]\nkind = \"{}\"\nbodies = [\"{}\"]\n", joint.kind,
                     fmt::join(joint.bodies, "\", \""));
  if (joint.kind != "weld" && (joint.kind != "rod" || joint.bodies.size() == 1)) {
    out += fmt::format("anchor = {}\n", vector(joint.anchor));
  }
  if (joint.kind == "hinge" || joint.kind == "slider") {
    out += fmt::format("axis = {}\n", vector(joint.axis));
  }
}

/// Makes one scene; its lengths are about 1, and scaled in the end.
class Maker {
 public:
  Maker(std::uint64_t seed, std::uint64_t index) : random_(seed, index) {
    scene_.name = fmt::format("random-{}-{}", seed, index);
  }
  /// Draws from all shapes, not from spheres and boxes alone.
  Maker& of_all_shapes() {
    all_shapes_ = true;
    return *this;
  }

  RandomScene make() {
    length_ = random_.log_uniform(1e-2, 1e2);
    speed_ = length_ * random_.log_uniform(0.3, 30.0);
    scene_.G = chance(0.5) ? 0.0 : random_.log_uniform(0.1, 10.0) * speed_ * speed_ / length_;
    scene_.duration = random_.log_uniform(1.0, 10.0) * length_ / speed_;
    scene_.frame = scene_.duration / 64.0;
    walls();
    for (std::uint64_t k = random_.below(4); k > 0; --k) {
      place(obstacle());
    }
    for (std::uint64_t k = 1 + random_.below(8); k > 0; --k) {
      place(mover());
    }
    return std::move(scene_);
  }

 private:
  bool chance(double p) { return random_.uniform() < p; }
  std::string next_name(const char* kind) { return fmt::format("{}-{}", kind, ++count_); }

  /// A floor, or a closed room.
  void walls() {
    const bool room = chance(0.5);
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        const bool floor = axis == 1 && side < 0.0;
        if (room || (floor && (scene_.G > 0.0 || chance(0.3)))) {
          RandomBody wall;
          wall.name = next_name("wall");
          wall.entity = "wall";
          wall.shape = "half-space";
          wall.normal = -side * Vector3::Unit(axis);
          wall.position = side * 2.0 * length_ * Vector3::Unit(axis);
          scene_.bodies.push_back(wall);
        }
      }
    }
  }

  RandomBody obstacle() {
    RandomBody b;
    b.shape = "box";
    b.half_extents = {size(), size(), size()};
    if (chance(0.15)) {
      b.entity = "anti-gravity-pad";
    } else {
      b.entity = "wall";
      b.turned = chance(0.5) ? random_vector(random_, 0.0, 3.0) : Vector3(Vector3::Zero());
      if (chance(0.3)) {
        b.swing = random_vector(random_, 0.05, 0.4) * length_;
        b.frequency = random_.log_uniform(0.05, 1.0) * speed_ / length_;
        b.phase = random_.uniform(0.0, 6.0);
      }
    }
    if (all_shapes_ && b.entity == "wall") {
      draw_shape(random_, length_, b);
    }
    b.name = next_name(b.entity == "wall" ? "block" : "pad");
    return b;
  }

  RandomBody mover() {
    RandomBody b;
    const double kind = random_.uniform();
    const double balls = all_shapes_ ? 0.15 : 0.6;
    b.entity = kind < balls ? "ball" : kind < 0.9 ? "body" : "balloon";
    b.shape = b.entity == "body" && chance(0.8) ? "box" : "sphere";
    b.radius = size();
    b.half_extents = {size(), size(), size()};
    b.mass = random_.log_uniform(1e-2, 1e2);
    const double share = random_.uniform();
    b.velocity = random_.direction() * speed_ * share;
    // A box that loses speed comes to rest on its edges: that is refused by design.
    const bool loses = chance(b.shape == "box" ? 0.02 : 0.3);
    b.restitution = loses ? random_.uniform(0.3, 1.0) : 1.0;
    if (all_shapes_ && b.entity == "body") {
      draw_shape(random_, length_, b);
    }
    if (b.entity == "body") {
      b.turned = random_vector(random_, 0.0, 3.0);
      const double rate = random_.log_uniform(0.1, 30.0);
      b.spin = random_.direction() * rate * speed_ / length_;
    }
    b.name = next_name(b.entity.c_str());
    return b;
  }

  double size() { return length_ * random_.log_uniform(0.02, 0.5); }

  /// Places a body where it overlaps nothing, if a place is found.
  void place(RandomBody b) {
    for (int attempt = 0; attempt < 20; ++attempt) {
      for (int axis = 0; axis < 3; ++axis) {
        b.position[axis] = random_.uniform(-1.9, 1.9) * length_;
      }
      if (std::all_of(scene_.bodies.begin(), scene_.bodies.end(),
                      [&b](const RandomBody& other) { return apart(b, other); })) {
        scene_.bodies.push_back(b);
        return;
      }
    }
  }

  Random random_;
  RandomScene scene_;
  double length_ = 1.0;
  double speed_ = 1.0;
  int count_ = 0;
  bool all_shapes_ = false;
};

}  // namespace

bool apart(const RandomBody& b, const RandomBody& other, double way) {
  if (other.shape == "half-space") {
    return other.normal.dot(b.position - other.position) > b.reach();
  }
  return (b.position - other.position).norm() > b.reach() + other.reach() + way;
}

std::string RandomScene::toml() const {
  std::string out = fmt::format(
      "name = \"{}\"\nsummary = \"a random scene\"\nduration = {}\nframe = {}\nG = {}\n", name,
      duration, frame, G);
  std::string axes;
  for (std::size_t k = 0; k < 3; ++k) {
    axes += repeated[k] ? fmt::format("{}\"{}\"", axes.empty() ? "" : ", ", "xyz"[k]) : "";
  }
  if (!axes.empty()) {
    out += fmt::format("\n[periodic]\nmin = {}\nmax = {}\naxes = [{}]\n", vector(low), vector(high),
                       axes);
  }
  for (const RandomBody& b : bodies) {
    write_body(out, b);
  }
  for (const RandomJoint& joint : joints) {
    write_joint(out, joint);
  }
  return out;
}

RandomScene random_scene(std::uint64_t seed, std::uint64_t index) {
  return Maker(seed, index).make();
}

RandomScene shapes_scene(std::uint64_t seed, std::uint64_t index) {
  RandomScene scene = Maker(~seed - 1, index).of_all_shapes().make();
  scene.name = fmt::format("shapes-{}-{}", seed, index);
  return scene;
}

}  // namespace kairos::experiments
