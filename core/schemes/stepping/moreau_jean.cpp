#include "core/schemes/stepping/moreau_jean.hpp"

#include "core/contacts/coulomb_cone.hpp"
#include "core/schemes/stepping/step_world.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

/// One sweep over all contacts; the largest change of a velocity relative to the largest velocity.
double sweep(StepWorld& world) {
  double change = 0.0;
  double scale = 0.0;
  for (StepContact& c : world.contacts()) {
    const Vector3 u = world.velocity(c);
    Vector3 q = u - c.compliance * c.impulse;
    q[0] += c.restitution * c.before[0];
    const Vector3 impulse = coulomb_impulse(c.compliance, q, c.friction);
    const Vector3 difference = impulse - c.impulse;
    world.push(c, difference);
    c.impulse = impulse;
    change = std::max(change, (c.compliance * difference).lpNorm<Eigen::Infinity>());
    scale = std::max({scale, q.lpNorm<Eigen::Infinity>(), u.lpNorm<Eigen::Infinity>()});
  }
  world.count_solves(world.contacts().size());
  return scale > 0.0 ? change / scale : 0.0;
}

void solve(StepWorld& world, const TimeSteppingOptions& options) {
  const std::int64_t most = options.iterations > 0 ? options.iterations : 1000;
  world.sum_impulses();
  for (std::int64_t k = 0; k < most && !world.contacts().empty(); ++k) {
    if (sweep(world) <= options.solver_tolerance) {
      break;
    }
  }
  world.sum_impulses();
}

class MoreauJean final : public Scheme {
 public:
  [[nodiscard]] SchemeInfo info() const override {
    return {.name = "moreau-jean",
            .summary = "steps over contacts: impulses on the exact friction cone, no drift undone",
            .source = "Jean1999",
            .friction = true,
            .integrator = "theta-method"};
  }
  [[nodiscard]] std::string refuses(const Model& model, const Method& method,
                                    const SchemeOptions&) const override {
    return stepping_refusal(model, method);
  }
  RunResult run(const Model& model, const Method& method, const SchemeOptions& options,
                Recorder& recorder) const override {
    const TimeSteppingOptions& stepping = options.stepping;
    StepWorld world(model, method, options, recorder, std::max<std::int64_t>(stepping.substeps, 1),
                    Corrects::no);
    return run_steps(world, [&] {
      world.kick(stepping.theta);
      world.find_contacts(world.poses_ahead((1.0 - stepping.theta) * world.h()));
      solve(world, stepping);
      world.move(stepping.theta);
    });
  }
};

}  // namespace

std::unique_ptr<Scheme> make_moreau_jean() { return std::make_unique<MoreauJean>(); }

}  // namespace core
}  // namespace kairos
