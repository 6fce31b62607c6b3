#include "ccd/convex_core.hpp"

#include "ccd/rounding/roundoff.hpp"
#include "core/circular.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

constexpr double u = unit_roundoff;

/// Length of m across y.
double across(const Vector3& m) { return std::sqrt(m.x() * m.x() + m.z() * m.z()); }

Vector3 on_rim(const Vector3& m, double radius, double y) {
  const double length = across(m);
  if (!(length > 0.0)) {
    return {radius, y, 0.0};
  }
  return {m.x() / length * radius, y, m.z() / length * radius};
}

/// Greatest m . x of points that turn about w: along the axis they stay, across it they turn round.
double turned(const Vector3& x, const Vector3& n, const Vector3& w) {
  return n.dot(w) * x.dot(w) + n.cross(w).norm() * x.cross(w).norm();
}

}  // namespace

ConvexCore ConvexCore::point(double rounding) {
  ConvexCore core;
  core.rounding_ = rounding;
  return core;
}

ConvexCore ConvexCore::segment(double half, double rounding) {
  ConvexCore core;
  core.kind_ = Kind::segment;
  core.sizes_ = {0.0, half, half};
  core.rounding_ = rounding;
  core.radius_ = core.extent_ = half;
  return core;
}

ConvexCore ConvexCore::box(const Vector3& half_extents) {
  ConvexCore core;
  core.kind_ = Kind::box;
  core.sizes_ = half_extents;
  core.radius_ = half_extents.norm() * (1.0 + 4.0 * u);
  core.extent_ = half_extents.sum();
  core.width_ = 2.0 * half_extents.minCoeff();
  return core;
}

ConvexCore ConvexCore::cylinder(double radius, double half, double rounding) {
  ConvexCore core;
  core.kind_ = Kind::cylinder;
  core.sizes_ = {radius, half, half};
  core.rounding_ = rounding;
  core.radius_ = hypotenuse(radius, half) * (1.0 + 4.0 * u);
  core.extent_ = half + std::sqrt(2.0) * radius;
  core.width_ = 2.0 * std::min(radius, half);
  return core;
}

ConvexCore ConvexCore::cone(double radius, double height, double rounding) {
  ConvexCore core;
  core.kind_ = Kind::cone;
  core.sizes_ = {radius, 0.25 * height, 0.75 * height};
  core.rounding_ = rounding;
  core.radius_ = std::max(0.75 * height, hypotenuse(radius, 0.25 * height)) * (1.0 + 4.0 * u);
  core.extent_ = std::max(0.75 * height, 0.25 * height + std::sqrt(2.0) * radius);
  core.width_ = std::min(height, 2.0 * radius * height / hypotenuse(radius, height));
  return core;
}

ConvexCore ConvexCore::of(const Polytope& polytope, double rounding) {
  ConvexCore core;
  core.kind_ = Kind::polytope;
  core.polytope_ = &polytope;
  core.rounding_ = rounding;
  core.radius_ = polytope.radius * (1.0 + 4.0 * u);
  core.extent_ = polytope.extent;
  core.width_ = polytope.width;
  return core;
}

ConvexCore ConvexCore::triangle(const Vector3* vertices,
                                const std::array<std::uint32_t, 3>& corners) {
  ConvexCore core;
  core.kind_ = Kind::triangle;
  core.triangle_ = vertices;
  core.corners_ = corners;
  for (std::size_t i = 0; i < 3; ++i) {
    core.radius_ = std::max(core.radius_, core.corner(i).norm() * (1.0 + 4.0 * u));
    core.extent_ = std::max(core.extent_, core.corner(i).lpNorm<1>());
  }
  return core;
}

/// Axes are off by 8 u an entry where they come from a quaternion, and are applied with as many
/// roundings again as they are by the body's own turning: twice the extent has room for both.
ConvexCore ConvexCore::placed(const PlacedCore& part) {
  ConvexCore core;
  core.kind_ = Kind::placed;
  core.part_ = &part;
  core.rounding_ = part.core.rounding_;
  core.radius_ = (part.centre.norm() + part.core.radius_) * (1.0 + 32.0 * u);
  core.extent_ = 2.0 * (part.centre.lpNorm<1>() + 1.75 * part.core.extent_);
  core.width_ = part.core.width_;
  return core;
}

bool ConvexCore::has_volume() const {
  return kind_ == Kind::placed ? part_->core.has_volume() : kind_ > Kind::segment;
}

bool ConvexCore::is_round() const {
  return kind_ == Kind::placed ? part_->core.is_round()
                               : kind_ == Kind::cylinder || kind_ == Kind::cone;
}

ConvexCore::Line ConvexCore::line() const {
  if (kind_ == Kind::placed) {
    const Line inner = part_->core.line();
    return {part_->centre + part_->axes * inner.middle, part_->axes * inner.direction, inner.half};
  }
  return {Vector3::Zero(), Vector3::UnitY(), sizes_.y()};
}

ConvexCore::Bend ConvexCore::bend(const Vector3& m) const {
  if (kind_ == Kind::placed) {
    const Bend inner = part_->core.bend(part_->axes.transpose() * m);
    return {inner.radius, part_->axes * inner.tangent};
  }
  const double length = across(m);
  if (!is_round() || !(length > 1e-6)) {
    return {};
  }
  return {sizes_.x() / length, Vector3(m.z() / length, 0.0, -m.x() / length)};
}

ConvexCore::Rim ConvexCore::rim(const Vector3& m) const {
  if (kind_ == Kind::placed) {
    const Rim inner = part_->core.rim(part_->axes.transpose() * m);
    return {part_->centre + part_->axes * inner.middle, part_->axes * inner.axis, inner.radius};
  }
  if (kind_ == Kind::cylinder) {
    return {Vector3(0.0, m.y() < 0.0 ? -sizes_.y() : sizes_.y(), 0.0), Vector3::UnitY(),
            sizes_.x()};
  }
  if (kind_ == Kind::cone && m.y() < 0.0) {
    return {Vector3(0.0, -sizes_.y(), 0.0), Vector3::UnitY(), sizes_.x()};
  }
  return {};
}

/// All vertices are compared: a walk uphill along edges may end below the highest by any amount if
/// edges are short.
std::uint32_t ConvexCore::support_vertex(const Vector3& m) const {
  const std::vector<Vector3>& vertices = polytope_->vertices;
  std::size_t best = 0;
  double most = m.dot(vertices[0]);
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    const double x = m.dot(vertices[i]);
    if (x > most) {
      most = x;
      best = i;
    }
  }
  return static_cast<std::uint32_t>(best);
}

double ConvexCore::support(const Vector3& m) const {
  switch (kind_) {
    case Kind::point:
      return 0.0;
    case Kind::segment:
      return sizes_.y() * std::abs(m.y());
    case Kind::box:
      return sizes_.dot(m.cwiseAbs());
    case Kind::cylinder:
      return sizes_.x() * across(m) + sizes_.y() * std::abs(m.y());
    case Kind::cone:
      return std::max(sizes_.z() * m.y(), sizes_.x() * across(m) - sizes_.y() * m.y());
    case Kind::triangle:
      return std::max({m.dot(corner(0)), m.dot(corner(1)), m.dot(corner(2))});
    case Kind::placed:
      return m.dot(part_->centre) + part_->core.support(part_->axes.transpose() * m);
    case Kind::polytope:
      break;
  }
  double most = m.dot(polytope_->vertices[0]);
  for (const Vector3& x : polytope_->vertices) {
    most = std::max(most, m.dot(x));
  }
  return most;
}

Vector3 ConvexCore::support_point(const Vector3& m) const {
  switch (kind_) {
    case Kind::point:
      return Vector3::Zero();
    case Kind::segment:
      return {0.0, m.y() < 0.0 ? -sizes_.y() : sizes_.y(), 0.0};
    case Kind::box:
      return {m.x() < 0.0 ? -sizes_.x() : sizes_.x(), m.y() < 0.0 ? -sizes_.y() : sizes_.y(),
              m.z() < 0.0 ? -sizes_.z() : sizes_.z()};
    case Kind::cylinder:
      return on_rim(m, sizes_.x(), m.y() < 0.0 ? -sizes_.y() : sizes_.y());
    case Kind::cone:
      return sizes_.z() * m.y() >= sizes_.x() * across(m) - sizes_.y() * m.y()
                 ? Vector3(0.0, sizes_.z(), 0.0)
                 : on_rim(m, sizes_.x(), -sizes_.y());
    case Kind::triangle: {
      const double first = m.dot(corner(0));
      const double second = m.dot(corner(1));
      const double third = m.dot(corner(2));
      return corner(third > std::max(first, second) ? 2 : second > first ? 1 : 0);
    }
    case Kind::placed:
      return part_->centre + part_->axes * part_->core.support_point(part_->axes.transpose() * m);
    case Kind::polytope:
      break;
  }
  return polytope_->vertices[support_vertex(m)];
}

Vector3 ConvexCore::side_line(const Vector3& m) const {
  return (Vector3(0.0, sizes_.z(), 0.0) - on_rim(m, sizes_.x(), -sizes_.y())).normalized();
}

Feature ConvexCore::feature(const Vector3& m, double noise) const {
  Feature best;
  double least = noise;
  nearby(
      m,
      [&](const Vector3& n) {
        if ((m - n).squaredNorm() <= noise * noise) {
          best = {2, n};
        }
      },
      [&](const Vector3& e) {
        const double along = std::abs(m.dot(e));
        if (best.dimension < 2 && along <= least) {
          best = {1, e};
          least = along;
        }
      });
  return best;
}

template <typename Visit>
void ConvexCore::each_hull_point(const Visit& visit) const {
  switch (kind_) {
    case Kind::polytope:
      for (const Vector3& x : polytope_->vertices) {
        visit(x);
      }
      return;
    case Kind::triangle:
      for (std::size_t i = 0; i < 3; ++i) {
        visit(corner(i));
      }
      return;
    case Kind::placed:
      return;
    default:
      break;
  }
  const double r = kind_ == Kind::box ? 0.0 : sizes_.x();
  const Vector3 low = kind_ == Kind::box ? Vector3(-sizes_) : Vector3(-r, -sizes_.y(), -r);
  const Vector3 high = kind_ == Kind::box ? sizes_ : Vector3(r, sizes_.z(), r);
  for (int corner = 0; corner < 8; ++corner) {
    visit(Vector3((corner & 1) != 0 ? high.x() : low.x(), (corner & 2) != 0 ? high.y() : low.y(),
                  (corner & 4) != 0 ? high.z() : low.z()));
  }
}

double ConvexCore::spun_support(const Vector3& n, const Vector3& w) const {
  double most = -infinity;
  if (kind_ == Kind::placed) {
    part_->core.each_hull_point([&](const Vector3& x) {
      most = std::max(most, turned(part_->centre + part_->axes * x, n, w));
    });
    return most;
  }
  each_hull_point([&](const Vector3& x) { most = std::max(most, turned(x, n, w)); });
  if (kind_ == Kind::polytope || kind_ == Kind::triangle || kind_ == Kind::box) {
    return most;
  }
  // Turned about nearly its own axis it sweeps little more than itself: a turn about w differs from
  // one about y by at most twice the angle between them.
  const double tilt = 4.0 * std::sqrt(w.x() * w.x() + w.z() * w.z()) * radius_;
  return std::min(most, support(n) + tilt);
}

}  // namespace kairos::ccd
