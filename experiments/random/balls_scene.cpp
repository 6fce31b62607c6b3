#include "core/random.hpp"
#include "experiments/random/random_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kairos::experiments {
namespace {

/// Makes one scene; its lengths are about 1, and scaled in the end.
class Builder {
 public:
  Builder(std::uint64_t seed, std::uint64_t index)
      : random_(seed ^ (std::uint64_t{1} << 63U), index) {
    scene_.name = fmt::format("balls-{}-{}", seed, index);
  }

  RandomScene make() {
    length_ = random_.log_uniform(1e-2, 1e2);
    speed_ = length_ * random_.log_uniform(0.3, 30.0);
    room();
    // One in twenty has so many that motions are kept as flights only.
    balls_ = chance(0.05) ? 130 + random_.below(60) : 4 + random_.below(60);
    radii();
    const bool loses = chance(0.3);
    const double least = loses ? random_.uniform(0.5, 1.0) : 1.0;
    const bool one_mass = chance(0.4);
    for (std::uint64_t k = 0; k < balls_; ++k) {
      RandomBody b;
      b.entity = chance(0.9) ? "ball" : "body";
      b.shape = "sphere";
      b.radius = chance(share_of_large_) ? large_ : usual_ * random_.uniform(spread_, 1.0);
      b.mass = one_mass ? 1.0 : random_.log_uniform(1e-2, 1e2);
      const Vector3 way = random_.direction();
      b.velocity = speed_ * random_.uniform(0.0, 1.5) * way;
      b.restitution = loses ? random_.uniform(least, 1.0) : 1.0;
      b.name = fmt::format("ball-{}", k + 1);
      place(b);
    }
    // As long as it takes to meet some others.
    scene_.duration = random_.log_uniform(0.3, 3.0) * length_ / speed_;
    scene_.frame = scene_.duration / 16.0;
    return std::move(scene_);
  }

 private:
  bool chance(double p) { return random_.uniform() < p; }

  /// Walls, or none, or a box that is repeated.
  void room() {
    const bool repeats = chance(0.35);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<int>(k);
      side_[axis] = length_ * random_.uniform(0.5, 1.5);
      scene_.repeated[k] = repeats && chance(0.7);
      if (scene_.repeated[k] || (!repeats && chance(0.1))) {
        continue;
      }
      for (const double at : {-0.5, 0.5}) {
        RandomBody wall;
        wall.name = fmt::format("wall-{}", ++walls_);
        wall.entity = "wall";
        wall.shape = "half-space";
        wall.normal = (at < 0.0 ? 1.0 : -1.0) * Vector3::Unit(axis);
        wall.position = at * side_[axis] * Vector3::Unit(axis);
        scene_.bodies.push_back(wall);
      }
    }
    scene_.low = -0.5 * side_;
    scene_.high = 0.5 * side_;
    if (!scene_.repeated[1] && chance(0.4)) {
      scene_.G = random_.log_uniform(0.1, 10.0) * speed_ * speed_ / length_;
    }
  }

  /// Such that together they fill a part of the room: thin, or nearly as dense as chance allows.
  void radii() {
    const double fraction = random_.log_uniform(1e-3, 0.2);
    spread_ = chance(0.5) ? 1.0 : random_.uniform(0.3, 1.0);
    usual_ = std::cbrt(fraction * side_.prod() * 3.0 /
                       (4.0 * std::numbers::pi * static_cast<double>(balls_)));
    usual_ = std::min(usual_, 0.11 * side_.minCoeff());
    // Some are so large that they are in no cell.
    share_of_large_ = chance(0.3) ? 0.05 : 0.0;
    large_ = std::min(random_.uniform(2.0, 5.0) * usual_, 0.11 * side_.minCoeff());
  }

  /// Where it overlaps nothing, if a place is found.
  void place(RandomBody b) {
    for (int attempt = 0; attempt < 30; ++attempt) {
      for (int axis = 0; axis < 3; ++axis) {
        b.position[axis] = random_.uniform(-0.5, 0.5) * side_[axis];
      }
      if (std::all_of(scene_.bodies.begin(), scene_.bodies.end(),
                      [&](const RandomBody& other) { return apart(b, other); })) {
        scene_.bodies.push_back(b);
        return;
      }
    }
  }

  [[nodiscard]] bool apart(const RandomBody& b, const RandomBody& other) const {
    if (other.shape == "half-space") {
      return other.normal.dot(b.position - other.position) > 1.001 * b.radius;
    }
    Vector3 d = b.position - other.position;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<int>(k);
      d[axis] -= scene_.repeated[k] ? side_[axis] * std::round(d[axis] / side_[axis]) : 0.0;
    }
    return d.norm() > 1.001 * (b.radius + other.radius);
  }

  Random random_;
  RandomScene scene_;
  double length_ = 1.0;
  double speed_ = 1.0;
  Vector3 side_ = Vector3::Ones();
  std::uint64_t balls_ = 0;
  double usual_ = 0.0;
  double spread_ = 1.0;
  double large_ = 0.0;
  double share_of_large_ = 0.0;
  int walls_ = 0;
};

}  // namespace

RandomScene balls_scene(std::uint64_t seed, std::uint64_t index) {
  return Builder(seed, index).make();
}

}  // namespace kairos::experiments
