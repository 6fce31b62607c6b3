// A scene file: any text is either refused with a reason, or a model whose numbers are finite.
#include "core/error.hpp"
#include "core/model.hpp"
#include "tests/fuzz/fuzz_target.hpp"

#include <cmath>
#include <string_view>

using namespace kairos;
using kairos::fuzz::require;

namespace {

void check(const Model& model) {
  for (const BodyState& s : model.initial_state()) {
    require(std::isfinite(s.pose.position.sum() + s.twist.linear.sum() + s.twist.angular.sum()),
            "a body starts where no number is");
    require(std::abs(s.pose.orientation.norm() - 1.0) < 1e-9, "an orientation is not unit");
  }
  for (BodyIndex i = 0; i < model.size(); ++i) {
    require(std::isfinite(model.gravity_force(i).sum()), "gravity is not finite");
    require(std::isfinite(model.kinetic_energy(i, model.body(i).initial)), "energy is not finite");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    check(Model(parse_scene(text, "scene.toml")));
  } catch (const InputError& error) {
    require(!error.reason().empty(), "a scene is refused without a reason");
  }
  return 0;
}
