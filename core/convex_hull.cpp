#include "core/error.hpp"
#include "core/mass_properties.hpp"
#include "core/polytope.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

using Index = std::uint32_t;
using Edge = std::pair<Index, Index>;

bool on_one_line(const Vector3& a, const Vector3& b, const Vector3& c) {
  // Three points are on one line exactly if they span no volume with any fourth point.
  for (int k = 0; k < 3; ++k) {
    const Vector3 d = a + Vector3::Unit(k) * std::max(1.0, (b - a).norm());
    if (side_of_plane(a, b, c, d) != 0) {
      return false;
    }
  }
  return true;
}

/// The hull's surface in triangles. Points are added one after the other: the triangles that a
/// point sees are replaced by a fan from the point to their rim. A point in the plane of a triangle
/// does not see it.
class Incremental {
 public:
  explicit Incremental(std::span<const Vector3> points) : points_(points) {
    start();
    for (Index i = 0; i < points_.size(); ++i) {
      add(i);
    }
  }
  [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }

 private:
  [[noreturn]] static void refuse(const std::string& what) { throw std::invalid_argument(what); }

  /// Four points that span a volume.
  void start() {
    const auto n = static_cast<Index>(points_.size());
    const auto first_of = [n](Index from, const auto& fits, const char* otherwise) {
      for (Index i = from; i < n; ++i) {
        if (fits(i)) {
          return i;
        }
      }
      refuse(otherwise);
    };
    const Vector3& a = points_[0];
    const Index b = first_of(
        1, [&](Index i) { return points_[i] != a; },
        "all points are one: a hull needs four that span a volume");
    const Index c = first_of(
        b + 1, [&](Index i) { return !on_one_line(a, points_[b], points_[i]); },
        "all points lie on one line: a hull needs four that span a volume");
    const Index d = first_of(
        c + 1, [&](Index i) { return side_of_plane(a, points_[b], points_[c], points_[i]) != 0; },
        "all points lie in one plane: a hull needs four that span a volume");
    const bool outside = side_of_plane(a, points_[b], points_[c], points_[d]) > 0;
    const Index e = outside ? c : b;
    const Index f = outside ? b : c;
    triangles_ = {{0, e, f}, {0, d, e}, {e, d, f}, {f, d, 0}};
  }

  void add(Index i) {
    rim_.clear();
    std::size_t kept = 0;
    for (const Triangle& t : triangles_) {
      if (side_of_plane(points_[t[0]], points_[t[1]], points_[t[2]], points_[i]) > 0) {
        for (std::size_t k = 0; k < 3; ++k) {
          rim_.emplace_back(t[k], t[(k + 1) % 3]);
        }
      } else {
        triangles_[kept++] = t;
      }
    }
    triangles_.resize(kept);
    std::sort(rim_.begin(), rim_.end());
    for (const auto& [from, to] : rim_) {
      if (!std::binary_search(rim_.begin(), rim_.end(), Edge{to, from})) {
        triangles_.push_back({from, to, i});
      }
    }
  }

  std::span<const Vector3> points_;
  std::vector<Triangle> triangles_;
  std::vector<Edge> rim_;
};

/// Triangles that lie in one plane are one face: which face each belongs to.
std::vector<Index> faces_of(std::span<const Vector3> points, const std::vector<Triangle>& triangles,
                            const std::map<Edge, Index>& triangle_of) {
  std::vector<Index> face(triangles.size());
  std::iota(face.begin(), face.end(), Index{0});
  const auto root = [&face](Index i) {
    while (face[i] != i) {
      i = face[i] = face[face[i]];
    }
    return i;
  };
  for (const auto& [edge, t] : triangle_of) {
    const Index other = triangle_of.at({edge.second, edge.first});
    const Triangle& corners = triangles[t];
    const bool flat =
        std::all_of(triangles[other].begin(), triangles[other].end(), [&](Index corner) {
          return side_of_plane(points[corners[0]], points[corners[1]], points[corners[2]],
                               points[corner]) == 0;
        });
    if (flat) {
      face[root(t)] = root(other);
    }
  }
  for (Index i = 0; i < face.size(); ++i) {
    face[i] = root(i);
  }
  return face;
}

/// Polygons of the faces, in the points' indices; what lies within a face or an edge is left out.
std::vector<std::vector<Index>> polygons(std::span<const Vector3> points,
                                         const std::vector<Triangle>& triangles) {
  std::map<Edge, Index> triangle_of;
  for (Index t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      triangle_of[{triangles[t][k], triangles[t][(k + 1) % 3]}] = t;
    }
  }
  const std::vector<Index> face = faces_of(points, triangles, triangle_of);
  std::map<Index, std::map<Index, Index>> borders;  // by face: what comes after each corner
  std::map<Index, int> faces_at;
  for (const auto& [edge, t] : triangle_of) {
    if (face[t] != face[triangle_of.at({edge.second, edge.first})]) {
      borders[face[t]][edge.first] = edge.second;
      ++faces_at[edge.first];
    }
  }
  std::vector<std::vector<Index>> all;
  for (const auto& [name, next] : borders) {
    std::vector<Index>& polygon = all.emplace_back();
    const Index first = next.begin()->first;
    Index corner = first;
    do {
      if (faces_at[corner] > 2) {  // where two faces meet alone, an edge goes on
        polygon.push_back(corner);
      }
      corner = next.at(corner);
    } while (corner != first);
  }
  return all;
}

std::vector<Triangle> fans(const std::vector<std::vector<Index>>& polygons) {
  std::vector<Triangle> triangles;
  for (const std::vector<Index>& polygon : polygons) {
    for (std::size_t k = 2; k < polygon.size(); ++k) {
      triangles.push_back({polygon[0], polygon[k - 1], polygon[k]});
    }
  }
  return triangles;
}

/// Twice the area of a polygon times its normal.
Vector3 area_of(std::span<const Index> polygon, const std::vector<Vector3>& vertices) {
  Vector3 area = Vector3::Zero();
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    area += (vertices[polygon[k - 1]] - vertices[polygon[0]])
                .cross(vertices[polygon[k]] - vertices[polygon[0]]);
  }
  return area;
}

void add_edges(Polytope& polytope) {
  std::vector<std::vector<Index>> faces_at(polytope.vertices.size());
  std::vector<std::vector<Index>> edges_at(polytope.vertices.size());
  for (Index f = 0; f < polytope.faces.size(); ++f) {
    const auto polygon = polytope.faces[f];
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Index from = polygon[k];
      const Index to = polygon[(k + 1) % polygon.size()];
      faces_at[from].push_back(f);
      if (from < to) {
        const auto edge = static_cast<Index>(polytope.edges.size());
        edges_at[from].push_back(edge);
        edges_at[to].push_back(edge);
        polytope.edges.push_back({from, to});
        polytope.directions.push_back(
            (polytope.vertices[to] - polytope.vertices[from]).normalized());
      }
    }
  }
  for (std::size_t v = 0; v < polytope.vertices.size(); ++v) {
    polytope.faces_at.add(faces_at[v]);
    polytope.edges_at.add(edges_at[v]);
  }
}

/// Least and greatest n . x of its vertices.
double width_along(const Polytope& polytope, const Vector3& n) {
  double least = n.dot(polytope.vertices[0]);
  double most = least;
  for (const Vector3& x : polytope.vertices) {
    least = std::min(least, n.dot(x));
    most = std::max(most, n.dot(x));
  }
  return most - least;
}

}  // namespace

void add_sizes(Polytope& polytope) {
  for (const Vector3& x : polytope.vertices) {
    polytope.radius = std::max(polytope.radius, x.norm());
    polytope.extent = std::max(polytope.extent, x.lpNorm<1>());
  }
  polytope.width = 2.0 * polytope.radius;
  for (const Vector3& n : polytope.normals) {
    polytope.width = std::min(polytope.width, width_along(polytope, n));
  }
  for (int k = 0; k < 3 && polytope.normals.empty(); ++k) {
    polytope.width = std::min(polytope.width, width_along(polytope, Vector3::Unit(k)));
  }
}

namespace {

enum class HullFrame { principal, told };

ConvexHull make_hull(std::span<const Vector3> points, HullFrame frame) {
  if (points.size() < 4) {
    throw std::invalid_argument(
        fmt::format("{} points are no solid: a hull needs four that span a volume", points.size()));
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) {
      throw std::invalid_argument(fmt::format("point {} is not finite", i));
    }
  }
  const auto faces = polygons(points, Incremental(points).triangles());
  const MassProperties mass = [&] {
    try {
      return mass_properties(points, fans(faces));
    } catch (const InputError&) {
      throw std::invalid_argument(fmt::format(
          "{} points are no solid: rounding hides the volume that they span", points.size()));
    }
  }();
  const bool principal = is_principal(mass.inertia);
  ConvexHull hull;
  hull.centre = frame == HullFrame::told ? Vector3(Vector3::Zero()) : mass.centre;
  auto polytope = std::make_shared<Polytope>();
  polytope->volume = mass.volume;
  polytope->axes = principal ? Quaternion(Quaternion::Identity()) : mass.axes;
  polytope->moments = principal ? Vector3(mass.inertia.diagonal()) : mass.moments;
  std::map<Index, Index> place;
  for (const auto& polygon : faces) {
    std::vector<Index> corners;
    for (const Index i : polygon) {
      const auto [at, is_new] = place.try_emplace(i, static_cast<Index>(place.size()));
      if (is_new) {
        polytope->vertices.emplace_back(points[i] - hull.centre);
      }
      corners.push_back(at->second);
    }
    polytope->faces.add(corners);
  }
  for (std::size_t f = 0; f < polytope->faces.size(); ++f) {
    polytope->normals.push_back(area_of(polytope->faces[f], polytope->vertices).normalized());
  }
  add_edges(*polytope);
  add_sizes(*polytope);
  hull.polytope = std::move(polytope);
  return hull;
}

}  // namespace

ConvexHull convex_hull(std::span<const Vector3> points) {
  return make_hull(points, HullFrame::principal);
}

std::shared_ptr<const Polytope> hull_in_place(std::span<const Vector3> points) {
  return make_hull(points, HullFrame::told).polytope;
}

}  // namespace core
}  // namespace kairos
