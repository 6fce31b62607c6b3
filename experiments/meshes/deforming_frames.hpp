#pragma once

#include <string>
#include <vector>

namespace kairos::experiments {

/// What is asked of meshes that deform from file to file.
struct DeformingFramesOptions {
  std::vector<std::string> frames;  ///< of a mesh, at least one
  std::vector<std::string> others;  ///< of a second one: one (at rest), or as many; none: of itself
  double scale = 1.0;               ///< m per unit of the files
  double separation = 0.0;          ///< m
  bool first = false;               ///< only the first of each step
};

/// Writes a line of CSV to stdout for each vertex and face, and each two edges, that meet between
/// two files. Throws `InputError` for files that are no meshes, or not of the same triangles.
void write_meetings(const DeformingFramesOptions& options);

}  // namespace kairos::experiments
