#include "experiments/random/scene_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kairos::experiments {
namespace {

/// Makes one scene in a frame of its own, up along y, and places it at random.
class Builder : SceneBuilder {
 public:
  Builder(std::uint64_t seed, std::uint64_t index)
      : SceneBuilder(~seed, index, fmt::format("touching-{}-{}", seed, index)) {}

  RandomScene make() {
    scene_.G = 9.8;
    scene_.duration = random_.uniform(0.5, 4.0);
    scene_.frame = scene_.duration / 64.0;
    switch (random_.below(8)) {
      case 0:
        stack();
        break;
      case 1:
        row();
        break;
      case 2:
        groove();
        break;
      case 3:
        corner();
        break;
      case 4:
        incline();
        break;
      case 5:
        cluster();
        break;
      case 6:
        press();
        break;
      default:
        heap();
    }
    place();
    return std::move(scene_);
  }

 private:
  Vector3 half() {
    const double h = size();
    if (chance(0.5)) {
      return {h, h, h};
    }
    const double z = size();
    return {size(), h, z};
  }

  /// Boxes or balls on a floor and on each other, at rest or thrown.
  void stack() {
    plane(Vector3::UnitY());
    double top = chance(0.7) ? 0.0 : random_.uniform(0.0, 1.0);
    for (std::uint64_t k = 1 + random_.below(4); k > 0; --k) {
      if (chance(0.6)) {
        const Vector3 h = half();
        box({0.0, top + h.y(), 0.0}, h);
        top += 2.0 * h.y();
      } else {
        const double r = size();
        ball({0.0, top + r, 0.0}, r);
        top += 2.0 * r;
      }
      if (chance(0.2)) {
        scene_.bodies.back().velocity = random_.direction();
      }
    }
  }

  /// Balls in a row that touch, one of which comes in.
  void row() {
    scene_.G = chance(0.3) ? 9.8 : 0.0;
    double x = 0.0;
    const std::uint64_t n = 2 + random_.below(6);
    const bool alike = chance(0.5);
    const double r0 = size();
    for (std::uint64_t k = 0; k < n; ++k) {
      const double r = alike ? r0 : size();
      x += r;
      RandomBody& b = ball({x, 0.0, 0.0}, r);
      x += r;
      if (k == 0) {
        b.velocity = {1.0, 0.0, 0.0};
        x += chance(0.5) ? 0.0 : 0.5;
      }
      b.mass = alike ? 1.0 : b.mass;
    }
    if (chance(0.3)) {
      plane(-Vector3::UnitX(), {x, 0.0, 0.0});
    }
  }

  /// Two planes that meet in a line, and balls or a box over it.
  void groove() {
    const double left = chance(0.5) ? 1.0 : random_.uniform(0.1, 2.0);
    const double right = chance(0.5) ? left : random_.uniform(0.1, 2.0);
    plane({left, 1.0, 0.0});
    plane({-right, 1.0, 0.0});
    const double r = size();
    const double x = chance(0.5) ? 0.0 : random_.uniform(-0.3, 0.3);
    const double steep = std::max(left, right);
    const double y = 1.5 * r * (1.0 + steep) + std::abs(x) * steep + random_.uniform(0.0, 1.0);
    if (chance(0.8)) {
      ball({x, y, 0.0}, r);
    } else {
      box({x, y + r, 0.0}, {0.5 * r, 0.5 * r, 0.5 * r});
    }
    if (chance(0.3)) {
      const double s = size();
      const double above = y + 2.0 * r + s + random_.uniform(0.0, 0.2);
      ball({x, std::max(above, 1.5 * s * (1.0 + steep) + std::abs(x) * steep), 0.0}, s);
    }
  }

  /// A floor and two walls, and a ball on its way into the corner.
  void corner() {
    plane(Vector3::UnitX());
    plane(Vector3::UnitY());
    plane(Vector3::UnitZ());
    const double r = size();
    const double far = r + (chance(0.3) ? 0.0 : random_.uniform(0.0, 1.0));
    RandomBody& b = ball({far, far, r}, r);
    if (!chance(0.3)) {
      const double z = -random_.uniform();
      const double y = -random_.uniform();
      b.velocity = {-random_.uniform(), y, z};
    }
    scene_.G = chance(0.5) ? 9.8 : 0.0;
  }

  /// A ball or a box on an incline, and something that stops it below.
  void incline() {
    const double angle = random_.uniform(0.05, 1.2);
    const Vector3 normal(std::sin(angle), std::cos(angle), 0.0);
    const Vector3 down(std::cos(angle), -std::sin(angle), 0.0);
    plane(normal);
    const double lean = chance(0.5) ? 0.0 : random_.uniform(0.0, 0.5);
    plane(chance(0.5) ? Vector3(-down) : Vector3(-std::cos(lean), std::sin(lean), 0.0), 3.0 * down);
    const double r = size();
    if (chance(0.7)) {
      ball(r * normal, r);
    } else {
      box(r * normal, {r, r, r}).turned = {0.0, 0.0, -angle};
    }
    if (chance(0.3)) {
      const double s = size();
      const double along = r * std::sqrt(2.0) + s + 0.1;
      ball(s * normal + along * down, s);
      // Room for both, also where the stop leans over the incline.
      const Vector3& stop = scene_.bodies[1].normal;
      const double least = along + 1.001 * s * (1.0 - normal.dot(stop)) / -down.dot(stop);
      scene_.bodies[1].position = std::max({3.0, along + 1.1 * s, least}) * down;
    }
  }

  /// Free balls that run into each other with little restitution: inelastic collapse.
  void cluster() {
    scene_.G = 0.0;
    scene_.duration = random_.uniform(1.0, 10.0);
    const std::uint64_t n = 3 + random_.below(6);
    const double e = std::sqrt(chance(0.5) ? random_.uniform(0.0, 0.1) : random_.uniform());
    const bool straight = chance(0.7);
    for (std::uint64_t k = 0; k < n; ++k) {
      const double place = static_cast<double>(k);
      const Vector3 aside =
          straight ? Vector3(Vector3::Zero()) : Vector3(random_.direction() * 0.02);
      RandomBody& b = ball(Vector3(place, 0.0, 0.0) + aside, 0.1);
      b.mass = 1.0;
      b.restitution = e;
      b.velocity = {1.0 - 2.0 * place / static_cast<double>(n - 1) + random_.uniform(-0.1, 0.1),
                    0.0, 0.0};
    }
  }

  /// A ball between a wall and one that comes to and fro.
  void press() {
    scene_.G = chance(0.5) ? 0.0 : 9.8;
    plane(Vector3::UnitY());
    const double r = size();
    const double swing = random_.uniform(0.1, 1.5);
    RandomBody& moving =
        plane(-Vector3::UnitY(), {0.0, 2.3 * r + swing * random_.uniform(0.5, 2.0), 0.0});
    moving.swing = {0.0, swing, 0.0};
    moving.frequency = random_.log_uniform(0.1, 3.0);
    ball({0.0, r * random_.uniform(1.0, 1.2), 0.0}, r).velocity = {0.0, random_.uniform(-1.0, 1.0),
                                                                   random_.uniform(-1.0, 1.0)};
  }

  /// A grid of balls or boxes that touch, over a floor.
  void heap() {
    plane(Vector3::UnitY());
    const double h = 0.125;
    const double drop = chance(0.5) ? 0.0 : random_.uniform(0.0, 0.5);
    const bool boxes = chance(0.5);
    const double e = restitution();
    for (std::uint64_t k = 2 + random_.below(7); k > 0; --k) {
      const auto at = static_cast<double>(k);
      const Vector3 position(2.0 * h * std::fmod(at, 3.0),
                             drop + h + 2.0 * h * std::floor(at / 3.0), 0.0);
      RandomBody& b = boxes ? box(position, {h, h, h}) : ball(position, h);
      b.mass = 1.0;
      b.restitution = e;
    }
  }

  /// As it is, or shifted, turned about the vertical and scaled: touching bodies then overlap, or
  /// are apart, by roundoff; they are drawn apart by some of it.
  void place() {
    if (chance(0.4)) {
      return;
    }
    const double scale = random_.log_uniform(1e-2, 1e2);
    const Quaternion turn(chance(0.5)
                              ? Eigen::AngleAxisd(0.0, Vector3::UnitY())
                              : Eigen::AngleAxisd(random_.uniform(0.0, 6.28), Vector3::UnitY()));
    const Vector3 shift =
        chance(0.5) ? Vector3(Vector3::Zero()) : Vector3(random_.direction() * 8.0 * scale);
    const double time = std::sqrt(scale);  // so that free fall looks the same
    scene_.duration *= time;
    scene_.frame *= time;
    for (RandomBody& b : scene_.bodies) {
      b.position = turn * (scale * b.position) + shift;
      b.velocity = turn * (scale / time * b.velocity);
      b.normal = turn * b.normal;
      b.swing = turn * (scale * b.swing);
      b.frequency /= time;
      b.radius *= scale * (1.0 - 0x1p-46);
      b.half_extents *= scale * (1.0 - 0x1p-46);
      if (b.shape == "box") {
        const double angle = b.turned.norm();
        const Quaternion own = angle > 0.0 ? Quaternion(Eigen::AngleAxisd(angle, b.turned / angle))
                                           : Quaternion(Quaternion::Identity());
        const Eigen::AngleAxisd whole(turn * own);
        b.turned = whole.axis() * whole.angle();
      }
    }
  }
};

}  // namespace

RandomScene touching_scene(std::uint64_t seed, std::uint64_t index) {
  return Builder(seed, index).make();
}

RandomScene rough_scene(std::uint64_t seed, std::uint64_t index) {
  RandomScene scene = Builder(seed, index).make();
  scene.name = fmt::format("rough-{}-{}", seed, index);
  Random random(~seed - 2, index);
  for (RandomBody& b : scene.bodies) {
    b.friction = random_friction(random);
  }
  return scene;
}

}  // namespace kairos::experiments
