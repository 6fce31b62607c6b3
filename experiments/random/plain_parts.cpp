#include "experiments/random/plain_parts.hpp"

#include "core/compound_body.hpp"
#include "core/mesh_body.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace kairos::experiments {
namespace {

using Real = long double;
using Vector = Eigen::Matrix<Real, 3, 1, Eigen::DontAlign>;
using Matrix = Eigen::Matrix<Real, 3, 3, Eigen::DontAlign>;

constexpr Real infinity = std::numeric_limits<Real>::infinity();

/// A convex part in the world: the hull of points, of circles about its own y axis, of balls.
struct Part {
  struct Disc {
    Vector centre;    ///< world
    Real radius = 0;  ///< of a circle across the axis
  };
  std::vector<Disc> discs;
  Vector axis = Vector::UnitY();
  Real rounding = 0;  ///< of a ball about every point
  Vector middle = Vector::Zero();
  Real reach = 0;  ///< of a ball about the middle that holds it

  [[nodiscard]] Vector highest(const Vector& n) const {
    // A product that is across the axis however nearly parallel n is: a difference would be noise.
    const Vector across = axis.cross(n.cross(axis));
    const Real sine = across.norm();
    Vector best = Vector::Zero();
    Real most = -infinity;
    for (const Disc& disc : discs) {
      const Real height = n.dot(disc.centre) + disc.radius * sine;
      if (height > most) {
        most = height;
        best = disc.centre;
        if (disc.radius > 0 && sine > 0) {
          best += across * (disc.radius / sine);
        }
      }
    }
    return best + n * (rounding / n.norm());
  }
  void measure() {
    for (const Disc& disc : discs) {
      middle += disc.centre / static_cast<Real>(discs.size());
    }
    for (const Disc& disc : discs) {
      reach = std::max(reach, (disc.centre - middle).norm() + disc.radius + rounding);
    }
  }
};

struct Place {
  Vector p;
  Matrix R;
  [[nodiscard]] Vector operator()(const Vector& x) const { return p + R * x; }
};

Place place(const Pose& pose) {
  const Eigen::Quaternion<Real> q = pose.orientation.cast<Real>().normalized();
  Place placed;
  placed.p = pose.position.cast<Real>();
  for (int k = 0; k < 3; ++k) {
    placed.R.col(k) = q * Eigen::Matrix<Real, 3, 1>(Eigen::Matrix<Real, 3, 1>::Unit(k));
  }
  return placed;
}

Part convex_part(const Shape& shape, const Place& at) {
  Part part;
  part.axis = at.R.col(1);
  const auto add = [&](const Vector& x, Real radius) { part.discs.push_back({at(x), radius}); };
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    add(Vector::Zero(), 0);
    part.rounding = sphere->radius;
  } else if (const auto* box = std::get_if<Box>(&shape)) {
    for (int k = 0; k < 8; ++k) {
      const Vector sign((k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1, (k & 4) != 0 ? 1 : -1);
      add(sign.cwiseProduct(box->half_extents.cast<Real>()), 0);
    }
  } else if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    add({0, Real(capsule->length) / 2, 0}, 0);
    add({0, -Real(capsule->length) / 2, 0}, 0);
    part.rounding = capsule->radius;
  } else if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    add({0, Real(cylinder->length) / 2, 0}, cylinder->radius);
    add({0, -Real(cylinder->length) / 2, 0}, cylinder->radius);
  } else if (const auto* cone = std::get_if<Cone>(&shape)) {
    add({0, 3 * Real(cone->height) / 4, 0}, 0);
    add({0, -Real(cone->height) / 4, 0}, cone->radius);
  } else if (const auto* hull = std::get_if<Hull>(&shape)) {
    for (const Vector3& v : hull->core->vertices) {
      add(v.cast<Real>(), 0);
    }
    part.rounding = hull->rounding;
  }
  part.measure();
  return part;
}

std::vector<Part> parts_of(const Shape& shape, const Place& at) {
  std::vector<Part> parts;
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    const CollisionMesh& triangles = mesh->body->mesh;
    for (const Triangle& t : triangles.triangles()) {
      Part part;
      for (const std::uint32_t corner : t) {
        part.discs.push_back({at(triangles.vertices()[corner].cast<Real>()), 0});
      }
      part.measure();
      parts.push_back(std::move(part));
    }
  } else if (const auto* compound = std::get_if<Compound>(&shape)) {
    for (const CompoundPart& own : compound->body->parts) {
      const Place inner = place(own.pose);
      parts.push_back(convex_part(own.shape, {at(inner.p), at.R * inner.R}));
    }
  } else {
    parts.push_back(convex_part(shape, at));
  }
  return parts;
}

/// Weights, of sum 1, of the point of least norm of the affine hull of points; false: no basis.
bool affine_weights(const std::vector<Vector>& points, std::vector<Real>& weights) {
  using Square = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, 0, 5, 5>;
  using Column = Eigen::Matrix<Real, Eigen::Dynamic, 1, 0, 5, 1>;
  const auto n = static_cast<Eigen::Index>(points.size());
  if (n > 4) {
    return false;
  }
  Square M = Square::Zero(n + 1, n + 1);
  Column right = Column::Zero(n + 1);
  right[n] = 1;
  for (Eigen::Index i = 0; i < n; ++i) {
    M(i, n) = M(n, i) = 1;
    for (Eigen::Index k = 0; k < n; ++k) {
      M(i, k) = points[static_cast<std::size_t>(i)].dot(points[static_cast<std::size_t>(k)]);
    }
  }
  const Column x = M.fullPivLu().solve(right);
  weights.assign(x.data(), x.data() + n);
  // Of points that are no basis any sum may come out.
  return x.allFinite() && std::abs(x.head(n).sum() - 1) < 1e-9L;
}

/// Wolfe's algorithm on the points of b + by - a.
class LeastNorm {
 public:
  LeastNorm(const Part& a, const Part& b, const Vector& by) : a_(a), b_(b), by_(by) {}

  /// Is 0 one of them, up to `roundoff`? Not if a direction shows them apart.
  [[nodiscard]] bool holds_zero(Real roundoff) {
    constexpr int most_steps = 400;
    Vector x = point(b_.middle + by_ - a_.middle);
    corral_ = {x};
    weights_ = {1};
    for (int i = 0; i < most_steps; ++i) {
      if (!(x.norm() > roundoff)) {
        return true;
      }
      const Vector next = point(x);
      if (x.dot(next) > 0) {
        return false;
      }
      corral_.push_back(next);
      weights_.push_back(0);
      if (!settle()) {
        return false;
      }
      Vector nearer = Vector::Zero();
      for (std::size_t k = 0; k < corral_.size(); ++k) {
        nearer += weights_[k] * corral_[k];
      }
      if (corral_.size() == 4 && around_zero()) {
        return true;
      }
      // No progress: what is left is roundoff of the coordinates.
      if (corral_.size() == 4 || !(nearer.squaredNorm() < x.squaredNorm())) {
        return !(nearer.norm() > roundoff);
      }
      x = nearer;
    }
    return false;
  }

 private:
  /// The point that is lowest along n.
  [[nodiscard]] Vector point(const Vector& n) const { return b_.highest(-n) + by_ - a_.highest(n); }

  /// Is 0 in the tetrahedron of four points? By the signs of four volumes.
  [[nodiscard]] bool around_zero() const {
    const auto volume = [](const Vector& a, const Vector& b, const Vector& c) {
      return a.dot(b.cross(c));
    };
    const std::vector<Vector>& p = corral_;
    const std::array<Real, 4> volumes{volume(p[1], p[2], p[3]), -volume(p[0], p[2], p[3]),
                                      volume(p[0], p[1], p[3]), -volume(p[0], p[1], p[2])};
    Real size = 0;
    for (const Vector& x : p) {
      size = std::max(size, x.norm());
    }
    const Real hidden = 1e-17L * size * size * size;
    return std::all_of(volumes.begin(), volumes.end(), [&](Real v) { return v > hidden; }) ||
           std::all_of(volumes.begin(), volumes.end(), [&](Real v) { return v < -hidden; });
  }

  /// Drops points until that of least norm of the affine hull is within the others.
  [[nodiscard]] bool settle() {
    constexpr Real nothing = 1e-18L;
    for (bool settled = false; !settled;) {
      std::vector<Real> target;
      if (!affine_weights(corral_, target)) {
        return false;
      }
      Real part = 1;
      for (std::size_t k = 0; k < corral_.size(); ++k) {
        if (target[k] < nothing) {
          part = std::min(part, weights_[k] / (weights_[k] - target[k]));
        }
      }
      settled = part == 1;
      std::size_t kept = 0;
      for (std::size_t k = 0; k < corral_.size(); ++k) {
        const Real w = weights_[k] + part * (target[k] - weights_[k]);
        if (w > nothing) {
          corral_[kept] = corral_[k];
          weights_[kept++] = w;
        } else {
          settled = false;
        }
      }
      corral_.resize(kept);
      weights_.resize(kept);
      if (kept == 0) {
        return false;
      }
    }
    return true;
  }

  const Part& a_;
  const Part& b_;
  Vector by_;
  std::vector<Vector> corral_;
  std::vector<Real> weights_;
};

bool overlap(const Part& a, const Part& b, const Vector& by) {
  const Vector d = b.middle + by - a.middle;
  const Real reach = a.reach + b.reach;
  if (d.norm() > reach) {
    return false;
  }
  return LeastNorm(a, b, by).holds_zero(1e-17L * (a.middle.norm() + b.middle.norm() + reach));
}

/// The greatest power of four of their size by which they may be moved along each axis.
Real depth(const Part& a, const Part& b) {
  if (!overlap(a, b, Vector::Zero())) {
    return 0;
  }
  Real proven = 0;
  for (Real by = std::min(a.reach, b.reach) * 0x1p-50L; by < a.reach + b.reach; by *= 4) {
    for (int k = 0; k < 3; ++k) {
      const Vector step = by * Vector::Unit(k);
      if (!overlap(a, b, step) || !overlap(a, b, -step)) {
        return proven;
      }
    }
    proven = by / std::sqrt(Real(3));  // the octahedron of these holds a ball of this radius
  }
  return proven;
}

/// Under what angle is a surface seen from x, over 4 pi: 1 inside, 0 outside [VanOosterom1983]?
Real turns(const std::vector<Part>& triangles, const Vector& x) {
  Real angle = 0;
  for (const Part& t : triangles) {
    const Vector a = t.discs[0].centre - x;
    const Vector b = t.discs[1].centre - x;
    const Vector c = t.discs[2].centre - x;
    const Real la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)),
                            la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4 * std::acos(Real(-1)));
}

Real depth_inside(const Shape& solid, const std::vector<Part>& surface,
                  const std::vector<Part>& parts) {
  const auto* mesh = std::get_if<Mesh>(&solid);
  if (mesh == nullptr || !mesh->body->mesh.solid()) {
    return 0;
  }
  for (const Part& part : parts) {
    const bool clear = std::none_of(surface.begin(), surface.end(), [&](const Part& triangle) {
      return overlap(part, triangle, Vector::Zero());
    });
    if (clear && turns(surface, part.middle) > 0.5L) {
      return part.reach;
    }
  }
  return 0;
}

Real depth_below(const HalfSpace& plane, const Pose& at_plane, const std::vector<Part>& parts) {
  const Vector n = half_space_normal(plane, at_plane).cast<Real>().normalized();
  Real least = infinity;
  for (const Part& part : parts) {
    least = std::min(least, n.dot(Vector(part.highest(-n) - at_plane.position.cast<Real>())));
  }
  return -least;
}

}  // namespace

double plain_parts_depth(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  const std::vector<Part> parts_b = parts_of(b, place(pose_b));
  if (const auto* plane = std::get_if<HalfSpace>(&a)) {
    return static_cast<double>(std::max(Real(0), depth_below(*plane, pose_a, parts_b)));
  }
  const Real away = (pose_b.position - pose_a.position).cast<Real>().norm();
  if (away > Real(bounding_radius(a)) + Real(bounding_radius(b))) {
    return 0.0;
  }
  const std::vector<Part> parts_a = parts_of(a, place(pose_a));
  Real deepest = 0;
  for (const Part& part_a : parts_a) {
    for (const Part& part_b : parts_b) {
      deepest = std::max(deepest, depth(part_a, part_b));
    }
  }
  deepest = std::max(deepest, depth_inside(a, parts_a, parts_b));
  return static_cast<double>(std::max(deepest, depth_inside(b, parts_b, parts_a)));
}

}  // namespace kairos::experiments
