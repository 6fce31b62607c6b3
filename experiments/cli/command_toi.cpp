#include "core/error.hpp"
#include "core/reading/csv.hpp"
#include "experiments/cli/checks.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/toi/toi_stream.hpp"
#include "simulation/registry.hpp"
#include "simulation/simulate.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>

namespace kairos::experiments {
namespace {

struct ToiCommand {
  std::string queries;
  std::string detector = MethodChoice{}.detector;
  std::string tolerance = "0";
  std::size_t threads = 0;
  bool keep_going = false;

  void run() const;
};

std::shared_ptr<const ContactDetector> locating_detector(const std::string& name) {
  std::shared_ptr<const ContactDetector> detector = find_detector(name);
  const auto answers = [](const ContactDetector& candidate) {
    return candidate.info().locates && !candidate.info().at_step_ends;
  };
  if (answers(*detector)) {
    return detector;
  }
  std::string locating;
  for (const auto& other : detectors()) {
    if (answers(*other)) {
      locating += fmt::format("{}{}", locating.empty() ? "" : ", ", other->info().name);
    }
  }
  throw InputError("", 0, "--detector",
                   fmt::format("'{}' {}; allowed: {}", name,
                               detector->info().at_step_ends
                                   ? "finds contacts only where an integrator's step ends"
                                   : "tells whether two shapes touch, not when",
                               locating));
}

void ToiCommand::run() const {
  const std::optional<double> metres = parse_number(tolerance);
  if (!metres || *metres < 0.0) {
    throw InputError("", 0, "--tolerance",
                     fmt::format("'{}' is not allowed; allowed: a finite number > 0 (m), or 0: the "
                                 "detector's default",
                                 tolerance));
  }
  const auto exact = locating_detector(detector);
  LineBlocks rows(queries);
  const std::int64_t bad = answer_toi_queries(rows, {exact, *metres, keep_going, threads});
  if (bad > 0) {
    throw InputError(rows.name(), 0, "",
                     fmt::format("{} {} invalid", bad, bad == 1 ? "row is" : "rows are"));
  }
}

}  // namespace

void add_toi_command(Command& app) {
  const auto command = std::make_shared<ToiCommand>();
  Command toi = app.add_subcommand("toi", "Times of impact of pairs of moving shapes");
  toi.add_option("queries", command->queries,
                 "CSV with a header and one query per row; - reads stdin")
      .required()
      .type_name("QUERIES.csv");
  toi.add_option("--detector", command->detector,
                 fmt::format("a detector that locates (default {})", command->detector))
      .type_name("D");
  toi.add_option("--tolerance", command->tolerance,
                 "m (default: 1e-9 of the smaller extent plus the roundoff of the coordinates)")
      .type_name("X");
  toi.add_option("--threads", command->threads, "how many (default: one per core)")
      .type_name("N")
      .check(whole_number(0, 1024));
  toi.add_flag(
      "--keep-going", command->keep_going,
      "name bad rows, answer them with the status `invalid`, and go on; the exit status is "
      "still 2");
  toi.footer(
      "Columns, SI units, world frame: id; then for each of a_ and b_: half-extents hx,hy,hz;\n"
      "centre px,py,pz; unit quaternion qw,qx,qy,qz (body to world); velocity vx,vy,vz;\n"
      "acceleration ax,ay,az; angular velocity wx,wy,wz; and duration. Optional a_shape, b_shape:\n"
      "box (default), sphere (radius in hx), half-space (through p, normal the body's +y),\n"
      "capsule, cylinder, cone (radius in hx, half the length or height in hy, along the body's "
      "y),\n"
      "hull (rounding in hx; a_points, b_points: \"x y z; x y z; ...\", p their centroid),\n"
      "mesh (its triangles) or solid (what they enclose), from an .off, .obj or .stl in a_file, a "
      "unit of it in hx,\n"
      "compound (a_parts: \"shape hx hy hz px py pz qw qx qy qz; ...\").\n"
      "Answer: id,status,t_lo,t_hi,gap,nx,ny,nz,evaluations in the same order.");
  toi.callback([command] { command->run(); });
}

}  // namespace kairos::experiments
