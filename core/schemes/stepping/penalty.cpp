#include "core/schemes/stepping/penalty.hpp"

#include "core/exponential.hpp"
#include "core/schemes/stepping/step_world.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

/// Force on b, contact frame, N.
Vector3 contact_force(const StepContact& c, const TimeSteppingOptions& options) {
  const double depth = std::max(-c.gap, 0.0);
  const double rate = -c.before[0];
  const double from_restitution =
      c.fastest_approach > 0.0 ? (1.0 - c.restitution) / c.fastest_approach : 0.0;
  const double alpha = options.dissipation.value_or(from_restitution);
  const double normal =
      options.stiffness * power(depth, options.exponent) * std::max(1.0 + 1.5 * alpha * rate, 0.0);
  Vector3 force(normal, c.before[1], c.before[2]);
  const double slip = force.tail<2>().norm();
  force.tail<2>() *=
      slip > 0.0 ? -c.friction * normal / std::max(slip, options.stiction_velocity) : 0.0;
  return force;
}

class Penalty final : public Scheme {
 public:
  [[nodiscard]] SchemeInfo info() const override {
    return {.name = "penalty",
            .summary = "contacts are springs and dampers, friction is regularised",
            .source = "HuntCrossley1975",
            .friction = true,
            .integrator = "symplectic-euler"};
  }
  [[nodiscard]] std::string refuses(const Model& model, const Method& method,
                                    const SchemeOptions&) const override {
    for (const auto& [a, b] : model.pairs()) {
      if (model.interacts(a, b) && std::isinf(model.friction(a, b))) {
        return "'" + model.body(a).name + "' and '" + model.body(b).name +
               "' are rough (infinite friction), and regularised friction needs a number";
      }
    }
    return stepping_refusal(model, method);
  }
  RunResult run(const Model& model, const Method& method, const SchemeOptions& options,
                Recorder& recorder) const override {
    const TimeSteppingOptions& stepping = options.stepping;
    StepWorld world(model, method, options, recorder,
                    stepping.substeps > 0 ? stepping.substeps : 100, Corrects::no);
    return run_steps(world, [&] {
      world.kick();
      world.find_contacts(world.poses_ahead(0.0));
      for (StepContact& c : world.contacts()) {
        c.impulse = world.h() * contact_force(c, stepping);
      }
      world.count_solves(world.contacts().size());
      world.sum_impulses();
      world.move(1.0);
    });
  }
};

}  // namespace

std::unique_ptr<Scheme> make_penalty() { return std::make_unique<Penalty>(); }

}  // namespace core
}  // namespace kairos
