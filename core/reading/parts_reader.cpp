#include "core/reading/parts_reader.hpp"

#include "core/compound_body.hpp"
#include "core/mesh_body.hpp"
#include "core/reading/orientation_reader.hpp"
#include "core/reading/scene_keys.hpp"
#include "core/reading/scene_limits.hpp"
#include "core/reading/shape_reader.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

namespace kairos {
inline namespace core {
namespace {

constexpr std::size_t most_parts = 1'000;
constexpr std::size_t most_heights = 1'000;

/// Refuses rounded hulls in what moves freely: it turns about its centre of mass, and that of a
/// rounded hull is not known.
void check_rounding(const TableReader& table, const Shape& shape, bool moves_freely) {
  const auto* hull = std::get_if<Hull>(&shape);
  if (moves_freely && hull != nullptr && hull->rounding > 0.0) {
    table.fail("rounding",
               "is not 0, and the body moves freely: the centre of mass of a rounded hull is not "
               "known; allowed: 0 here, and any for parts of walls and driven bodies");
  }
}

CompoundPart read_part(const Item& item, const std::string& directory, bool moves_freely) {
  const TableReader table(item);
  table.refuse_unknown(scene_keys_of("body.part"));
  CompoundPart part{read_shape(table, directory, false), {}};
  if (shape_rank(part.shape) > shape_rank(Hull{})) {
    table.fail("shape", fmt::format("is a {}; allowed: a sphere, a box, a capsule, a cylinder, a "
                                    "cone or a hull",
                                    shape_name(part.shape)));
  }
  check_rounding(table, part.shape, moves_freely);
  if (const auto position = table.find("position")) {
    part.pose.position = position->vector(limits::position);
  }
  part.pose.orientation = read_orientation(table);
  return part;
}

}  // namespace

Shape read_compound(const TableReader& table, const std::string& directory, bool moves_freely) {
  const Item item = table.need("part", "[[body.part]] for each part");
  const Array& array = item.array();
  if (array.empty() || array.size() > most_parts) {
    item.fail(fmt::format("has {} parts; allowed: 1 to {}", array.size(), most_parts));
  }
  std::vector<CompoundPart> parts;
  for (std::size_t i = 0; i < array.size(); ++i) {
    parts.push_back(
        read_part(Item(array[i], fmt::format("{}[{}]", item.path(), i)), directory, moves_freely));
  }
  return Compound{moves_freely ? compound_body(std::move(parts)).body
                               : compound_in_place(std::move(parts))};
}

/// Rows follow each other along x, the numbers of a row along z.
Shape read_height_field(const TableReader& table) {
  const Item item = table.need("heights", "rows of numbers (m)");
  const std::vector<double> spacing =
      table.need("spacing", "[along x, along z] (m)").numbers(2, limits::extent);
  const Array& rows = item.array();
  if (rows.size() < 2 || rows.size() > most_heights) {
    item.fail(fmt::format("has {} rows; allowed: 2 to {}", rows.size(), most_heights));
  }
  MeshData mesh;
  std::size_t columns = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Item row(rows[i], fmt::format("{}[{}]", item.path(), i));
    const std::size_t count = row.array().size();
    columns = i == 0 ? count : columns;
    if (count < 2 || count > most_heights || count != columns) {
      row.fail(fmt::format("has {} numbers; allowed: 2 to {}, as many in each row", count,
                           most_heights));
    }
    const std::vector<double> heights = row.numbers(count, limits::position);
    for (std::size_t k = 0; k < count; ++k) {
      const auto middle = [](std::size_t at, std::size_t all) {
        return static_cast<double>(at) - 0.5 * static_cast<double>(all - 1);
      };
      mesh.vertices.emplace_back(middle(i, rows.size()) * spacing[0], heights[k],
                                 middle(k, columns) * spacing[1]);
    }
  }
  const auto at = [columns](std::size_t i, std::size_t k) {
    return static_cast<std::uint32_t>(i * columns + k);
  };
  for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
    for (std::size_t k = 0; k + 1 < columns; ++k) {
      mesh.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i + 1, k)});
    }
  }
  return Mesh{mesh_in_place(std::move(mesh), CollisionMesh::Kind::surface)};
}

}  // namespace core
}  // namespace kairos
