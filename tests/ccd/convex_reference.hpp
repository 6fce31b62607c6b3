#pragma once

#include "core/contact_detector.hpp"
#include "core/random.hpp"

#include <array>
#include <cmath>
#include <string>
#include <vector>

/// Convex shapes in long double, by Wolfe's algorithm for the point of least norm [Wolfe1976]: no
/// line shared with the library. Whatever it finds is proven by what it returns: `lower` by a
/// direction, `upper` by a point of each body, both evaluated in long double.
namespace kairos::convex {

using Real = long double;
using Vec = Eigen::Matrix<Real, 3, 1>;
using Quat = Eigen::Quaternion<Real>;

/// A shape at one instant; `grow` scales it about its origin.
struct Posed {
  const Shape* shape = nullptr;
  Vec p;
  Quat q;
  Real grow = 1;
};

/// A point of the shape that is highest along n.
inline Vec highest(const Posed& body, const Vec& n) {
  const Vec m = body.q.conjugate() * n;
  const Real across = std::hypot(m.x(), m.z());
  const auto rim = [&](Real r, Real y) {
    return across > 0 ? Vec(r * m.x() / across, y, r * m.z() / across) : Vec(r, y, 0);
  };
  const auto ball = [&](Real r) { return Vec(m * (r / m.norm())); };
  Vec x = Vec::Zero();
  if (const auto* s = std::get_if<Sphere>(body.shape)) {
    x = ball(s->radius);
  } else if (const auto* box = std::get_if<Box>(body.shape)) {
    for (int k = 0; k < 3; ++k) {
      x[k] = std::copysign(Real(box->half_extents[k]), m[k]);
    }
  } else if (const auto* capsule = std::get_if<Capsule>(body.shape)) {
    x = Vec(0, std::copysign(Real(capsule->length) / 2, m.y()), 0) + ball(capsule->radius);
  } else if (const auto* cylinder = std::get_if<Cylinder>(body.shape)) {
    x = rim(cylinder->radius, std::copysign(Real(cylinder->length) / 2, m.y()));
  } else if (const auto* cone = std::get_if<Cone>(body.shape)) {
    const Vec apex(0, 3 * Real(cone->height) / 4, 0);
    const Vec base = rim(cone->radius, -Real(cone->height) / 4);
    x = apex.dot(m) > base.dot(m) ? apex : base;
  } else if (const auto* hull = std::get_if<Hull>(body.shape)) {
    Real most = -INFINITY;
    for (const Vector3& v : hull->core->vertices) {
      const Real at = v.cast<Real>().dot(m);
      if (at > most) {
        most = at;
        x = v.cast<Real>();
      }
    }
    if (hull->rounding > 0) {
      x += ball(hull->rounding);
    }
  }
  return body.p + body.q * (body.grow * x);
}

struct Bounds {
  Real lower = 0;  ///< proven apart by so much; negative: nothing is proven
  Real upper = 0;  ///< points of both are so near
  Vec n = Vec::UnitX();
};

/// Weights, of sum 1, of the point of least norm of the affine hull; false where they are no basis.
inline bool affine_weights(const std::vector<Vec>& points, std::vector<Real>& weights) {
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic> M(n + 1, n + 1);
  M.setZero();
  Eigen::Matrix<Real, Eigen::Dynamic, 1> right(n + 1);
  right.setZero();
  right[n] = 1;
  for (Eigen::Index i = 0; i < n; ++i) {
    M(i, n) = M(n, i) = 1;
    for (Eigen::Index k = 0; k < n; ++k) {
      M(i, k) = points[static_cast<std::size_t>(i)].dot(points[static_cast<std::size_t>(k)]);
    }
  }
  const Eigen::FullPivLU<decltype(M)> lu(M);
  const Eigen::Matrix<Real, Eigen::Dynamic, 1> x = lu.solve(right);
  weights.assign(x.data(), x.data() + n);
  return x.allFinite();
}

/// Distance of two convex bodies. A half-space is b: its distance is a height.
inline Bounds distance(const Posed& a, const Posed& b, int iterations = 400) {
  Bounds bounds;
  if (const auto* plane = std::get_if<HalfSpace>(b.shape)) {
    const Vec up = b.q * plane->normal_B.cast<Real>();
    bounds.n = -up;
    bounds.lower = up.dot(highest(a, -up) - b.p);
    bounds.upper = std::max(Real(0), bounds.lower);
    return bounds;
  }
  const auto point = [&](const Vec& n) { return Vec(highest(b, -n) - highest(a, n)); };
  std::vector<Vec> corral{point(b.p == a.p ? Vec(Vec::UnitX()) : Vec(b.p - a.p))};
  std::vector<Real> weights{1};
  Vec x = corral[0];
  bounds.lower = -INFINITY;
  for (int i = 0; i < iterations; ++i) {
    const Real norm = x.norm();
    bounds.upper = norm;
    if (!(norm > 0)) {
      break;
    }
    const Vec n = x / norm;
    const Vec next = point(n);
    if (n.dot(next) > bounds.lower) {
      bounds.lower = n.dot(next);
      bounds.n = n;
    }
    if (norm - bounds.lower < Real(1e-17) * norm) {
      break;
    }
    corral.push_back(next);
    weights.push_back(0);
    bool settled = false;
    while (!settled) {
      std::vector<Real> target;
      if (!affine_weights(corral, target)) {
        return bounds;
      }
      Real part = 1;
      for (std::size_t k = 0; k < corral.size(); ++k) {
        if (target[k] < Real(1e-18)) {
          part = std::min(part, weights[k] / (weights[k] - target[k]));
        }
      }
      settled = true;
      std::size_t kept = 0;
      for (std::size_t k = 0; k < corral.size(); ++k) {
        const Real w = weights[k] + part * (target[k] - weights[k]);
        if (w > Real(1e-18)) {
          corral[kept] = corral[k];
          weights[kept++] = w;
        } else {
          settled = false;
        }
      }
      settled = settled || part == 1;
      corral.resize(kept);
      weights.resize(kept);
      if (kept == 0) {
        return bounds;
      }
    }
    Vec nearer = Vec::Zero();
    for (std::size_t k = 0; k < corral.size(); ++k) {
      nearer += weights[k] * corral[k];
    }
    if (corral.size() > 4 || !(nearer.squaredNorm() < x.squaredNorm())) {
      bounds.upper = std::min(bounds.upper, nearer.norm());
      break;
    }
    x = nearer;
  }
  return bounds;
}

/// Two shapes on parabolas, turning at constant rates.
struct Query {
  Shape a, b;
  Motion motion_a, motion_b;
  double duration = 1.0;
  double touch = 0.0;    ///< when they were made to touch, s
  double closing = 0.0;  ///< speed at which they part then, m/s; negative: they meet
  std::string family;

  [[nodiscard]] Posed at(bool second, Real t, Real grow = 1) const {
    const Motion& m = second ? motion_b : motion_a;
    Posed body;
    body.shape = second ? &b : &a;
    body.grow = grow;
    body.p = Vec::Zero();
    for (int k = m.position.degree(); k >= 0; --k) {
      body.p = body.p * t + m.position[k].cast<Real>();
    }
    const Vector4 c = m.quaternion[0];
    body.q = Quat(c[0], c[1], c[2], c[3]);
    body.q.normalize();
    const Vec w = m.rotation_rate.cast<Real>();
    const Real rate = w.norm();
    if (m.rotation == RotationKind::constant_rate && rate > 0) {
      const Real half = rate * t / 2;
      const Vec axis = w * (std::sin(half) / rate);
      body.q = Quat(std::cos(half), axis.x(), axis.y(), axis.z()) * body.q;
    }
    return body;
  }
  [[nodiscard]] Bounds gap(Real t, Real grow = 1) const {
    return distance(at(false, t), at(true, t, grow));
  }
  /// Do they overlap by more than what rounding hides, b a little smaller?
  [[nodiscard]] bool overlap(Real t) const {
    const Real size = std::min(smallest_extent(a), smallest_extent(b));
    if (const auto* plane = std::get_if<HalfSpace>(&b); plane != nullptr) {
      return gap(t).lower < -Real(1e-12) * size;
    }
    return gap(t, 1 - Real(1e-12)).upper < Real(1e-17) * size;
  }
};

/// What an answer promises and does not keep; empty: all is kept. Error radii are none.
inline std::string broken(const Query& q, const TimeOfImpact& toi, int samples, Random& random) {
  const Real coordinates = q.motion_a.position[0].norm() + q.motion_b.position[0].norm() +
                           bounding_radius(q.a) +
                           (std::holds_alternative<HalfSpace>(q.b) ? 0 : bounding_radius(q.b));
  const Real roundoff = Real(1e-14) * (1 + coordinates);
  if (toi.status == ToiStatus::overlapping) {
    return q.gap(0).lower > roundoff ? "overlapping, but apart at the start" : "";
  }
  const bool separated = toi.status == ToiStatus::separated;
  const Real free_until = separated ? Real(q.duration) : Real(toi.t_lo);
  for (int i = 0; i < samples; ++i) {
    // All over, and close before the end.
    const Real part =
        i % 2 == 0 ? Real(random.uniform()) : 1 - std::exp2(Real(-random.uniform(0.0, 40.0)));
    if (q.overlap(part * free_until)) {
      return separated ? "missed" : "late";
    }
  }
  if (Real(q.touch) < free_until && q.overlap(q.touch)) {
    return separated ? "missed" : "late";
  }
  if (toi.status == ToiStatus::impact && q.gap(toi.t_hi).lower > roundoff) {
    return "false: apart at t_hi";
  }
  return "";
}

}  // namespace kairos::convex
