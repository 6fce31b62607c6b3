#include "core/schemes/frame/bisected.hpp"

#include "core/schemes/frame/frame_joints.hpp"
#include "core/schemes/frame/substeps.hpp"

#include <string>

namespace kairos {
inline namespace core {
namespace {

/// The earliest contact among the pairs that overlap at the end of a substep.
struct FirstContact {
  bool found = false;
  double time = 0.0;  ///< of the proposal, s
  BodyIndex a = 0;
  BodyIndex b = 0;
};

FirstContact first_contact(FrameWorld& world, double part) {
  FirstContact first;
  for (const auto& [a, b] : world.model().pairs()) {
    if (world.model().is_field(a) || world.model().is_field(b) || !world.overlap_at(a, b, part)) {
      continue;
    }
    const TimeOfImpact toi = world.time_of_impact(a, b, part);
    // A pair that touches only at the end of the substep is handled there.
    const double time = toi.status == ToiStatus::separated ? part : toi.t_lo;
    if (!first.found || time < first.time) {
      first = {true, time, a, b};
    }
  }
  return first;
}

class Bisected final : public Scheme {
 public:
  [[nodiscard]] SchemeInfo info() const override {
    return {"bisected",
            "substeps, and bisection to the first contact in each",
            "Dembovsky1999",
            true,
            false,
            {},
            true};
  }

  [[nodiscard]] std::string refuses(const Model& model, const Method& method,
                                    const SchemeOptions&) const override {
    if (!method.detector->info().locates) {
      return "bisected needs a detector that locates contacts within a substep";
    }
    return why_not_jointed(model);
  }

  RunResult run(const Model& model, const Method& method, const SchemeOptions& options,
                Recorder& recorder) const override {
    FrameWorld world(model, method, options, recorder);
    SubstepPlan plan(model, options);
    while (world.draw()) {
      if (!frame(world, plan, options.max_substeps)) {
        break;
      }
    }
    return std::move(world).result();
  }

 private:
  static bool frame(FrameWorld& world, SubstepPlan& plan, std::int64_t most) {
    const double whole = world.frame_duration();
    plan.begin_frame(whole);
    std::int64_t stuck = 0;
    give_field_forces(world);
    for (double left = whole; left > 0.0;) {
      world.propose(left);
      world.trace(Stage::calculate_positions, 1.0 - left / whole);
      double part = plan.next(world, left);
      if (part <= 0.0) {
        return false;
      }
      world.trace(Stage::detect, 1.0 - (left - part) / whole);
      const FirstContact contact = first_contact(world, part);
      if (contact.found) {
        world.trace(Stage::locate, 1.0 - (left - contact.time) / whole);
        stuck = contact.time > 0.0 ? 0 : stuck + 1;
        if (stuck > most) {
          world.stop("accumulation: contacts follow each other without time passing");
          return false;
        }
        // A pair in contact when the substep began has no moment to go back to. It is handled where
        // it is; every second time the whole substep is taken, as in `substepped`.
        part = contact.time > 0.0 ? contact.time : (stuck % 2 == 0 ? part : 0.0);
      }
      if (part > 0.0) {
        world.accept(part);
        left = part < left ? left - part : 0.0;
        if (left > 0.0) {
          give_field_forces(world);
        }
        world.trace(Stage::advance, 1.0 - left / whole);
      }
      if (contact.found) {
        world.handle(contact.a, contact.b);
        world.trace(Stage::handle, 1.0 - left / whole);
      }
    }
    return true;
  }
};

}  // namespace

std::unique_ptr<Scheme> make_bisected() { return std::make_unique<Bisected>(); }

}  // namespace core
}  // namespace kairos
