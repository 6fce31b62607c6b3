#include "core/schemes/stepping/pgs.hpp"

#include "core/schemes/stepping/step_world.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

/// Normal velocity that the contact is to have at least, m/s.
double wanted(const StepContact& c, double h, const TimeSteppingOptions& options) {
  const double approach = -c.before[0];
  const bool rebounds = approach > options.restitution_threshold && approach * h > c.gap;
  const double least =
      c.gap > 0.0 ? -c.gap / h : options.beta / h * std::max(-c.gap - options.slop, 0.0);
  return rebounds ? std::max(least, c.restitution * approach) : least;
}

/// Moves component k of the accumulated impulse to where u_k = target, within [low, high].
void relax(StepWorld& world, StepContact& c, int k, double target, double low, double high) {
  const double u = world.velocity(c)[k];
  const double wish = c.impulse[k] + (target - u) / c.compliance(k, k);
  const double impulse = std::clamp(wish, low, high);
  world.push(c, (impulse - c.impulse[k]) * Vector3::Unit(k));
  c.impulse[k] = impulse;
}

void solve(StepWorld& world, const TimeSteppingOptions& options) {
  const std::int64_t sweeps = options.iterations > 0 ? options.iterations : 10;
  if (!options.warm_starting) {
    for (StepContact& c : world.contacts()) {
      c.impulse.setZero();
    }
  }
  world.sum_impulses();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (std::int64_t sweep = 0; sweep < sweeps; ++sweep) {
    for (StepContact& c : world.contacts()) {
      // An infinite coefficient times 0 is 0 here: a contact that does not press has no friction.
      const double most = c.impulse[0] > 0.0 && c.friction > 0.0 ? c.friction * c.impulse[0] : 0.0;
      relax(world, c, 1, 0.0, -most, most);
      relax(world, c, 2, 0.0, -most, most);
      relax(world, c, 0, wanted(c, world.h(), options), 0.0, infinity);
    }
    world.count_solves(world.contacts().size());
  }
  world.sum_impulses();
}

class Pgs final : public Scheme {
 public:
  [[nodiscard]] SchemeInfo info() const override {
    return {.name = "pgs",
            .summary = "as games do: projected Gauss-Seidel on velocities, Baumgarte stabilisation",
            .source = "Catto2005",
            .friction = true,
            .integrator = "symplectic-euler"};
  }
  [[nodiscard]] std::string refuses(const Model& model, const Method& method,
                                    const SchemeOptions&) const override {
    return stepping_refusal(model, method);
  }
  RunResult run(const Model& model, const Method& method, const SchemeOptions& options,
                Recorder& recorder) const override {
    const TimeSteppingOptions& stepping = options.stepping;
    StepWorld world(model, method, options, recorder, std::max<std::int64_t>(stepping.substeps, 1),
                    Corrects::yes);
    return run_steps(world, [&] {
      world.kick();
      world.find_contacts(world.poses_ahead(0.0), stepping.slop);
      solve(world, stepping);
      world.move(1.0);
    });
  }
};

}  // namespace

std::unique_ptr<Scheme> make_pgs() { return std::make_unique<Pgs>(); }

}  // namespace core
}  // namespace kairos
