#include "core/error.hpp"
#include "core/reading/csv.hpp"
#include "experiments/cli/checks.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/meshes/mesh_stream.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

namespace kairos::experiments {
namespace {

struct MeshCommand {
  std::string queries;
  std::string scale = "1";
  std::string tolerance;
  MeshStreamOptions options;

  void run(std::int64_t (*answer)(LineBlocks&, const MeshStreamOptions&));
};

double number(const std::string& text, const char* option, double lowest, const char* allowed) {
  const std::optional<double> value = parse_number(text);
  if (!value || !(*value >= lowest)) {
    throw InputError("", 0, option, fmt::format("'{}' is not allowed; allowed: {}", text, allowed));
  }
  return *value;
}

void MeshCommand::run(std::int64_t (*answer)(LineBlocks&, const MeshStreamOptions&)) {
  options.meshes.scale = number(scale, "--scale", 1e-12, "a number from 1e-12 (m per unit)");
  if (!tolerance.empty()) {
    options.tolerance = number(tolerance, "--tolerance", 0.0, "a finite number >= 0 (m)");
  }
  LineBlocks rows(queries);
  const std::int64_t bad = answer(rows, options);
  if (bad > 0) {
    throw InputError(rows.name(), 0, "",
                     fmt::format("{} {} invalid", bad, bad == 1 ? "row is" : "rows are"));
  }
}

Command add_mesh_command(Command& app, const std::string& name, const std::string& what,
                         const std::shared_ptr<MeshCommand>& command) {
  Command meshes = app.add_subcommand(name, what);
  meshes
      .add_option("queries", command->queries,
                  "CSV with a header and one query per row; - reads stdin")
      .required()
      .type_name("POSES.csv");
  MeshOptions& options = command->options.meshes;
  meshes.add_option("--a", options.mesh_a, "mesh a of all rows: .off, .obj or .stl")
      .type_name("MESH");
  meshes.add_option("--b", options.mesh_b, "mesh b of all rows").type_name("MESH");
  meshes.add_option("--scale", command->scale, "m per unit of the meshes (0.001: millimetres)")
      .type_name("X")
      .capture_default_str();
  meshes.add_flag("--solid", options.solid,
                  "meshes are solids, closed and oriented: what is inside touches");
  meshes.add_option("--threads", command->options.rows.threads, "how many (default: one per core)")
      .type_name("N")
      .check(whole_number(0, 1024));
  meshes.add_flag("--keep-going", command->options.rows.keep_going,
                  "name bad rows, answer them `invalid`, and go on; the exit status is still 2");
  return meshes;
}

constexpr const char* columns =
    "Columns, SI units, world frame: id; then for each of a_ and b_: px,py,pz and the unit\n"
    "quaternion qw,qx,qy,qz (body to world); optional a_mesh, b_mesh: files, instead of --a, --b.\n"
    "Triangles are counted from 0 in the order of the file, polygons divided.\n";

}  // namespace

void add_collide_command(Command& app) {
  const auto command = std::make_shared<MeshCommand>();
  Command collide =
      add_mesh_command(app, "collide", "Do meshes touch, and which triangles: exact", command);
  collide.add_flag("--all", command->options.all, "a line for every pair of triangles that touch");
  collide.footer(
      std::string(columns) +
      "Answer: id,verdict,a_triangle,b_triangle in the same order. The verdict is apart,\n"
      "touching, or with --solid a inside, b inside; without an error, for the numbers of "
      "the file\nas doubles and the rotation of q whatever its length. The first pair "
      "found, or all, ascending.");
  collide.callback([command] { command->run(answer_collide_queries); });
}

void add_distance_command(Command& app) {
  const auto command = std::make_shared<MeshCommand>();
  Command distance =
      add_mesh_command(app, "distance", "How far meshes are apart, between proven bounds", command);
  Argument tolerance = distance
                           .add_option("--tolerance", command->tolerance,
                                       "only whether they are at most that far apart (m)")
                           .type_name("X");
  distance
      .add_flag("--all", command->options.all,
                "with --tolerance: a line for every pair of triangles")
      .needs(tolerance);
  distance.footer(
      std::string(columns) +
      "Answer: id,verdict,lower,upper,ax,ay,az,bx,by,bz,a_triangle,b_triangle in the same order. "
      "The\n"
      "distance is between lower and upper (m); both are 0 where they touch, by a proof. The "
      "points "
      "of a\nand b are at most upper apart. With --tolerance: id,within,lower,upper with within "
      "yes, "
      "no, or\nundecided where it lies between the bounds; with --all as well a line "
      "id,within,a_triangle,\nb_triangle,lower,upper for each pair that is not proven to be "
      "farther apart.");
  distance.callback([command] { command->run(answer_distance_queries); });
}

}  // namespace kairos::experiments
