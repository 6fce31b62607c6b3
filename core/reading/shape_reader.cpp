#include "core/reading/shape_reader.hpp"

#include "core/error.hpp"
#include "core/mesh_body.hpp"
#include "core/reading/mesh_file.hpp"
#include "core/reading/parts_reader.hpp"
#include "core/reading/scene_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

/// A shape, and the keys that its size is told by.
struct ShapeKind {
  std::string_view name;
  std::string_view keys[4];
};
constexpr ShapeKind kinds[] = {
    {"sphere", {"radius"}},
    {"box", {"half_extents"}},
    {"half-space", {}},
    {"capsule", {"radius", "length"}},
    {"cylinder", {"radius", "length"}},
    {"cone", {"radius", "height"}},
    {"hull", {"points", "file", "unit", "rounding"}},
    {"mesh", {"file", "unit", "solid"}},
    {"compound", {"part"}},
    {"height-field", {"heights", "spacing"}},
};
constexpr std::string_view all_keys[] = {"shape",  "radius",  "half_extents", "length",   "height",
                                         "points", "file",    "unit",         "rounding", "solid",
                                         "part",   "heights", "spacing"};
/// Points of a hull that are written in the scene.
constexpr std::size_t most_points = 100'000;
constexpr Range unit_range{.lowest = 0.0, .highest = 1e6, .above = true, .unit = "m"};
constexpr Range rounding_range{.lowest = 0.0, .highest = 1e12, .unit = "m"};

/// The keys of its size, for a message.
std::string sizes(const ShapeKind& kind) {
  std::string names;
  for (const std::string_view key : kind.keys) {
    names += key.empty() ? "" : (names.empty() ? "" : ", ") + std::string(key);
  }
  return names.empty() ? "none, it has no end" : names;
}

/// The kind of shape: what is said, or what the size that is given implies.
const ShapeKind& shape_kind(const TableReader& table) {
  if (const auto item = table.find("shape")) {
    std::vector<std::string_view> names;
    for (const ShapeKind& kind : kinds) {
      names.push_back(kind.name);
    }
    return kinds[item->choice(names)];
  }
  if (table.has("radius") == table.has("half_extents")) {
    table.fail("shape", table.has("radius")
                            ? "is ambiguous: both radius and half_extents are given"
                            : "is missing; needed: shape, or radius (a sphere), or half_extents "
                              "(a box)");
  }
  return table.has("radius") ? kinds[0] : kinds[1];
}

double extent(const TableReader& table, std::string_view key) {
  return table.need(key, limits::extent.text()).number(limits::extent);
}

std::vector<Vector3> written_points(const Item& item) {
  const Array& array = item.array();
  if (array.size() < 4 || array.size() > most_points) {
    item.fail(fmt::format("has {} points; allowed: 4 to {}", array.size(), most_points));
  }
  std::vector<Vector3> points;
  for (std::size_t i = 0; i < array.size(); ++i) {
    points.push_back(
        Item(array[i], fmt::format("{}[{}]", item.path(), i)).vector(limits::position));
  }
  return points;
}

MeshData mesh_of_file(const Item& item, const TableReader& table, const std::string& directory) {
  const auto unit = table.find("unit");
  return read_mesh(item.readable_file(directory), unit ? unit->number(unit_range) : 1.0).mesh;
}

Shape read_hull(const TableReader& table, const std::string& directory) {
  const auto points = table.find("points");
  const auto file = table.find("file");
  if (points.has_value() == file.has_value()) {
    table.fail(points ? "file" : "points",
               points ? "points are given too; allowed: one of points and file"
                      : "is missing; needed: points, or file (.off, .obj or .stl)");
  }
  if (points && table.has("unit")) {
    table.fail("unit", "is that of a file; points are in m; allowed: unit beside file only");
  }
  const auto rounding = table.find("rounding");
  const Item& source = points ? *points : *file;
  try {
    ConvexHull hull = convex_hull(points ? written_points(*points)
                                         : mesh_of_file(*file, table, directory).vertices);
    if (!limits::extent.contains(hull.polytope->width)) {
      source.fail(fmt::format("the hull is {} m thin; allowed: {}", hull.polytope->width,
                              limits::extent.text()));
    }
    return Hull{std::move(hull.polytope), rounding ? rounding->number(rounding_range) : 0.0};
  } catch (const std::invalid_argument& error) {
    source.fail(error.what());
  }
}

/// A body that moves freely is a solid, unless it is told how it turns.
Shape read_mesh_shape(const TableReader& table, const std::string& directory, bool moves_freely) {
  const Item file = table.need("file", "path of an .off, .obj or .stl");
  const auto told = table.find("solid");
  const bool solid = told ? told->flag() : moves_freely && !table.has("inertia");
  MeshData data = mesh_of_file(file, table, directory);
  try {
    if (solid && moves_freely) {
      return Mesh{solid_body(std::move(data)).body};
    }
    using Kind = CollisionMesh::Kind;
    return Mesh{mesh_in_place(std::move(data), solid ? Kind::solid : Kind::surface)};
  } catch (const InputError& error) {
    if (!solid) {
      file.fail(error.reason());
    }
    file.fail(fmt::format("is no solid: it {}; allowed: a closed mesh, or solid = false{}",
                          error.reason(), moves_freely ? " and inertia" : ""));
  }
}

}  // namespace

std::span<const std::string_view> shape_keys() { return all_keys; }

Shape read_shape(const TableReader& table, const std::string& directory, bool moves_freely) {
  const ShapeKind& kind = shape_kind(table);
  for (const std::string_view key : shape_keys().subspan(1)) {
    if (table.has(key) &&
        std::find(std::begin(kind.keys), std::end(kind.keys), key) == std::end(kind.keys)) {
      table.fail(key, fmt::format("a {} has no {}; allowed: {}", kind.name, key, sizes(kind)));
    }
  }
  if (kind.name == "sphere") {
    return Sphere{extent(table, "radius")};
  }
  if (kind.name == "box") {
    return Box{table.need("half_extents", "an array of 3 numbers").vector(limits::extent)};
  }
  if (kind.name == "capsule") {
    return Capsule{extent(table, "radius"), extent(table, "length")};
  }
  if (kind.name == "cylinder") {
    return Cylinder{extent(table, "radius"), extent(table, "length")};
  }
  if (kind.name == "cone") {
    return Cone{extent(table, "radius"), extent(table, "height")};
  }
  if (kind.name == "hull") {
    return read_hull(table, directory);
  }
  if (kind.name == "mesh") {
    return read_mesh_shape(table, directory, moves_freely);
  }
  if (kind.name == "compound") {
    return read_compound(table, directory, moves_freely);
  }
  return kind.name == "height-field" ? read_height_field(table) : Shape{HalfSpace{}};
}

}  // namespace core
}  // namespace kairos
