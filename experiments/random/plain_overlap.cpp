#include "experiments/random/plain_overlap.hpp"

#include "experiments/random/plain_parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace kairos::experiments {
namespace {

using Real = long double;
using Vector = Eigen::Matrix<Real, 3, 1, Eigen::DontAlign>;
using Matrix = Eigen::Matrix<Real, 3, 3, Eigen::DontAlign>;

struct PlacedBox {
  Vector centre;
  Matrix axes;  ///< columns
  Vector half;

  [[nodiscard]] Real reach(const Vector& direction) const {
    return (axes.transpose() * direction).cwiseAbs().dot(half);
  }
};

Matrix rotation(const Pose& pose) {
  const Eigen::Quaternion<Real> q = pose.orientation.cast<Real>().normalized();
  Matrix r;
  for (int k = 0; k < 3; ++k) {
    r.col(k) = q * Eigen::Matrix<Real, 3, 1>(Eigen::Matrix<Real, 3, 1>::Unit(k));
  }
  return r;
}

PlacedBox placed(const Box& box, const Pose& pose) {
  return {pose.position.cast<Real>(), rotation(pose), box.half_extents.cast<Real>()};
}

Real depth(const Sphere& a, const Pose& at_a, const Sphere& b, const Pose& at_b) {
  const Vector d = at_b.position.cast<Real>() - at_a.position.cast<Real>();
  return Real(a.radius) + Real(b.radius) - d.norm();
}

Real depth(const Sphere& ball, const Pose& at, const Box& box, const Pose& at_box) {
  const PlacedBox b = placed(box, at_box);
  const Vector p = b.axes.transpose() * Vector(at.position.cast<Real>() - b.centre);
  const Vector nearest = p.cwiseMin(b.half).cwiseMax(-b.half);
  const Vector outside = p - nearest;
  if (outside.squaredNorm() > 0) {
    return Real(ball.radius) - outside.norm();
  }
  return Real(ball.radius) + Vector(b.half - p.cwiseAbs()).minCoeff();
}

Real depth(const Box& box_a, const Pose& at_a, const Box& box_b, const Pose& at_b) {
  const PlacedBox a = placed(box_a, at_a);
  const PlacedBox b = placed(box_b, at_b);
  const Vector d = b.centre - a.centre;
  Real least = std::numeric_limits<Real>::infinity();
  const auto look = [&](const Vector& axis) {
    // Any axis along which they are apart proves it, however little edges are off being parallel.
    const Real length = axis.norm();
    if (length > 0) {
      const Vector n = axis / length;
      least = std::min(least, a.reach(n) + b.reach(n) - std::abs(n.dot(d)));
    }
  };
  for (int i = 0; i < 3; ++i) {
    look(a.axes.col(i));
    look(b.axes.col(i));
    for (int j = 0; j < 3; ++j) {
      look(Vector(a.axes.col(i)).cross(Vector(b.axes.col(j))));
    }
  }
  return least;
}

template <typename Solid>
Real depth_below(const HalfSpace& plane, const Pose& at_plane, const Solid& solid, const Pose& at) {
  const Vector n = half_space_normal(plane, at_plane).cast<Real>().normalized();
  const Real height = n.dot(Vector(at.position.cast<Real>() - at_plane.position.cast<Real>()));
  if constexpr (std::is_same_v<Solid, Sphere>) {
    return Real(solid.radius) - height;
  } else {
    return placed(solid, at).reach(n) - height;
  }
}

bool is_plain(const Shape& shape) {
  return std::holds_alternative<Sphere>(shape) || std::holds_alternative<Box>(shape) ||
         std::holds_alternative<HalfSpace>(shape);
}

}  // namespace

double plain_depth(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  const auto* sphere_a = std::get_if<Sphere>(&a);
  const auto* sphere_b = std::get_if<Sphere>(&b);
  const auto* box_a = std::get_if<Box>(&a);
  const auto* box_b = std::get_if<Box>(&b);
  const auto* plane_a = std::get_if<HalfSpace>(&a);
  const auto* plane_b = std::get_if<HalfSpace>(&b);
  Real found = 0;
  if (plane_b != nullptr && plane_a == nullptr) {
    return plain_depth(b, pose_b, a, pose_a);
  }
  if (!is_plain(a) || !is_plain(b)) {
    return plain_parts_depth(a, pose_a, b, pose_b);
  }
  if (plane_a != nullptr && plane_b == nullptr) {
    found = sphere_b != nullptr ? depth_below(*plane_a, pose_a, *sphere_b, pose_b)
                                : depth_below(*plane_a, pose_a, *box_b, pose_b);
  } else if (sphere_a != nullptr && sphere_b != nullptr) {
    found = depth(*sphere_a, pose_a, *sphere_b, pose_b);
  } else if (sphere_a != nullptr && box_b != nullptr) {
    found = depth(*sphere_a, pose_a, *box_b, pose_b);
  } else if (box_a != nullptr && sphere_b != nullptr) {
    found = depth(*sphere_b, pose_b, *box_a, pose_a);
  } else if (box_a != nullptr && box_b != nullptr) {
    found = depth(*box_a, pose_a, *box_b, pose_b);
  }
  return static_cast<double>(std::max(found, Real(0)));
}

}  // namespace kairos::experiments
