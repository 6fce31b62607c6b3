#include "ccd/gjk.hpp"

#include "ccd/rounding/roundoff.hpp"

#include <algorithm>
#include <cmath>

namespace kairos::ccd {
namespace {

constexpr int most_iterations = 128;

/// The part of a simplex that its point nearest to 0 lies in.
struct Part {
  std::array<int, 3> corners{};
  std::array<double, 3> weights{};
  int size = 0;
  double square = infinity;  ///< of the distance
};

double square_of(const Simplex& s, const Part& part) {
  Vector3 v = Vector3::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(part.size); ++i) {
    v += part.weights[i] * s[part.corners[i]].w;
  }
  return v.squaredNorm();
}

Part of_point(const Simplex& s, int i) {
  return {{i, 0, 0}, {1.0, 0.0, 0.0}, 1, s[i].w.squaredNorm()};
}

Part of_segment(const Simplex& s, int i, int k) {
  const Vector3 along = s[k].w - s[i].w;
  const double length = along.squaredNorm();
  const double t = -s[i].w.dot(along);
  if (!(t > 0.0)) {
    return of_point(s, i);
  }
  if (!(t < length)) {
    return of_point(s, k);
  }
  Part part{{i, k, 0}, {1.0 - t / length, t / length, 0.0}, 2, 0.0};
  part.square = square_of(s, part);
  return part;
}

/// Within the triangle if all three areas, seen along its normal, are positive.
Part of_triangle(const Simplex& s, int i, int j, int k) {
  const Vector3& a = s[i].w;
  const Vector3& b = s[j].w;
  const Vector3& c = s[k].w;
  const Vector3 n = (b - a).cross(c - a);
  const double area = n.squaredNorm();
  const double wa = n.dot(b.cross(c));
  const double wb = n.dot(c.cross(a));
  const double wc = n.dot(a.cross(b));
  if (wa > 0.0 && wb > 0.0 && wc > 0.0 && area > 0.0) {
    const double sum = wa + wb + wc;
    Part part{{i, j, k}, {wa / sum, wb / sum, wc / sum}, 3, 0.0};
    part.square = square_of(s, part);
    return part;
  }
  Part best = of_segment(s, i, j);
  for (const Part& other : {of_segment(s, j, k), of_segment(s, k, i)}) {
    if (other.square < best.square) {
      best = other;
    }
  }
  return best;
}

/// Is 0 on the side of the plane through i, j, k that the fourth corner is not on?
bool beyond(const Simplex& s, int i, int j, int k, int fourth) {
  const Vector3 n = (s[j].w - s[i].w).cross(s[k].w - s[i].w);
  const double side = n.dot(s[i].w);
  const double inner = n.dot(s[fourth].w) - side;
  return inner > 0.0 ? side >= 0.0 : side <= 0.0;
}

/// Of a tetrahedron; none of size 0 if 0 is inside.
Part of_tetrahedron(const Simplex& s) {
  constexpr int faces[4][4] = {{0, 1, 2, 3}, {0, 3, 1, 2}, {0, 2, 3, 1}, {1, 3, 2, 0}};
  Part best;
  for (const auto& f : faces) {
    if (beyond(s, f[0], f[1], f[2], f[3])) {
      const Part part = of_triangle(s, f[0], f[1], f[2]);
      if (part.square < best.square) {
        best = part;
      }
    }
  }
  return best;
}

/// Reduces the simplex to the part that its point nearest to 0 lies in; false if 0 is inside.
bool reduce(Simplex& s) {
  Part part;
  switch (s.size) {
    case 1:
      part = of_point(s, 0);
      break;
    case 2:
      part = of_segment(s, 0, 1);
      break;
    case 3:
      part = of_triangle(s, 0, 1, 2);
      break;
    default:
      part = of_tetrahedron(s);
  }
  if (part.size == 0) {
    return false;
  }
  Simplex kept;
  for (std::size_t i = 0; i < static_cast<std::size_t>(part.size); ++i) {
    kept.weights[i] = part.weights[i];
    kept.add(s[part.corners[i]]);
  }
  s = kept;
  return true;
}

bool contains(const Simplex& s, const DifferencePoint& p) {
  for (int i = 0; i < s.size; ++i) {
    if (s[i].w == p.w) {
      return true;
    }
  }
  return false;
}

}  // namespace

DifferencePoint Simplex::nearest() const {
  DifferencePoint p;
  for (int i = 0; i < size; ++i) {
    const double weight = weights[static_cast<std::size_t>(i)];
    p.on_a += weight * (*this)[i].on_a;
    p.on_b += weight * (*this)[i].on_b;
    p.w += weight * (*this)[i].w;
  }
  return p;
}

GjkResult gjk(const CorePair& pair, const Vector3& start, double precision) {
  GjkResult result;
  result.lower = -infinity;
  Simplex simplex;
  simplex.add(pair.support(start));
  simplex.weights[0] = 1.0;
  DifferencePoint at = simplex[0];
  for (; result.iterations < most_iterations; ++result.iterations) {
    const double distance = at.w.norm();
    if (!(distance > 0.0)) {
      result.inside = true;
      break;
    }
    const Vector3 n = at.w / distance;
    const DifferencePoint next = pair.support(n);
    const double separation = n.dot(next.w);
    if (separation > result.lower) {
      result.lower = separation;
      result.n = n;
    }
    if (distance - result.lower <= precision * distance || contains(simplex, next)) {
      break;
    }
    Simplex larger = simplex;
    larger.add(next);
    if (!reduce(larger)) {
      result.inside = true;
      simplex = larger;
      break;
    }
    const DifferencePoint nearer = larger.nearest();
    if (!(nearer.w.squaredNorm() < at.w.squaredNorm())) {
      break;
    }
    simplex = larger;
    at = nearer;
  }
  result.simplex = simplex;
  result.upper = at.w.norm();
  result.on_a = at.on_a;
  result.on_b = at.on_b;
  return result;
}

}  // namespace kairos::ccd
