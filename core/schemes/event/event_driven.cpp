#include "core/schemes/event/event_driven.hpp"

#include "core/schemes/event/event_world.hpp"

namespace kairos {
inline namespace core {
namespace {

class EventDriven final : public Scheme {
 public:
  [[nodiscard]] SchemeInfo info() const override {
    return {"event-driven", "from impact to impact, whatever the frames", "Lubachevsky1991", true};
  }

  [[nodiscard]] std::string refuses(const Model& model, const Method& method,
                                    const SchemeOptions&) const override {
    if (!method.detector->info().locates) {
      return "event-driven needs a detector that locates contacts in time";
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
