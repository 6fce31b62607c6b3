// A model of the thesis' objects: any text is either refused with a reason, or a mesh whose faces
// name vertices that are there, a box around all of them, and the mass of what the mesh encloses.
#include "core/error.hpp"
#include "core/mass_properties.hpp"
#include "core/reading/off_file.hpp"
#include "tests/fuzz/fuzz_target.hpp"

#include <cmath>
#include <string_view>

using namespace kairos;
using kairos::fuzz::require;

namespace {

void check_box(const OffModel& model) {
  const FittedBox box = fit_box(model);
  require(box.half_extents.minCoeff() >= 0.0, "a box has no extent");
  for (const Vector3& vertex : model.vertices) {
    const Vector3 outside = (vertex - box.centre).cwiseAbs() - box.half_extents;
    // Roundoff of a sum and a difference of coordinates.
    require(outside.maxCoeff() <= 4e-16 * (vertex.cwiseAbs() + box.half_extents).maxCoeff(),
            "a vertex is outside its box");
  }
}

/// Faces with more corners as fans of triangles.
std::vector<Triangle> triangles(const OffModel& model) {
  std::vector<Triangle> made;
  for (const auto& face : model.faces) {
    for (std::size_t k = 2; k < face.size(); ++k) {
      made.push_back({static_cast<std::uint32_t>(face[0]), static_cast<std::uint32_t>(face[k - 1]),
                      static_cast<std::uint32_t>(face[k])});
    }
  }
  return made;
}

void check_mass(const OffModel& model) {
  const MassProperties mass = mass_properties(model.vertices, triangles(model));
  require(std::isfinite(mass.volume) && mass.volume > 0.0, "a solid has no volume");
  require(std::isfinite(mass.centre.sum()), "a centre of mass is nowhere");
  require(mass.moments.minCoeff() >= 0.0 && std::isfinite(mass.moments.sum()),
          "a moment of inertia is none");
  require(std::abs(mass.axes.norm() - 1.0) < 1e-9, "an orientation is not unit");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const OffModel model = parse_off({reinterpret_cast<const char*>(data), size}, "model.off");
    check_box(model);
    check_mass(model);
  } catch (const InputError& error) {
    require(!error.reason().empty(), "a model is refused without a reason");
  }
  return 0;
}
