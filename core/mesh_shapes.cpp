#include "core/mesh_shapes.hpp"

#include "core/circular.hpp"
#include "core/error.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

constexpr double pi = std::numbers::pi;

void need(bool holds, const char* reason) {
  if (!holds) {
    throw InputError("", 0, "mesh", reason);
  }
}

std::uint32_t count(const std::vector<Vector3>& vertices) {
  return static_cast<std::uint32_t>(vertices.size());
}

MeshData icosahedron() {
  const double a = 0.5;
  const double b = 0.5 * std::numbers::phi;
  MeshData mesh;
  mesh.vertices = {{-a, b, 0},  {a, b, 0},  {-a, -b, 0}, {a, -b, 0}, {0, -a, b},  {0, a, b},
                   {0, -a, -b}, {0, a, -b}, {b, 0, -a},  {b, 0, a},  {-b, 0, -a}, {-b, 0, a}};
  mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                    {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                    {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  return mesh;
}

MeshData finer(const MeshData& mesh, double radius) {
  MeshData result{mesh.vertices, {}};
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t i, std::uint32_t j) {
    const auto [at, is_new] = middles.try_emplace(std::minmax(i, j), count(result.vertices));
    if (is_new) {
      result.vertices.push_back(radius * (mesh.vertices[i] + mesh.vertices[j]).normalized());
    }
    return at->second;
  };
  for (const Triangle& t : mesh.triangles) {
    const std::uint32_t a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
    result.triangles.insert(result.triangles.end(),
                            {{t[0], a, c}, {t[1], b, a}, {t[2], c, b}, {a, b, c}});
  }
  return result;
}

}  // namespace

MeshData torus_mesh(double radius, double tube_radius, int around, int across) {
  need(tube_radius > 0.0 && radius > tube_radius && around >= 3 && across >= 3,
       "a torus needs a tube smaller than its radius, and three sections of three corners");
  MeshData mesh;
  for (int i = 0; i < around; ++i) {
    const double u = 2.0 * pi * i / around;
    for (int j = 0; j < across; ++j) {
      const double v = 2.0 * pi * j / across;
      const double from_axis = radius + tube_radius * cosine(v);
      mesh.vertices.emplace_back(from_axis * cosine(u), from_axis * sine(u), tube_radius * sine(v));
    }
  }
  const auto at = [&](int i, int j) {
    return static_cast<std::uint32_t>(i % around * across + j % across);
  };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

MeshData icosphere_mesh(int levels) {
  need(levels >= 0 && levels <= 9, "an icosphere is refined 0 to 9 times");
  MeshData mesh = icosahedron();
  const double radius = mesh.vertices.front().norm();
  for (int i = 0; i < levels; ++i) {
    mesh = finer(mesh, radius);
  }
  return mesh;
}

MeshData bumpy_sphere_mesh(int rows, int columns, double height) {
  need(rows >= 3 && columns >= 3 && std::abs(height) < 1.0,
       "a bumpy sphere needs three rows and columns, and bumps below its radius");
  MeshData mesh;
  mesh.vertices = {{0, 0, 1}, {0, 0, -1}};
  for (int i = 1; i < rows; ++i) {
    const double v = pi * i / rows;
    for (int j = 0; j < columns; ++j) {
      const double u = 2.0 * pi * j / columns;
      const double r = 1.0 + height * sine(5.0 * u) * sine(4.0 * v);
      mesh.vertices.emplace_back(r * sine(v) * cosine(u), r * sine(v) * sine(u), r * cosine(v));
    }
  }
  const auto at = [&](int i, int j) {
    return static_cast<std::uint32_t>(2 + (i - 1) * columns + j % columns);
  };
  for (int j = 0; j < columns; ++j) {
    mesh.triangles.push_back({0, at(1, j), at(1, j + 1)});
    mesh.triangles.push_back({1, at(rows - 1, j + 1), at(rows - 1, j)});
    for (int i = 1; i + 1 < rows; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

MeshData box_mesh(const Vector3& half) {
  MeshData mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.vertices.emplace_back((k & 1) != 0 ? half.x() : -half.x(),
                               (k & 2) != 0 ? half.y() : -half.y(),
                               (k & 4) != 0 ? half.z() : -half.z());
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

}  // namespace core
}  // namespace kairos
