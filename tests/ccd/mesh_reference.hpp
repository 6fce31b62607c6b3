#pragma once

#include "core/mesh_data.hpp"
#include "core/pose.hpp"

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <vector>

// Triangles in GMP's rational numbers, by clipping and by nearest points: no line shared with the
// library. A vertex v at pose (p, q) is the point p + R(q) v / |q|^2.
namespace kairos::reference {

using Rational = mpq_class;
using Point = std::array<Rational, 3>;
using Polygon = std::vector<Point>;

inline Point operator-(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Point operator+(const Point& a, const Point& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Point operator*(const Rational& s, const Point& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline Rational dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline Point posed(const Vector3& v, const Pose& pose) {
  const Rational w = pose.orientation.w();
  const Point u{pose.orientation.x(), pose.orientation.y(), pose.orientation.z()};
  const Point p{pose.position.x(), pose.position.y(), pose.position.z()};
  const Point x{v.x(), v.y(), v.z()};
  // q x q* = (w^2 - u.u) x + 2 (u.x) u + 2 w u x x
  const Rational norm = w * w + dot(u, u);
  const Point turned = (w * w - dot(u, u)) * x + (2 * dot(u, x)) * u + (2 * w) * cross(u, x);
  return p + (1 / norm) * turned;
}
inline Polygon posed(const MeshData& mesh, std::size_t k, const Pose& pose) {
  const Triangle& t = mesh.triangles[k];
  return {posed(mesh.vertices[t[0]], pose), posed(mesh.vertices[t[1]], pose),
          posed(mesh.vertices[t[2]], pose)};
}

/// The part of the hull of points in a cycle where n . (x - at) >= 0; of those on the plane alone
/// if `only_on` is set.
inline Polygon clipped(const Polygon& polygon, const Point& n, const Point& at, bool only_on) {
  Polygon left;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& p = polygon[i];
    const Point& q = polygon[(i + 1) % polygon.size()];
    const Rational here = dot(n, p - at);
    const Rational next = dot(n, q - at);
    if (only_on ? here == 0 : here >= 0) {
      left.push_back(p);
    }
    if ((here < 0 && next > 0) || (here > 0 && next < 0)) {
      left.push_back(p + (here / (here - next)) * (q - p));
    }
  }
  return left;
}

/// `b` has an area.
inline bool touch(const Polygon& a, const Polygon& b) {
  const Point n = cross(b[1] - b[0], b[2] - b[0]);
  Polygon left = clipped(a, n, b[0], true);
  for (std::size_t i = 0; i < 3; ++i) {
    left = clipped(left, cross(n, b[(i + 1) % 3] - b[i]), b[i], false);
  }
  return !left.empty();
}

inline bool has_area(const Polygon& t) {
  const Point n = cross(t[1] - t[0], t[2] - t[0]);
  return dot(n, n) != 0;
}

inline Rational clamped(const Rational& x) {
  return x < 0 ? Rational(0) : (x > 1 ? Rational(1) : x);
}

inline Rational squared_point_edge(const Point& p, const Point& q, const Point& along) {
  const Point from = p - q;
  const Point rest = from - clamped(dot(from, along) / dot(along, along)) * along;
  return dot(rest, rest);
}
inline Rational squared_edges(const Point& p, const Point& u, const Point& q, const Point& v) {
  Rational least = std::min({squared_point_edge(p, q, v), squared_point_edge(p + u, q, v),
                             squared_point_edge(q, p, u), squared_point_edge(q + v, p, u)});
  const Point n = cross(u, v);
  const Rational nn = dot(n, n);
  if (nn != 0) {
    const Point w = q - p;
    const Rational s = dot(cross(w, v), n) / nn;
    const Rational t = dot(cross(w, u), n) / nn;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) {
      least = std::min(least, Rational(dot(w, n) * dot(w, n) / nn));
    }
  }
  return least;
}
/// The square of the distance of two triangles with areas.
inline Rational squared_distance(const Polygon& a, const Polygon& b) {
  if (touch(a, b)) {
    return 0;
  }
  Rational least = squared_edges(a[0], a[1] - a[0], b[0], b[1] - b[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      least =
          std::min(least, squared_edges(a[i], a[(i + 1) % 3] - a[i], b[j], b[(j + 1) % 3] - b[j]));
    }
  }
  const auto faces = [&](const Polygon& face, const Polygon& points) {
    const Point n = cross(face[1] - face[0], face[2] - face[0]);
    for (const Point& p : points) {
      bool above = true;
      for (std::size_t i = 0; i < 3; ++i) {
        above = above && dot(cross(n, face[(i + 1) % 3] - face[i]), p - face[i]) >= 0;
      }
      if (above) {
        const Rational height = dot(n, p - face[0]);
        least = std::min(least, Rational(height * height / dot(n, n)));
      }
    }
  };
  faces(a, b);
  faces(b, a);
  return least;
}

}  // namespace kairos::reference
