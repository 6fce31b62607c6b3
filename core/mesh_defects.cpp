#include "core/mesh_defects.hpp"

#include "core/polytope.hpp"

#include <algorithm>
#include <cstdint>
#include <tuple>

namespace kairos {
inline namespace core {
namespace {

/// Two corners of a triangle in ascending order, and whether it walks them so.
struct Side {
  std::uint32_t low, high, triangle;
  bool ascending;
  [[nodiscard]] bool same_edge(const Side& other) const {
    return low == other.low && high == other.high;
  }
};

std::vector<Side> sides_of(std::span<const Triangle> triangles) {
  std::vector<Side> sides;
  for (std::uint32_t k = 0; k < triangles.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = triangles[k][i];
      const std::uint32_t to = triangles[k][(i + 1) % 3];
      if (from != to) {
        sides.push_back({std::min(from, to), std::max(from, to), k, from < to});
      }
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
    return std::tie(x.low, x.high, x.triangle) < std::tie(y.low, y.high, y.triangle);
  });
  return sides;
}

void check_edges(std::span<const Triangle> triangles, std::vector<MeshDefect>& found) {
  const std::vector<Side> sides = sides_of(triangles);
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i;
    while (end < sides.size() && sides[end].same_edge(sides[i])) {
      ++end;
    }
    const std::size_t count = end - i;
    const bool contrary = count == 2 && sides[i].ascending == sides[i + 1].ascending;
    for (; i < end; ++i) {
      const Triangle edge{sides[i].low, sides[i].high, 0};
      if (count == 1) {
        found.push_back({MeshDefectKind::open, sides[i].triangle, edge});
      } else if (count > 2) {
        found.push_back({MeshDefectKind::non_manifold, sides[i].triangle, edge});
      } else if (contrary) {
        found.push_back({MeshDefectKind::contrary, sides[i].triangle, edge});
      }
    }
  }
}

/// Three corners on one line span no volume with any fourth point. It is enough to try three points
/// that no plane through a holds all of.
bool on_a_line(const Vector3& a, const Vector3& b, const Vector3& c) {
  const double size =
      std::max((b - a).lpNorm<Eigen::Infinity>(), (c - a).lpNorm<Eigen::Infinity>());
  for (int k = 0; k < 3; ++k) {
    if (side_of_plane(a, b, c, a + Vector3::Unit(k) * (size > 0.0 ? size : 1.0)) != 0) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::string_view to_string(MeshDefectKind kind) {
  switch (kind) {
    case MeshDefectKind::degenerate:
      return "degenerate";
    case MeshDefectKind::repeated:
      return "repeated";
    case MeshDefectKind::open:
      return "open";
    case MeshDefectKind::non_manifold:
      return "non-manifold";
    case MeshDefectKind::contrary:
      break;
  }
  return "contrary";
}

std::vector<MeshDefect> mesh_defects(std::span<const Vector3> vertices,
                                     std::span<const Triangle> triangles) {
  std::vector<MeshDefect> found;
  std::vector<std::pair<Triangle, std::uint32_t>> sorted;
  for (std::uint32_t k = 0; k < triangles.size(); ++k) {
    const Triangle& t = triangles[k];
    if (on_a_line(vertices[t[0]], vertices[t[1]], vertices[t[2]])) {
      found.push_back({MeshDefectKind::degenerate, k, t});
    }
    Triangle ascending = t;
    std::sort(ascending.begin(), ascending.end());
    sorted.emplace_back(ascending, k);
  }
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i].first == sorted[i - 1].first) {
      found.push_back({MeshDefectKind::repeated, sorted[i].second, triangles[sorted[i].second]});
    }
  }
  check_edges(triangles, found);
  std::stable_sort(found.begin(), found.end(), [](const MeshDefect& x, const MeshDefect& y) {
    return x.triangle < y.triangle;
  });
  return found;
}

}  // namespace core
}  // namespace kairos
