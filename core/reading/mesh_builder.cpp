#include "core/reading/mesh_builder.hpp"

#include "core/error.hpp"
#include "core/reading/scene_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace kairos {
inline namespace core {
namespace {

constexpr std::size_t most_vertices = 3 * most_triangles;
/// Corners of one polygon. Cutting ears takes the square of their number, at worst the cube.
constexpr std::size_t most_corners = 1024;

/// Twice the area vector of a closed walk, by the sum of its triangles.
Vector3 area_vector(const std::vector<Vector3>& vertices, std::span<const std::uint32_t> corners) {
  const Vector3& origin = vertices[corners[0]];
  Vector3 sum = Vector3::Zero();
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const Vector3 before = vertices[corners[i - 1]] - origin;
    sum += before.cross(vertices[corners[i]] - origin);
  }
  return sum;
}

/// Twice the area of a triangle in a projection along axis k, positive if it goes as the polygon.
struct Projection {
  const std::vector<Vector3>& vertices;
  int first, second;

  [[nodiscard]] double area(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const Vector3 ab = vertices[b] - vertices[a];
    const Vector3 ac = vertices[c] - vertices[a];
    return ab[first] * ac[second] - ab[second] * ac[first];
  }
  [[nodiscard]] bool covers(std::uint32_t a, std::uint32_t b, std::uint32_t c,
                            std::uint32_t p) const {
    return p != a && p != b && p != c && vertices[p] != vertices[a] && vertices[p] != vertices[b] &&
           vertices[p] != vertices[c] && area(a, b, p) >= 0.0 && area(b, c, p) >= 0.0 &&
           area(c, a, p) >= 0.0;
  }
  /// Whether corner i of a walk can be cut off: its triangle is inside, and no other corner in it.
  [[nodiscard]] bool is_ear(std::span<const std::uint32_t> walk, std::size_t i) const {
    const std::size_t n = walk.size();
    const std::uint32_t a = walk[(i + n - 1) % n];
    const std::uint32_t b = walk[i];
    const std::uint32_t c = walk[(i + 1) % n];
    return area(a, b, c) > 0.0 && std::none_of(walk.begin(), walk.end(),
                                               [&](std::uint32_t p) { return covers(a, b, c, p); });
  }
};

Projection projection_along(const std::vector<Vector3>& vertices, const Vector3& normal) {
  int k = 0;
  normal.cwiseAbs().maxCoeff(&k);
  const int i = (k + 1) % 3;
  const int j = (k + 2) % 3;
  return normal[k] > 0.0 ? Projection{vertices, i, j} : Projection{vertices, j, i};
}

}  // namespace

std::string MeshFile::where(std::size_t triangle) const {
  const std::string line = lines.empty() ? std::string() : fmt::format(":{}", lines[triangle]);
  return fmt::format("{}{}: face {}", path, line, faces[triangle]);
}

MeshBuilder::MeshBuilder(const std::string& path, double scale) : scale_(scale) {
  file_.path = path;
}

void MeshBuilder::fail(int line, const std::string& reason) const {
  throw InputError(file_.path, line, "", reason);
}

void MeshBuilder::vertex(const Vector3& p, int line) {
  const Vector3 scaled = scale_ * p;
  if (!scaled.allFinite() || scaled.cwiseAbs().maxCoeff() > limits::position.highest) {
    fail(line, fmt::format("{}a vertex at ({}, {}, {}) times the scale {}; allowed: {}",
                           line == 0 ? fmt::format("face {}: ", face_ + 1) : "", p.x(), p.y(),
                           p.z(), scale_, limits::position.text()));
  }
  if (file_.mesh.vertices.size() == most_vertices) {
    fail(line, fmt::format("more than {} vertices", most_vertices));
  }
  file_.mesh.vertices.push_back(scaled);
}

void MeshBuilder::face(std::span<const std::uint32_t> corners, int line) {
  ++face_;
  check_normal(corners);
  if (corners.size() == 3) {
    triangle(corners[0], corners[1], corners[2], line);
  } else {
    divide(corners, line);
  }
  normal_ = Vector3::Zero();
}

void MeshBuilder::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, int line) {
  if (file_.mesh.triangles.size() == most_triangles) {
    fail(line, fmt::format("more than {} triangles", most_triangles));
  }
  file_.mesh.triangles.push_back({a, b, c});
  file_.faces.push_back(face_);
  if (line > 0) {
    file_.lines.push_back(static_cast<std::uint32_t>(line));
  }
}

void MeshBuilder::divide(std::span<const std::uint32_t> corners, int line) {
  if (corners.size() > most_corners) {
    fail(line, fmt::format("face {} has {} corners; allowed: 3 to {}", face_, corners.size(),
                           most_corners));
  }
  const Vector3 normal = area_vector(file_.mesh.vertices, corners);
  if (!(normal.cwiseAbs().maxCoeff() > 0.0)) {
    fail(line, fmt::format("face {} has {} corners and no area: it cannot be divided into "
                           "triangles",
                           face_, corners.size()));
  }
  ++file_.divided_polygons;
  const Projection plane = projection_along(file_.mesh.vertices, normal);
  walk_.assign(corners.begin(), corners.end());
  while (walk_.size() > 3) {
    const std::size_t n = walk_.size();
    std::size_t ear = 1;  // the first cut is that of a fan from corner 0
    while (ear <= n && !plane.is_ear(walk_, ear % n)) {
      ++ear;
    }
    if (ear > n) {
      fail_to_divide(line);
    }
    ear %= n;
    triangle(walk_[(ear + n - 1) % n], walk_[ear], walk_[(ear + 1) % n], line);
    walk_.erase(walk_.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  if (plane.area(walk_[0], walk_[1], walk_[2]) < 0.0) {
    fail_to_divide(line);
  }
  triangle(walk_[0], walk_[1], walk_[2], line);
}

void MeshBuilder::fail_to_divide(int line) const {
  fail(line, fmt::format("face {} crosses or touches itself: it cannot be divided into triangles",
                         face_));
}

void MeshBuilder::check_normal(std::span<const std::uint32_t> corners) {
  if (normal_.allFinite() && area_vector(file_.mesh.vertices, corners).dot(normal_) < 0.0) {
    ++file_.contrary_normals;
  }
}

void MeshBuilder::renumber() {
  std::vector<Vector3>& vertices = file_.mesh.vertices;
  std::vector<std::uint8_t> used(vertices.size(), 0);
  for (const Triangle& t : file_.mesh.triangles) {
    for (const std::uint32_t corner : t) {
      used[corner] = 1;
    }
  }
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  std::erase_if(order, [&](std::uint32_t i) { return used[i] == 0; });
  file_.unused_vertices = vertices.size() - order.size();
  const auto place = [&](std::uint32_t i) {
    return std::tuple(vertices[i].x(), vertices[i].y(), vertices[i].z());
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    return std::tuple_cat(place(i), std::tuple(i)) < std::tuple_cat(place(j), std::tuple(j));
  });
  // The first of equal ones stands for all; those that are left keep their order.
  std::vector<std::uint32_t> stands_for(vertices.size());
  std::vector<std::uint8_t> kept(vertices.size(), 0);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool repeats = i > 0 && vertices[order[i]] == vertices[order[i - 1]];
    stands_for[order[i]] = repeats ? stands_for[order[i - 1]] : order[i];
    kept[order[i]] = repeats ? 0 : 1;
    file_.merged_vertices += repeats ? 1 : 0;
  }
  std::vector<std::uint32_t> number(vertices.size());
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    number[i] = count;
    if (kept[i] != 0) {
      vertices[count++] = vertices[i];
    }
  }
  vertices.resize(count);
  for (Triangle& t : file_.mesh.triangles) {
    for (std::uint32_t& corner : t) {
      corner = number[stands_for[corner]];
    }
  }
}

MeshFile MeshBuilder::finish() {
  if (file_.mesh.triangles.empty()) {
    fail(0, "has no faces; needed: at least one triangle");
  }
  renumber();
  file_.mesh.vertices.shrink_to_fit();
  return std::move(file_);
}

}  // namespace core
}  // namespace kairos
