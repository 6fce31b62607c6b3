#include "experiments/accuracy/reference.hpp"

namespace kairos::reference {
namespace {

/// Distance of two segments p + s x, |s| <= a, and q + t y, |t| <= b, x and y unit [Ericson2005,
/// sec. 5.1.9].
Real distance_of_segments(const Vec& p, const Vec& x, Real a, const Vec& q, const Vec& y, Real b) {
  const Vec r = q - p;
  const Real cosine = x.dot(y);
  const Real square = 1 - cosine * cosine;
  Real s = square > 0 ? (x.dot(r) - cosine * y.dot(r)) / square : Real(0);
  s = std::clamp(s, -a, a);
  const Real t = std::clamp(s * cosine - y.dot(r), -b, b);
  s = std::clamp(t * cosine + x.dot(r), -a, a);
  return (r + t * y - s * x).norm();
}

/// Distance of two disjoint boxes: the least of that of every corner from the other box, and of
/// every pair of edges.
Real distance_of_boxes(const Vec& half_a, const Mat& R_a, const Vec& half_b, const Mat& R_b,
                       const Vec& d) {
  Real least = std::numeric_limits<Real>::infinity();
  const auto signs = [](int corner) {
    return Vec(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
  };
  const auto outside = [&](const Vec& x, const Vec& half) {
    least = std::min(least, (x.cwiseAbs() - half).cwiseMax(Real(0)).norm());
  };
  for (int c = 0; c < 8; ++c) {
    outside(R_a.transpose() * (d + R_b * signs(c).cwiseProduct(half_b)), half_a);
    outside(R_b.transpose() * (R_a * signs(c).cwiseProduct(half_a) - d), half_b);
  }
  const auto middle = [&](const Mat& R, const Vec& half, int edge, int corner) {
    Vec x = signs(corner).cwiseProduct(half);
    x[edge] = 0;
    return Vec(R * x);
  };
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int c = 0; c < 64; ++c) {
        if ((c >> i & 1) == 0 && (c >> (3 + j) & 1) == 0) {  // every edge once
          const Vec p = middle(R_a, half_a, i, c & 7);
          const Vec q = d + middle(R_b, half_b, j, c >> 3);
          least = std::min(
              least, distance_of_segments(p, R_a.col(i), half_a[i], q, R_b.col(j), half_b[j]));
        }
      }
    }
  }
  return least;
}

}  // namespace

Vec position(const Motion& motion, Real s) {
  Vec sum = Vec::Zero();
  for (int k = motion.position.degree(); k >= 0; --k) {
    sum = sum * s + motion.position[k].cast<Real>();
  }
  return sum;
}

Vec relative_position(const Motion& a, Real s_a, const Motion& b, Real s_b) {
  if (s_a != s_b) {
    return position(b, s_b) - position(a, s_a);
  }
  Vec sum = Vec::Zero();
  for (int k = std::max(a.position.degree(), b.position.degree()); k >= 0; --k) {
    Vec difference = Vec::Zero();
    if (k <= b.position.degree()) {
      difference = b.position[k].cast<Real>();
    }
    if (k <= a.position.degree()) {
      difference -= a.position[k].cast<Real>();
    }
    sum = sum * s_a + difference;
  }
  return sum;
}

Mat orientation(const Motion& motion, Real s) {
  using Q = Eigen::Quaternion<Real>;
  const auto& c = motion.quaternion[0];
  Q q(c[0], c[1], c[2], c[3]);
  if (motion.rotation == RotationKind::polynomial) {
    Eigen::Matrix<Real, 4, 1> sum = Eigen::Matrix<Real, 4, 1>::Zero();
    for (int k = motion.quaternion.degree(); k >= 0; --k) {
      sum = sum * s + motion.quaternion[k].cast<Real>();
    }
    q = Q(sum[0], sum[1], sum[2], sum[3]);
  } else if (motion.rotation == RotationKind::constant_rate) {
    const Vec w = motion.rotation_rate.cast<Real>();
    const Real rate = w.norm();
    if (rate > 0) {
      const Real half = rate * s / 2;
      const Vec axis = w * (std::sin(half) / rate);
      q = Q(std::cos(half), axis.x(), axis.y(), axis.z()) * q;
    }
  }
  q.normalize();
  return q.toRotationMatrix();
}

Real separation(const MovingShape& a, Real s_a, const MovingShape& b, Real s_b) {
  if (a.shape.index() > b.shape.index()) {
    return separation(b, s_b, a, s_a);
  }
  const Vec d = relative_position(a.motion, s_a, b.motion, s_b);
  const Real errors = Real(a.motion.error_radius) + b.motion.error_radius;
  const auto* sphere_a = std::get_if<Sphere>(&a.shape);
  if (const auto* sphere_b = std::get_if<Sphere>(&b.shape)) {
    return d.norm() - sphere_a->radius - sphere_b->radius - errors;
  }
  const Mat R_b = orientation(b.motion, s_b);
  if (const auto* half_space = std::get_if<HalfSpace>(&b.shape)) {
    const Vec n = R_b * half_space->normal_B.cast<Real>();
    if (sphere_a != nullptr) {
      return -n.dot(d) - sphere_a->radius - errors;
    }
    const Mat R_a = orientation(a.motion, s_a);
    const Vec half = std::get<Box>(a.shape).half_extents.cast<Real>();
    return -n.dot(d) - half.dot((R_a.transpose() * n).cwiseAbs()) - errors;
  }
  const Vec half_b = std::get<Box>(b.shape).half_extents.cast<Real>();
  if (sphere_a != nullptr) {
    const Vec c = -(R_b.transpose() * d);
    const Vec out = (c.cwiseAbs() - half_b).cwiseMax(Real(0));
    const Real distance = out.norm();
    if (distance > 0) {
      return distance - sphere_a->radius - errors;
    }
    return (c.cwiseAbs() - half_b).maxCoeff() - sphere_a->radius - errors;
  }
  const Mat R_a = orientation(a.motion, s_a);
  const Vec half_a = std::get<Box>(a.shape).half_extents.cast<Real>();
  Real best = -std::numeric_limits<Real>::infinity();
  const auto along = [&](const Vec& n) {
    best = std::max(best, std::abs(n.dot(d)) - half_a.dot((R_a.transpose() * n).cwiseAbs()) -
                              half_b.dot((R_b.transpose() * n).cwiseAbs()));
  };
  for (int i = 0; i < 3; ++i) {
    along(R_a.col(i));
    along(R_b.col(i));
    for (int j = 0; j < 3; ++j) {
      const Vec n = R_a.col(i).cross(R_b.col(j));
      // Below 1e-12 the cross product is noise in long double as well; any direction is a valid
      // axis, so leaving it out can only make the separation smaller by 1e-12 of the size.
      if (n.norm() > 1e-12L) {
        along(n.normalized());
      }
    }
  }
  return (errors > 0 && best > 0 ? distance_of_boxes(half_a, R_a, half_b, R_b, d) : best) - errors;
}

Vector3 Random::direction() {
  while (true) {
    const Vector3 x = vector(1.0);
    const double n = x.norm();
    if (n > 0.1 && n < 1.0) {
      return x / n;
    }
  }
}

Quaternion Random::orientation() {
  const Vector3 axis = direction();
  const double half = uniform(0.0, 3.14159);
  return Quaternion(std::cos(half), std::sin(half) * axis.x(), std::sin(half) * axis.y(),
                    std::sin(half) * axis.z())
      .normalized();
}

}  // namespace kairos::reference
