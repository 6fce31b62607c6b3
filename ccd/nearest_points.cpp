#include "ccd/nearest_points.hpp"

#include "ccd/rounding/roundoff.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kairos::ccd {

Vector3 box_corner(const Vector3& half, int corner) {
  return {(corner & 1) != 0 ? half.x() : -half.x(), (corner & 2) != 0 ? half.y() : -half.y(),
          (corner & 4) != 0 ? half.z() : -half.z()};
}

Vector3 edge_centre(const Vector3& half, int direction, int corner) {
  const int k = (direction + 1) % 3;
  const int l = (direction + 2) % 3;
  Vector3 centre = Vector3::Zero();
  centre[k] = (corner & 1) != 0 ? half[k] : -half[k];
  centre[l] = (corner & 2) != 0 ? half[l] : -half[l];
  return centre;
}

NearestPoints nearest_of_segments(const Vector3& p, const Vector3& u, double su, const Vector3& q,
                                  const Vector3& v, double tv) {
  const Vector3 r = q - p;
  const double cosine = u.dot(v);
  const double along_u = u.dot(r);
  const double along_v = v.dot(r);
  const Vector3 across = u.cross(v);
  const double sine_squared = across.squaredNorm();
  double s = 0.0;
  if (sine_squared > 0.0) {
    // By cross products: an error of roundoff / sine. The usual difference of along_u and
    // cosine * along_v has roundoff / sine^2.
    s = std::clamp(r.cross(v).dot(across) / sine_squared, -su, su);
  } else {
    s = std::clamp(along_u, -su, su);
  }
  const double t = std::clamp(s * cosine - along_v, -tv, tv);
  s = std::clamp(t * cosine + along_u, -su, su);
  NearestPoints nearest{p + s * u, q + t * v, 0.0};
  nearest.distance = (nearest.on_b - nearest.on_a).norm();
  return nearest;
}

NearestPoints nearest_of_boxes(const RelativeBoxes& s) {
  NearestPoints best;
  best.distance = infinity;
  const auto keep = [&best](const Vector3& on_a, const Vector3& on_b) {
    const double distance = (on_b - on_a).norm();
    if (distance < best.distance) {
      best = {on_a, on_b, distance};
    }
  };
  const auto clamped = [](const Vector3& x, const Vector3& half) -> Vector3 {
    return x.cwiseMax(-half).cwiseMin(half);
  };
  for (int c = 0; c < 8; ++c) {
    const Vector3 corner_b = s.d_A + s.axes_A * box_corner(s.half_b, c);
    keep(clamped(corner_b, s.half_a), corner_b);
    const Vector3 corner_a = box_corner(s.half_a, c);
    const Vector3 in_b = s.axes_A.transpose() * (corner_a - s.d_A);
    keep(corner_a, s.d_A + s.axes_A * clamped(in_b, s.half_b));
  }
  // An edge that is farther from the other box than that is nearest to none of its edges: of boxes
  // that lie on each other, most are.
  const double enough = best.distance * (1.0 + 1e-9) + 64.0 * s.error();
  const auto is_far = [enough](const Vector3& centre, const Vector3& along, double half_length,
                               const Vector3& half) {
    const Vector3 beyond = centre.cwiseAbs() - half_length * along.cwiseAbs() - half;
    return beyond.cwiseMax(0.0).squaredNorm() > enough * enough;
  };
  std::array<std::array<bool, 4>, 3> far_a{};
  std::array<std::array<bool, 4>, 3> far_b{};
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    for (int c = 0; c < 4; ++c) {
      const auto corner = static_cast<std::size_t>(c);
      far_a[axis][corner] = is_far(s.axes_A.transpose() * (edge_centre(s.half_a, k, c) - s.d_A),
                                   s.axes_A.row(k).transpose(), s.half_a[k], s.half_b);
      far_b[axis][corner] = is_far(s.d_A + s.axes_A * edge_centre(s.half_b, k, c), s.axes_A.col(k),
                                   s.half_b[k], s.half_a);
    }
  }
  for (int i = 0; i < 3; ++i) {
    const auto& far_i = far_a[static_cast<std::size_t>(i)];
    for (int j = 0; j < 3; ++j) {
      const auto& far_j = far_b[static_cast<std::size_t>(j)];
      for (std::size_t c = 0; c < 16; ++c) {
        if (far_i[c % 4] || far_j[c / 4]) {
          continue;
        }
        const NearestPoints edges = nearest_of_segments(
            edge_centre(s.half_a, i, static_cast<int>(c % 4)), Vector3::Unit(i), s.half_a[i],
            s.d_A + s.axes_A * edge_centre(s.half_b, j, static_cast<int>(c / 4)), s.axes_A.col(j),
            s.half_b[j]);
        if (edges.distance < best.distance) {
          best = edges;
        }
      }
    }
  }
  return best;
}

}  // namespace kairos::ccd
