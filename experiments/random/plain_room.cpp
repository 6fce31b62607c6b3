#include "experiments/random/plain_room.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kairos::experiments {
namespace {

/// Looks at so many times: of a frame, in which no drive of these scenes comes and goes.
constexpr int looks = 256;

Vector3 place(const RandomBody& b, double t) {
  return b.position + std::sin(2.0 * std::numbers::pi * b.frequency * t + b.phase) * b.swing;
}

/// The least distance of two planes between which it fits, m.
double least_width(const RandomBody& b) {
  return b.shape == "sphere" ? 2.0 * b.radius
         : b.shape == "box"  ? 2.0 * b.half_extents.minCoeff()
                             : 0.0;
}

}  // namespace

bool leaves_no_room(const RandomScene& scene, double from, double until) {
  constexpr double opposite = -1.0 + 1e-12;
  double widest = 0.0;
  for (const RandomBody& b : scene.bodies) {
    widest = std::max(widest, b.moves() ? least_width(b) : 0.0);
  }
  const auto is_plane = [](const RandomBody& b) { return b.shape == "half-space"; };
  for (const RandomBody& a : scene.bodies) {
    for (const RandomBody& b : scene.bodies) {
      if (!is_plane(a) || !is_plane(b) || b.swing.isZero(0.0) ||
          !(a.normal.dot(b.normal) < opposite)) {
        continue;
      }
      for (int k = 0; k <= looks; ++k) {
        const double t = from + (until - from) * static_cast<double>(k) / looks;
        if (a.normal.dot(place(b, t) - place(a, t)) < widest) {
          return true;
        }
      }
    }
  }
  return false;
}

}  // namespace kairos::experiments
