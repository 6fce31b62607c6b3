#include "tests/judge/lasting/touching.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos::judge {
namespace {

using Flat = Eigen::Matrix<Real, 2, 1>;

std::vector<Vector> corners(const Box& box, const Moment& at) {
  std::vector<Vector> out;
  const Vector h = real(box.half_extents);
  for (int k = 0; k < 8; ++k) {
    const Vector signs((k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1, (k & 4) != 0 ? 1 : -1);
    out.emplace_back(at.position + at.turned * signs.cwiseProduct(h));
  }
  return out;
}

Vector normal_of(const HalfSpace& plane, const Moment& at) {
  return (at.turned * real(plane.normal_B)).normalized();
}

// --- Balls -------------------------------------------------------------------------------------

/// Of two points with radii.
Nearness of_balls(const Vector& a, Real ra, const Vector& b, Real rb, Real margin) {
  const Real distance = (b - a).norm();
  Nearness found{distance - ra - rb, {}};
  if (found.gap <= margin && distance > 0) {
    const Vector n = (b - a) / distance;
    found.points.push_back({a + (ra + found.gap / 2) * n, n});
  }
  return found;
}

Nearness of_box_and_ball(const Box& box, const Moment& at, const Vector& centre, Real radius,
                         Real margin) {
  const Vector h = real(box.half_extents);
  const Vector local = at.turned.transpose() * (centre - at.position);
  const Vector foot = local.cwiseMin(h).cwiseMax(-h);
  if ((local - foot).squaredNorm() > 0) {
    return of_balls(at.position + at.turned * foot, 0, centre, radius, margin);
  }
  return {-(h - local.cwiseAbs()).minCoeff() - radius, {}};
}

Nearness over_plane(const HalfSpace& plane, const Moment& at, const std::vector<Vector>& points,
                    Real radius, Real margin) {
  const Vector n = normal_of(plane, at);
  Nearness found{std::numeric_limits<Real>::infinity(), {}};
  for (const Vector& x : points) {
    const Real gap = n.dot(x - at.position) - radius;
    found.gap = std::min(found.gap, gap);
    if (gap <= margin) {
      found.points.push_back({x - (radius + gap / 2) * n, n});
    }
  }
  return found;
}

// --- Two boxes ---------------------------------------------------------------------------------

/// A convex set of up to four points of a plane, in order around it.
struct Patch {
  std::vector<Flat> points;

  void order() {
    if (points.size() < 3) {
      return;
    }
    Flat middle = Flat::Zero();
    for (const Flat& p : points) {
      middle += p / static_cast<Real>(points.size());
    }
    std::sort(points.begin(), points.end(), [&](const Flat& p, const Flat& q) {
      return std::atan2(p.y() - middle.y(), p.x() - middle.x()) <
             std::atan2(q.y() - middle.y(), q.x() - middle.x());
    });
  }

  [[nodiscard]] std::size_t sides() const {
    return points.size() < 3 ? points.size() - 1 : points.size();
  }
  [[nodiscard]] const Flat& from(std::size_t k) const { return points[k]; }
  [[nodiscard]] const Flat& to(std::size_t k) const { return points[(k + 1) % points.size()]; }

  [[nodiscard]] Real distance(const Flat& x) const {
    Real least = (x - points[0]).norm();
    bool inside = points.size() > 2;
    for (std::size_t k = 0; k < sides(); ++k) {
      const Flat e = to(k) - from(k);
      const Flat d = x - from(k);
      const Real along = std::clamp<Real>(d.dot(e) / e.squaredNorm(), 0, 1);
      least = std::min(least, (d - along * e).norm());
      inside = inside && e.x() * d.y() - e.y() * d.x() >= 0;
    }
    return inside ? 0 : least;
  }
};

/// Points that span what two patches share, to `tolerance`.
std::vector<Flat> shared(const Patch& a, const Patch& b, Real tolerance) {
  std::vector<Flat> out;
  const auto add = [&](const Flat& x) {
    for (const Flat& y : out) {
      if ((x - y).norm() <= tolerance) {
        return;
      }
    }
    out.push_back(x);
  };
  for (const auto& [one, other] : {std::pair(&a, &b), {&b, &a}}) {
    for (const Flat& x : one->points) {
      if (other->distance(x) <= tolerance) {
        add(x);
      }
    }
  }
  for (std::size_t i = 0; i < a.sides(); ++i) {
    for (std::size_t j = 0; j < b.sides(); ++j) {
      const Flat e = a.to(i) - a.from(i);
      const Flat f = b.to(j) - b.from(j);
      const Flat d = b.from(j) - a.from(i);
      const Real det = e.x() * f.y() - e.y() * f.x();
      if (std::abs(det) <= 1e-9L * e.norm() * f.norm()) {
        continue;
      }
      const Real s = (d.x() * f.y() - d.y() * f.x()) / det;
      const Real t = (d.x() * e.y() - d.y() * e.x()) / det;
      if (s >= 0 && s <= 1 && t >= 0 && t <= 1) {
        add(a.from(i) + s * e);
      }
    }
  }
  return out;
}

struct TwoBoxes {
  Vector between;
  std::vector<Vector> a;
  std::vector<Vector> b;
  Real size;

  [[nodiscard]] static Real farthest(const std::vector<Vector>& points, const Vector& n) {
    Real most = -std::numeric_limits<Real>::infinity();
    for (const Vector& x : points) {
      most = std::max(most, n.dot(x));
    }
    return most;
  }

  /// How far apart they are along n.
  [[nodiscard]] Real gap(const Vector& n) const { return -farthest(b, -n) - farthest(a, n); }

  /// Adds where they touch that is extreme along n, within the margin.
  void touch(const Vector& n, Real margin, std::vector<TouchPoint>& points) const {
    const Vector u = n.unitOrthogonal();
    const Vector v = n.cross(u);
    const auto extreme = [&](const std::vector<Vector>& all, const Vector& direction) {
      Patch patch;
      const Real most = farthest(all, direction);
      for (const Vector& x : all) {
        if (most - direction.dot(x) <= 2 * margin) {
          patch.points.emplace_back(u.dot(x), v.dot(x));
        }
      }
      patch.order();
      return patch;
    };
    const Real height = (farthest(a, n) - farthest(b, -n)) / 2;
    for (const Flat& x : shared(extreme(a, n), extreme(b, -n), 1e-9L * size)) {
      const TouchPoint point{u * x.x() + v * x.y() + n * height, n};
      // Faces that look at each other are extreme along the axes of both.
      const bool known = std::any_of(points.begin(), points.end(), [&](const TouchPoint& p) {
        return (p.at - point.at).norm() <= 1e-9L * size && (p.normal - n).norm() <= 1e-12L;
      });
      if (!known) {
        points.push_back(point);
      }
    }
  }
};

Nearness of_boxes(const Box& a, const Moment& at_a, const Box& b, const Moment& at_b, Real margin) {
  const TwoBoxes both{at_b.position - at_a.position, corners(a, at_a), corners(b, at_b),
                      real(a.half_extents).norm() + real(b.half_extents).norm()};
  std::vector<Vector> axes;
  std::vector<Vector> of_near_parallel;  // they separate edges that pass by each other, no faces
  for (int i = 0; i < 3; ++i) {
    axes.emplace_back(at_a.turned.col(i));
    axes.emplace_back(at_b.turned.col(i));
    for (int j = 0; j < 3; ++j) {
      const Vector m = Vector(at_a.turned.col(i)).cross(Vector(at_b.turned.col(j)));
      if (m.norm() > 0) {  // where they touch along nearly parallel edges, faces tell
        (m.norm() > 1e-6L ? axes : of_near_parallel).emplace_back(m.normalized());
      }
    }
  }
  Nearness found{-std::numeric_limits<Real>::infinity(), {}};
  for (Vector& n : axes) {
    n = n.dot(both.between) < 0 ? Vector(-n) : n;
    found.gap = std::max(found.gap, both.gap(n));
  }
  for (const Vector& n : of_near_parallel) {
    found.gap = std::max({found.gap, both.gap(n), both.gap(-n)});
  }
  if (found.gap > margin) {
    return found;
  }
  for (const Vector& n : axes) {
    if (both.gap(n) >= -margin) {
      both.touch(n, margin, found.points);
    }
  }
  return found;
}

}  // namespace

bool known(const Shape& shape) {
  return std::holds_alternative<Sphere>(shape) || std::holds_alternative<Box>(shape) ||
         std::holds_alternative<HalfSpace>(shape);
}

Real reach(const Shape& shape) {
  if (const auto* ball = std::get_if<Sphere>(&shape)) {
    return ball->radius;
  }
  const auto* box = std::get_if<Box>(&shape);
  return box == nullptr ? 0 : real(box->half_extents).norm();
}

Nearness nearness(const Shape& a, const Moment& at_a, const Shape& b, const Moment& at_b,
                  Real margin) {
  const auto* ball_a = std::get_if<Sphere>(&a);
  const auto* ball_b = std::get_if<Sphere>(&b);
  const auto* box_a = std::get_if<Box>(&a);
  const auto* box_b = std::get_if<Box>(&b);
  const auto* plane_a = std::get_if<HalfSpace>(&a);
  if (plane_a != nullptr && ball_b != nullptr) {
    return over_plane(*plane_a, at_a, {at_b.position}, ball_b->radius, margin);
  }
  if (plane_a != nullptr && box_b != nullptr) {
    return over_plane(*plane_a, at_a, corners(*box_b, at_b), 0, margin);
  }
  if (ball_a != nullptr && ball_b != nullptr) {
    return of_balls(at_a.position, ball_a->radius, at_b.position, ball_b->radius, margin);
  }
  if (box_a != nullptr && ball_b != nullptr) {
    return of_box_and_ball(*box_a, at_a, at_b.position, ball_b->radius, margin);
  }
  if (box_a != nullptr && box_b != nullptr) {
    return of_boxes(*box_a, at_a, *box_b, at_b, margin);
  }
  if (plane_a != nullptr || !known(a) || !known(b)) {
    return {std::numeric_limits<Real>::infinity(), {}};  // two half-spaces: nobody's concern
  }
  Nearness found = nearness(b, at_b, a, at_a, margin);
  for (TouchPoint& point : found.points) {
    point.normal = -point.normal;
  }
  return found;
}

}  // namespace kairos::judge
