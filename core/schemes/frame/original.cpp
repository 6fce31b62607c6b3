#include "core/schemes/frame/original.hpp"

#include "core/schemes/frame/frame_joints.hpp"
#include "core/schemes/frame/frame_world.hpp"

namespace kairos {
inline namespace core {
namespace {

class Original final : public Scheme {
 public:
  [[nodiscard]] SchemeInfo info() const override {
    return {"original",
            "once a frame: draw, detect and handle, move (fig. 7)",
            "Dembovsky1999",
            false,
            false,
            {},
            true};
  }

  [[nodiscard]] std::string refuses(const Model& model, const Method&,
                                    const SchemeOptions&) const override {
    return why_not_jointed(model);
  }

  RunResult run(const Model& model, const Method& method, const SchemeOptions& options,
                Recorder& recorder) const override {
    FrameWorld world(model, method, options, recorder);
    while (world.draw()) {
      world.trace(Stage::detect, 0.0);
      if (detect_and_handle(world) > 0) {
        world.trace(Stage::handle, 0.0);
      }
      world.advance(world.frame_duration());
      world.trace(Stage::calculate_positions, 1.0);
    }
    return std::move(world).result();
  }
};

}  // namespace

std::unique_ptr<Scheme> make_original() { return std::make_unique<Original>(); }

}  // namespace core
}  // namespace kairos
