#include "simulation/run_guard.hpp"

#include "core/archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

namespace kairos {
inline namespace simulation {
namespace {

constexpr double unknown = std::numeric_limits<double>::infinity();

/// Angular velocity along the principal axes, rad/s.
Vector3 principal_rates(const BodyInertia& inertia, const BodyState& body) {
  return inertia.principal_axes(body.pose.orientation).conjugate() * body.twist.angular;
}

double spin_energy(const BodyInertia& inertia, const BodyState& body) {
  const Vector3 w = principal_rates(inertia, body);
  return 0.5 * w.dot(inertia.principal.cwiseProduct(w));
}

}  // namespace

void RunGuard::begin(const Model& model) {
  model_ = &model;
  free_top_.assign(model.size(), 0);
  most_energy_.assign(model.size(), unknown);
  for (BodyIndex i = 0; i < model.size(); ++i) {
    free_top_[i] = watch_spin_ && model.is_free(i) && model.rotates(i) && !model.jointed(i) ? 1 : 0;
  }
  if (model.has_friction()) {
    free_top_.assign(model.size(), 0);  // what rolls takes spin from its way
  }
  for (const SceneForce& force : model.scene().forces) {
    for (const BodyIndex i : force.bodies) {
      free_top_[i] = force.force->involves_rotation() ? 0 : free_top_[i];
    }
  }
  has_free_tops_ = std::find(free_top_.begin(), free_top_.end(), 1) != free_top_.end();
  inner_.begin(model);
}

void RunGuard::frame(const Frame& frame) {
  for (std::size_t i = 0; i < frame.bodies.size(); ++i) {
    check_finite(frame.bodies[i], i, frame.time);
    check_spin(frame.bodies[i], i, frame.time);
  }
  check_energy(frame);
  last_.end = frame.time;
  last_.state.assign(frame.bodies.begin(), frame.bodies.end());
  last_.ledger = frame.ledger;
  ++last_.cost.frames;
  inner_.frame(frame);
}

void RunGuard::event(const Event& event) {
  if (event.kind == EventKind::contact_begins) {  // contact may turn them from this instant on
    free_top_[event.a] = free_top_[event.b] = 0;
    most_energy_[event.a] = most_energy_[event.b] = unknown;
  }
  if (has_free_tops_) {
    check_spin(event.before_a, event.a, event.time);
    check_spin(event.before_b, event.b, event.time);
  }
  check_finite(event.after_a, event.a, event.time);
  check_finite(event.after_b, event.b, event.time);
  if (has_free_tops_) {
    most_energy_[event.a] = most_spin_energy(event.after_a, event.a);
    most_energy_[event.b] = most_spin_energy(event.after_b, event.b);
  }
  ++last_.cost.events;
  inner_.event(event);
}

bool RunGuard::persist(Archive& archive) {
  archive(last_.end, last_.state, last_.ledger, last_.cost, most_energy_, free_top_);
  archive.require(last_.state.size() == model_->size());
  return inner_.persist(archive);
}

RunResult RunGuard::stopped(std::string reason) && {
  last_.status = RunStatus::stopped;
  last_.reason = std::move(reason);
  return std::move(last_);
}

void RunGuard::check_finite(const BodyState& body, BodyIndex i, Instant t) const {
  // x - x is 0 for finite x alone; sums keep what is not.
  const double sum = body.pose.position.sum() + body.pose.orientation.coeffs().sum() +
                     body.twist.linear.sum() + body.twist.angular.sum();
  if (!(sum - sum == 0.0)) {
    throw Broken{
        fmt::format("not finite: the state of '{}' at t = {} s", model_->body(i).name, t.seconds)};
  }
}

void RunGuard::check_energy(const Frame& frame) const {
  const EnergyLedger& ledger = frame.ledger;
  if (std::isfinite(ledger.unexplained()) && std::isfinite(ledger.flow())) {
    return;  // the first is a sum of all but the second
  }
  const auto need = [&](double joules, const auto& name) {
    if (!std::isfinite(joules)) {
      refuse_energy(frame, joules, name());
    }
  };
  need(ledger.kinetic(), [] { return "kinetic"; });
  need(ledger.potential(), [] { return "potential"; });
  for (std::size_t i = 0; i < energy_line_count; ++i) {
    const auto line = static_cast<EnergyLine>(i);
    need(ledger.line(line), [line] { return to_string(line); });
  }
  need(ledger.unexplained(), [] { return "unexplained"; });
  need(ledger.flow(), [] { return "flow"; });
}

void RunGuard::refuse_energy(const Frame& frame, double joules, std::string_view name) const {
  std::size_t fastest = 0;
  for (std::size_t i = 0; i < frame.bodies.size(); ++i) {
    if (frame.bodies[i].twist.linear.norm() > frame.bodies[fastest].twist.linear.norm()) {
      fastest = i;
    }
  }
  throw Broken{fmt::format(
      "not finite: {} in the energy ledger at t = {} s is {} J; the fastest body is '{}', at "
      "{:.3g} m/s",
      name, frame.time.seconds, joules, model_->body(fastest).name,
      frame.bodies[fastest].twist.linear.norm())};
}

/// Infinite for bodies that are not watched.
double RunGuard::most_spin_energy(const BodyState& body, BodyIndex i) const {
  if (free_top_[i] == 0) {
    return unknown;
  }
  const BodyInertia& inertia = model_->inertia(i);
  return inertia.principal.cwiseProduct(principal_rates(inertia, body)).squaredNorm() /
         (2.0 * inertia.principal.minCoeff());
}

void RunGuard::check_spin(const BodyState& body, BodyIndex i, Instant t) {
  if (free_top_[i] == 0) {
    return;
  }
  if (most_energy_[i] == unknown) {
    most_energy_[i] = most_spin_energy(body, i);
  }
  const double energy = spin_energy(model_->inertia(i), body);
  if (!(energy <= 2.0 * most_energy_[i])) {
    throw Broken{fmt::format(
        "unstable: at t = {} s '{}' turns with {:.3g} J, and its angular momentum allows {:.3g} J: "
        "the integrator cannot follow its rotation in steps this long; allowed: shorter steps "
        "(--frame, --step), or an integrator that controls its error",
        t.seconds, model_->body(i).name, energy, most_energy_[i])};
  }
}

}  // namespace simulation
}  // namespace kairos
