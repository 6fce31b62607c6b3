#include "core/schemes/frame/substepped.hpp"

#include "core/schemes/frame/frame_joints.hpp"
#include "core/schemes/frame/substeps.hpp"

namespace kairos {
inline namespace core {
namespace {

class Substepped final : public Scheme {
 public:
  [[nodiscard]] SchemeInfo info() const override {
    return {"substepped",
            "fractions of the frame with limited movement (fig. 15)",
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
    SubstepPlan plan(model, options);
    while (world.draw()) {
      const double frame = world.frame_duration();
      plan.begin_frame(frame);
      for (double left = frame; left > 0.0;) {
        world.propose(left);
        world.trace(Stage::calculate_positions, 1.0 - left / frame);
        const double part = plan.next(world, left);
        if (part <= 0.0) {
          return std::move(world).result();
        }
        if (part < left) {
          world.trace(Stage::restrict_movement, part / frame);
        }
        world.accept(part);
        left = part < left ? left - part : 0.0;
        world.trace(Stage::advance, 1.0 - left / frame);
        world.trace(Stage::detect, 1.0 - left / frame);
        if (detect_and_handle(world) > 0) {
          world.trace(Stage::handle, 1.0 - left / frame);
        }
      }
    }
    return std::move(world).result();
  }
};

}  // namespace

std::unique_ptr<Scheme> make_substepped() { return std::make_unique<Substepped>(); }

}  // namespace core
}  // namespace kairos
