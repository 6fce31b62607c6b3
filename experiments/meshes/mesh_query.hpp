#pragma once

#include "ccd/mesh/mesh_queries.hpp"
#include "experiments/toi/csv_columns.hpp"

#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments {

/// How the meshes of a file of queries are read.
struct MeshOptions {
  std::string mesh_a, mesh_b;  ///< files of all rows, where these name none
  double scale = 1.0;          ///< m per unit of the files
  bool solid = false;
};

/// Meshes by their files, each read once; shared by threads.
class MeshLibrary {
 public:
  explicit MeshLibrary(MeshOptions options) : options_(std::move(options)) {}
  /// Throws `InputError`.
  [[nodiscard]] std::shared_ptr<const CollisionMesh> find(const std::string& path);
  [[nodiscard]] const MeshOptions& options() const { return options_; }

 private:
  MeshOptions options_;
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const CollisionMesh>, std::less<>> meshes_;
};

/// One row: two meshes and where they are.
struct MeshRow {
  std::string_view id;  ///< as written, quotes included: a view of the row
  std::shared_ptr<const CollisionMesh> mesh_a, mesh_b;
  Pose pose_a, pose_b;
};

/// Where the columns of a file of poses are: id; for a_ and b_ each px,py,pz (m) and qw,qx,qy,qz (a
/// unit quaternion, body to world); a_mesh, b_mesh may name files. Const after construction.
class MeshQueryFormat {
 public:
  /// `header` is line `line` of the file; `file` is for messages. Reads the meshes of all rows.
  /// Throws `InputError`.
  MeshQueryFormat(std::string_view header, std::int64_t line, const std::string& file,
                  MeshLibrary& library);

  /// Reads a row into fields of its own, which are used again. Throws `BadField`.
  [[nodiscard]] MeshRow read(std::string_view row, std::vector<std::string_view>& fields) const;
  /// The id of a row that may be bad; empty if it has none.
  [[nodiscard]] std::string_view id(std::string_view row,
                                    std::vector<std::string_view>& fields) const {
    return CsvColumns::field(row, id_, fields);
  }

 private:
  struct Body {
    std::array<std::size_t, 7> numbers{};
    std::size_t mesh = CsvColumns::absent;
    std::shared_ptr<const CollisionMesh> always;  ///< where the rows name none
  };
  [[nodiscard]] Body find_body(const std::string& prefix, const std::string& path) const;
  [[nodiscard]] std::shared_ptr<const CollisionMesh> mesh(
      const Body& body, const std::vector<std::string_view>& fields) const;
  [[nodiscard]] Pose pose(const Body& body, const std::vector<std::string_view>& fields) const;

  CsvColumns columns_;
  MeshLibrary& library_;
  std::size_t id_ = 0;
  Body a_, b_;
};

}  // namespace kairos::experiments
