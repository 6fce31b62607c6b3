#include "core/schemes/frame/geometric.hpp"

#include "core/schemes/frame/frame_joints.hpp"
#include "core/schemes/frame/frame_world.hpp"

namespace kairos {
inline namespace core {
namespace {

/// The time within the frame at which the pair meets; negative if it does not.
double contact_within(FrameWorld& world, BodyIndex a, BodyIndex b) {
  if (!world.swept_overlap(a, b)) {
    return -1.0;
  }
  const TimeOfImpact toi = world.time_of_impact(a, b, world.frame_duration());
  return toi.status == ToiStatus::separated ? -1.0 : toi.t_lo;
}

void handle_contacts(FrameWorld& world) {
  for (BodyIndex current = 0; current < world.size(); ++current) {
    for (BodyIndex next = current + 1; next < world.size(); ++next) {
      const Model& model = world.model();
      if (!model.interacts(current, next)) {
        continue;
      }
      if (model.is_field(current) || model.is_field(next)) {
        continue;  // fields act where bodies are when the frame begins
      }
      if (const double s = contact_within(world, current, next); s >= 0.0) {
        world.trace(Stage::locate, s / world.frame_duration());
        world.bend(current, next, s);
        break;
      }
    }
  }
}

class Geometric final : public Scheme {
 public:
  [[nodiscard]] SchemeInfo info() const override {
    return {"geometric",
            "once a frame, with the box swept by each body (fig. 14)",
            "Dembovsky1999",
            true,
            false,
            {},
            true};
  }

  [[nodiscard]] std::string refuses(const Model& model, const Method& method,
                                    const SchemeOptions&) const override {
    if (!method.detector->info().locates) {
      return "geometric needs a detector that locates contacts within the frame";
    }
    return why_not_jointed(model);
  }

  RunResult run(const Model& model, const Method& method, const SchemeOptions& options,
                Recorder& recorder) const override {
    FrameWorld world(model, method, options, recorder);
    while (world.draw()) {
      give_field_forces(world);
      world.propose(world.frame_duration());
      world.trace(Stage::calculate_positions, 0.0);
      world.trace(Stage::detect, 0.0);
      handle_contacts(world);
      world.accept(world.frame_duration());
      world.trace(Stage::advance, 1.0);
    }
    return std::move(world).result();
  }
};

}  // namespace

std::unique_ptr<Scheme> make_geometric() { return std::make_unique<Geometric>(); }

}  // namespace core
}  // namespace kairos
