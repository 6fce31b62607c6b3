#include "experiments/meshes/deforming_frames.hpp"

#include "ccd/deforming/deforming_pair.hpp"
#include "core/error.hpp"
#include "core/reading/mesh_file.hpp"
#include "simulation/output/csv_row.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string_view>

namespace kairos::experiments {
namespace {

using ccd::DeformingMesh;
using ccd::DeformingPair;
using ccd::Meeting;
using ccd::MeetingKind;

DeformingMesh read_first(const std::string& path, double scale) {
  try {
    return DeformingMesh(read_mesh(path, scale).mesh);
  } catch (const InputError& error) {
    throw InputError(error.file().empty() ? path : error.file(), error.line(), error.key(),
                     error.reason());
  }
}

void move_to(DeformingMesh& mesh, const std::string& path, const std::string& first, double scale) {
  const MeshData next = read_mesh(path, scale).mesh;
  if (next.vertices.size() != mesh.end().size() || next.triangles != mesh.triangles()) {
    throw InputError(
        path, 0, "",
        fmt::format("has {} vertices and {} triangles, or other corners; needed: those "
                    "of {} ({} and {}), where vertices in one place count as one",
                    next.vertices.size(), next.triangles.size(), first, mesh.end().size(),
                    mesh.triangles().size()));
  }
  mesh.move_to(next.vertices);
}

/// A vertex or a face by its number, an edge by those of its ends.
std::string feature(const DeformingMesh& mesh, MeetingKind kind, std::uint32_t number) {
  if (kind != MeetingKind::edge_edge) {
    return fmt::format("{}", number);
  }
  return fmt::format("{}-{}", mesh.edges()[number][0], mesh.edges()[number][1]);
}

void write(CsvRow& row, std::size_t step, const DeformingMesh& a, const DeformingMesh& b,
           const Meeting& met) {
  row.count(static_cast<std::int64_t>(step))
      .text(ccd::meeting_kind_names[static_cast<std::size_t>(met.kind)])
      .text(feature(a, met.kind, met.a))
      .text(feature(b, met.kind, met.b))
      .number(met.impact.t_lo)
      .number(met.impact.t_hi)
      .text(ccd::linear_stage_names[static_cast<std::size_t>(met.impact.stage)]);
  const std::string_view line = row.finish();
  std::fwrite(line.data(), 1, line.size(), stdout);
}

}  // namespace

void write_meetings(const DeformingFramesOptions& options) {
  const auto& frames = options.frames;
  const auto& others = options.others;
  if (others.size() > 1 && others.size() != frames.size()) {
    throw InputError("", 0, "--with",
                     fmt::format("is given {} files; allowed: 1, or {} as of the first mesh",
                                 others.size(), frames.size()));
  }
  DeformingMesh a = read_first(frames.front(), options.scale);
  std::unique_ptr<DeformingMesh> b;
  if (!others.empty()) {
    b = std::make_unique<DeformingMesh>(read_first(others.front(), options.scale));
  }
  const DeformingMesh& other = b ? *b : a;
  DeformingPair pair(a, other, {.separation = options.separation});
  CsvRow row;
  fmt::print("step,kind,a,b,t_lo,t_hi,stage\n");
  for (std::size_t step = 0; step < frames.size(); ++step) {
    if (step > 0) {
      move_to(a, frames[step], frames.front(), options.scale);
      if (others.size() > 1) {
        move_to(*b, others[step], others.front(), options.scale);
      }
    }
    for (const Meeting& met : pair.meetings()) {
      write(row, step, a, other, met);
      if (options.first) {
        break;
      }
    }
  }
}

}  // namespace kairos::experiments
