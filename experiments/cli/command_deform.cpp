#include "experiments/cli/checks.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/meshes/deforming_frames.hpp"

#include <limits>
#include <memory>

namespace kairos::experiments {

void add_deform_command(Command& app) {
  const auto options = std::make_shared<DeformingFramesOptions>();
  Command deform = app.add_subcommand(
      "deform",
      "What meets where vertices of meshes move on straight lines from file to file: exact");
  deform
      .add_option("frames", options->frames,
                  "one mesh over time, .off, .obj or .stl, always with the same triangles")
      .required()
      .type_name("MESH...");
  deform
      .add_option("--with", options->others,
                  "a second mesh: one file, at rest, or as many (default: the mesh and itself)")
      .type_name("MESH...");
  deform.add_option("--separation", options->separation, "two meet where they are that near (m)")
      .type_name("X")
      .check(finite_number(0.0, std::numeric_limits<double>::max()))
      .capture_default_str();
  deform.add_option("--scale", options->scale, "m per unit of the files (0.001: millimetres)")
      .type_name("X")
      .check(finite_number(1e-12, 1e12))
      .capture_default_str();
  deform.add_flag("--first", options->first, "only what meets first in each step");
  deform.footer(
      "Answer: step,kind,a,b,t_lo,t_hi,stage, by step and time. Step 0 is the first file at rest,\n"
      "step n goes from file n - 1 to file n, counted from 0, with t from 0 to 1. kind: "
      "vertex-face\n"
      "(vertex of the first mesh), face-vertex, edge-edge. Vertices and faces are counted from 0 "
      "in\n"
      "the order of the file, polygons divided, vertices in one place being one; edges are told "
      "by\n"
      "their two vertices. Nothing that meets is left out and nothing else told; the first time "
      "is\n"
      "t_lo where t_lo = t_hi, otherwise strictly between these adjacent doubles. Features of one\n"
      "mesh that share a vertex are not asked about.");
  deform.callback([options] { write_meetings(*options); });
}

}  // namespace kairos::experiments
