#include "ccd/mesh/triangle_distance.hpp"

#include "ccd/rounding/roundoff.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

struct Nearest {
  Vector3 on_a = Vector3::Zero(), on_b = Vector3::Zero();
  double squared = infinity;

  void offer(const Vector3& p, const Vector3& q) {
    const double s = (q - p).squaredNorm();
    if (s < squared) {
      squared = s;
      on_a = p;
      on_b = q;
    }
  }
};

/// The nearest points of two segments; the parameters are within [0, 1] whatever rounding does.
void offer_edges(const Vector3& p, const Vector3& along_p, const Vector3& q, const Vector3& along_q,
                 Nearest& nearest) {
  const Vector3 between = p - q;
  const double pp = along_p.squaredNorm();
  const double qq = along_q.squaredNorm();
  const double pq = along_p.dot(along_q);
  const double p0 = along_p.dot(between);
  const double q0 = along_q.dot(between);
  const double sine = pp * qq - pq * pq;
  double s = sine > 0.0 ? std::clamp((pq * q0 - p0 * qq) / sine, 0.0, 1.0) : 0.0;
  double t = qq > 0.0 ? (pq * s + q0) / qq : 0.0;
  if (!(t >= 0.0 && t <= 1.0)) {
    t = t > 1.0 ? 1.0 : 0.0;
    s = pp > 0.0 ? std::clamp((pq * t - p0) / pp, 0.0, 1.0) : 0.0;
  }
  nearest.offer(p + s * along_p, q + t * along_q);
}

/// The corners of one above the face of the other. `swapped`: the face is b's.
void offer_faces(const Corners& face, const Corners& corners, bool swapped, Nearest& nearest) {
  const Vector3 u = face[1] - face[0];
  const Vector3 v = face[2] - face[0];
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  const double uv = u.dot(v);
  const double area = uu * vv - uv * uv;
  if (!(area > 0.0)) {
    return;
  }
  for (const Vector3& corner : corners) {
    const Vector3 from = corner - face[0];
    const double wu = from.dot(u);
    const double wv = from.dot(v);
    const double s = (vv * wu - uv * wv) / area;
    const double t = (uu * wv - uv * wu) / area;
    if (s >= 0.0 && t >= 0.0 && s + t <= 1.0) {
      const Vector3 foot = face[0] + s * u + t * v;
      swapped ? nearest.offer(corner, foot) : nearest.offer(foot, corner);
    }
  }
}

/// Of their edges, and of corners above faces: the nearest points of triangles that do not cross.
Nearest nearest_features(const Corners& a, const Corners& b) {
  Nearest nearest;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3 along_a = a[(i + 1) % 3] - a[i];
    for (std::size_t j = 0; j < 3; ++j) {
      offer_edges(a[i], along_a, b[j], b[(j + 1) % 3] - b[j], nearest);
    }
  }
  offer_faces(a, b, false, nearest);
  offer_faces(b, a, true, nearest);
  return nearest;
}

/// Where the edges of one go through the face of the other.
void offer_crossings(const Corners& face, const Corners& edges, Nearest& nearest) {
  const Vector3 normal = (face[1] - face[0]).cross(face[2] - face[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3& p = edges[i];
    const Vector3& q = edges[(i + 1) % 3];
    const double above = normal.dot(p - face[0]);
    const double below = normal.dot(q - face[0]);
    if ((above < 0.0) != (below < 0.0)) {
      const Vector3 x = p + above / (above - below) * (q - p);
      offer_faces(face, {x, x, x}, false, nearest);
    }
  }
}

/// Proven distances along directions, measured from a point nearby so that little is rounded.
class Separation {
 public:
  Separation(const Corners& a, const Corners& b, double error) {
    for (std::size_t i = 0; i < 3; ++i) {
      a_[i] = a[i] - a[0];
      b_[i] = b[i] - a[0];
      size_ = std::max({size_, a_[i].lpNorm<Eigen::Infinity>(), b_[i].lpNorm<Eigen::Infinity>()});
    }
    error_ = error + 8.0 * unit_roundoff * size_;
  }

  /// What n proves, from a to b; its length need not be 1.
  [[nodiscard]] double along(const Vector3& n) const {
    const double length = n.norm();
    if (!(length > 0.0) || !std::isfinite(length)) {
      return 0.0;
    }
    const double gap = std::min({n.dot(b_[0]), n.dot(b_[1]), n.dot(b_[2])}) -
                       std::max({n.dot(a_[0]), n.dot(a_[1]), n.dot(a_[2])}) -
                       2.0 * error_ * n.lpNorm<1>();
    return gap > 0.0 ? gap / length * (1.0 - 8.0 * unit_roundoff) : 0.0;
  }
  [[nodiscard]] double along_either(const Vector3& n) const {
    return std::max(along(n), along(-n));
  }
  /// Normals, and products of edges: where two features meet, one of them is their direction.
  [[nodiscard]] double along_features() const {
    const std::array<Vector3, 3> edges_a{a_[1] - a_[0], a_[2] - a_[1], a_[0] - a_[2]};
    const std::array<Vector3, 3> edges_b{b_[1] - b_[0], b_[2] - b_[1], b_[0] - b_[2]};
    const Vector3 normal_a = edges_a[0].cross(edges_a[2]);
    const Vector3 normal_b = edges_b[0].cross(edges_b[2]);
    double proven = std::max(along_either(normal_a), along_either(normal_b));
    for (const Vector3& e : edges_a) {
      proven = std::max(proven, along_either(e.cross(normal_a)));
      for (const Vector3& f : edges_b) {
        proven = std::max(proven, along_either(e.cross(f)));
      }
    }
    for (const Vector3& f : edges_b) {
      proven = std::max(proven, along_either(f.cross(normal_b)));
    }
    return proven;
  }

 private:
  Corners a_, b_;
  double size_ = 0.0;
  double error_;
};

double largest(const Corners& t) {
  return std::max({t[0].lpNorm<Eigen::Infinity>(), t[1].lpNorm<Eigen::Infinity>(),
                   t[2].lpNorm<Eigen::Infinity>()});
}

}  // namespace

Vector3 common_point(const Corners& a, const Corners& b) {
  Nearest nearest = nearest_features(a, b);
  offer_crossings(a, b, nearest);
  offer_crossings(b, a, nearest);
  return 0.5 * (nearest.on_a + nearest.on_b);
}

double quick_triangle_distance(const Corners& a, const Corners& b, double error) {
  const Vector3 gaps =
      (b[0].cwiseMin(b[1]).cwiseMin(b[2]) - a[0].cwiseMax(a[1]).cwiseMax(a[2]))
          .cwiseMax(a[0].cwiseMin(a[1]).cwiseMin(a[2]) - b[0].cwiseMax(b[1]).cwiseMax(b[2]));
  const Vector3 proven = ((1.0 - 2.0 * unit_roundoff) * gaps.array() - error).matrix();
  const double by_boxes = proven.cwiseMax(0.0).norm() * (1.0 - 8.0 * unit_roundoff);
  const Separation separation(a, b, error);
  const Vector3 normal_a = (a[1] - a[0]).cross(a[2] - a[0]);
  const Vector3 normal_b = (b[1] - b[0]).cross(b[2] - b[0]);
  return std::max({by_boxes, separation.along_either(normal_a), separation.along_either(normal_b)});
}

TriangleDistance triangle_distance(const Corners& a, const Corners& b, double error) {
  const Nearest nearest = nearest_features(a, b);
  TriangleDistance result;
  result.on_a = nearest.on_a;
  result.on_b = nearest.on_b;
  const Vector3 between = nearest.on_b - nearest.on_a;
  // A point of a triangle is rounded to within 8 u of its coordinates, per axis.
  const double rounding = error + 8.0 * unit_roundoff * (largest(a) + largest(b));
  result.upper = between.norm() * (1.0 + 8.0 * unit_roundoff) + 2.0 * rounding;
  const Separation separation(a, b, error);
  result.lower = separation.along(between);
  constexpr double good = 1.0 - 1e-11;  // a matter of cost, not of truth
  if (!(result.lower >= good * result.upper - 64.0 * rounding)) {
    result.lower = std::max(result.lower, separation.along_features());
  }
  result.lower = std::min(result.lower, result.upper);
  return result;
}

}  // namespace kairos::ccd
