#include "core/schemes/event/event_driven.hpp"

#include "core/schemes/event/event_world.hpp"

#include <fmt/format.h>

namespace kairos {
inline namespace core {
namespace {

/// Why this scheme cannot run a scene with such joints; empty if it can.
std::string refuses_joints(const Method& method) {
  if (!method.law->info().passed_on_by_joints) {
    return fmt::format(
        "the impact law '{}' knows nothing of the joints of the scene; allowed: "
        "newton, routh, moreau, reflections",
        method.law->info().name);
  }
  if (method.detector->info().at_step_ends) {
    return fmt::format(
        "the detector '{}' finds contacts within steps of the integrator, which "
        "joints put back onto their constraints; allowed: another detector",
        method.detector->info().name);
  }
  return {};
}

class EventDriven final : public Scheme {
 public:
  [[nodiscard]] SchemeInfo info() const override {
    SchemeInfo info{"event-driven", "from impact to impact, whatever the frames", "Lubachevsky1991",
                    true};
    info.friction = true;
    info.joints = true;
    info.periodic = true;
    return info;
  }

  [[nodiscard]] std::string refuses(const Model& model, const Method& method,
                                    const SchemeOptions&) const override {
    if (!method.detector->info().locates) {
      return "event-driven needs a detector that locates contacts in time";
    }
    if (!model.scene().joints.empty()) {
      if (std::string reason = refuses_joints(method); !reason.empty()) {
        return reason;
      }
    }
    for (BodyIndex i = 0; i < model.size(); ++i) {
      if (!model.entity(i).nudge().none()) {
        return "the nudge of '" + model.body(i).name +
               "' moves bodies in space; event-driven moves them in time only";
      }
    }
    return {};
  }

  RunResult run(const Model& model, const Method& method, const SchemeOptions& options,
                Recorder& recorder) const override {
    EventWorld world(model, method, options, recorder);
    for (bool more = world.begin(); more; more = world.draw()) {
      while (world.due() && !world.stopped()) {
        world.take();
      }
    }
    return std::move(world).result();
  }
};

}  // namespace

std::unique_ptr<Scheme> make_event_driven() { return std::make_unique<EventDriven>(); }

}  // namespace core
}  // namespace kairos
