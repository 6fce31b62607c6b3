#include "experiments/meshes/mesh_query.hpp"

#include "core/reading/mesh_file.hpp"
#include "core/reading/scene_limits.hpp"

#include <cmath>
#include <optional>

namespace kairos::experiments {
namespace {

constexpr std::array<const char*, 7> number_names{"px", "py", "pz", "qw", "qx", "qy", "qz"};
constexpr std::string_view needed =
    "id, then px py pz qw qx qy qz with a_ and with b_ before each; and the meshes, by columns "
    "a_mesh and b_mesh or by --a and --b";

}  // namespace

std::shared_ptr<const CollisionMesh> MeshLibrary::find(const std::string& path) {
  const std::lock_guard lock(mutex_);
  const auto known = meshes_.find(path);
  if (known != meshes_.end()) {
    return known->second;
  }
  using Kind = CollisionMesh::Kind;
  try {
    auto mesh = std::make_shared<const CollisionMesh>(read_mesh(path, options_.scale).mesh,
                                                      options_.solid ? Kind::solid : Kind::surface);
    meshes_.emplace(path, mesh);
    return mesh;
  } catch (const InputError& error) {
    if (!error.file().empty()) {
      throw;
    }
    throw InputError(path, 0, "", "is no solid: " + error.reason());
  }
}

MeshQueryFormat::MeshQueryFormat(std::string_view header, std::int64_t line,
                                 const std::string& file, MeshLibrary& library)
    : columns_(header, line, file), library_(library), id_(columns_.need("id", needed)) {
  a_ = find_body("a_", library.options().mesh_a);
  b_ = find_body("b_", library.options().mesh_b);
}

MeshQueryFormat::Body MeshQueryFormat::find_body(const std::string& prefix,
                                                 const std::string& path) const {
  Body body;
  for (std::size_t i = 0; i < number_names.size(); ++i) {
    body.numbers[i] = columns_.need(prefix + number_names[i], needed);
  }
  if (path.empty()) {
    body.mesh = columns_.need(prefix + "mesh", needed);
  } else {
    body.mesh = columns_.find(prefix + "mesh");
    body.always = library_.find(path);
  }
  return body;
}

std::shared_ptr<const CollisionMesh> MeshQueryFormat::mesh(
    const Body& body, const std::vector<std::string_view>& fields) const {
  const std::string_view path =
      body.mesh == CsvColumns::absent ? std::string_view() : unquoted(fields[body.mesh]);
  if (path.empty() && body.always) {
    return body.always;
  }
  try {
    return library_.find(std::string(path));
  } catch (const InputError& error) {
    throw BadField{columns_.name(body.mesh), error.what()};
  }
}

Pose MeshQueryFormat::pose(const Body& body, const std::vector<std::string_view>& fields) const {
  std::array<double, 7> x{};
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::string_view field = fields[body.numbers[i]];
    const std::optional<double> value = parse_number(unquoted(field));
    const Range& range = i < 3 ? limits::position : limits::component;
    if (!value || !range.contains(*value)) {
      throw BadField{columns_.name(body.numbers[i]),
                     fmt::format("'{}' is not allowed; allowed: {}", field, range.text())};
    }
    x[i] = *value;
  }
  const Pose pose{{x[0], x[1], x[2]}, {x[3], x[4], x[5], x[6]}};
  const double norm = pose.orientation.norm();
  if (!(std::abs(norm - 1.0) <= limits::quaternion_norm)) {
    throw BadField{columns_.name(body.numbers[3]),
                   fmt::format("the quaternion has length {}; allowed: 1 within {}", norm,
                               limits::quaternion_norm)};
  }
  return pose;
}

MeshRow MeshQueryFormat::read(std::string_view row, std::vector<std::string_view>& fields) const {
  columns_.split(row, fields);
  return {fields[id_], mesh(a_, fields), mesh(b_, fields), pose(a_, fields), pose(b_, fields)};
}

}  // namespace kairos::experiments
