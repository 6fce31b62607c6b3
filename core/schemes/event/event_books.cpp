// What the motions of event-driven did, told to the ledger.

#include "core/joint_system.hpp"
#include "core/schemes/event/event_motions.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace kairos {
inline namespace core {

void EventMotions::book_all(Instant t) {
  for (const Island& island : run_.model.islands()) {
    book(island.bodies.front(), t);
  }
}

/// Into `now`, of which nobody needs anything between events but where fixed and driven bodies are:
/// that is put aside until all has been told.
const State& EventMotions::draw(Instant t) {
  for (std::size_t k = 0; k < led_.size(); ++k) {
    aside_[k] = now_[led_[k]];
  }
  for (BodyIndex i = 0; i < now_.size(); ++i) {
    now_[i] = at(i, t);
    if (!run_.boxes_on.empty()) {
      now_[i].pose.position += run_.way_told(i);
    }
    mark_brought(i, Instant::never());
  }
  return now_;
}

void EventMotions::swap_aside() {
  for (std::size_t k = 0; k < led_.size(); ++k) {
    std::swap(now_[led_[k]], aside_[k]);
  }
}

State EventMotions::last_drawn() && {
  swap_aside();
  return std::move(now_);
}

void EventMotions::book(Flow& flow, Instant t) {
  const Instant from = booked_until(flow);
  const double duration = t - from;
  if (!(duration > 0.0)) {
    return;
  }
  const BodyIndex first = flow.island.bodies.front();
  if (flow.carried) {
    bring(first, t);
    run_.account.carried(flow.island, t, flow.booked, {&now_[first], 1});
    flow.booked[0] = now_[first];
    booked_until(flow) = t;
    return;
  }
  book_rubs(first, t);
  // At its end a segment is where the stepper left it, which its motion tells up to roundoff.
  const bool whole = !(end_of(first) - t > 0.0) && !support(first);
  for (std::size_t k = 0; k < flow.states.size(); ++k) {
    const BodyIndex i = flow.island.bodies[k];
    now_[i] = whole ? flow.states[k] : at(i, t);
    mark_brought(i, t);
  }
  // Most islands are one body, of which nothing has to be gathered.
  std::span<const BodyState> to(&now_[first], 1);
  std::span<const Vector3> given(&ties(first).field_force, 1);
  if (flow.states.size() > 1) {
    gather<BodyState>(flow.island, now_, to_);
    given_.clear();
    for (const BodyIndex i : flow.island.bodies) {
      given_.push_back(ties(i).field_force);
    }
    to = to_;
    given = given_;
  }
  BodyState of_shared;
  std::span<const BodyState> booked(flow.booked);
  if (is_shared(flow)) {
    of_shared = at(first, from);
    booked = {&of_shared, 1};
  }
  const bool turns = ties(first).turns;
  const double roundoff = run_.options.roundoff && !turns ? new_roundoff(flow, t) : 0.0;
  // What the motion of a top is off its closed form is truncation: polynomials are fitted to it.
  const bool exact =
      !turns && (flow.held || (flow.exact && !run_.model.tumbles(run_.model.island_of(first))));
  Leg leg{flow.island, booked, to, given, exact, roundoff, riding_work(flow, t)};
  if (turns) {
    leg.contact_work = book_turn(first, from, t);
  }
  if (flow.island.forces.empty()) {
    run_.account.leg(leg);
  } else {
    const std::span motions(motions_.data(), flow.states.size());
    for (std::size_t k = 0; k < motions.size(); ++k) {
      motions[k] = of(flow.island.bodies[k]);
    }
    if (flow.island.joints != nullptr) {
      leg.contact_work = whole ? run_.account.projected(flow.projection) : 0.0;
      leg.riding_work = run_.account.joint_work(flow.island, motions, from, duration) +
                        (whole ? flow.projection.driven : 0.0);
    }
    run_.account.leg(leg, motions, from, duration);
  }
  if (!is_shared(flow)) {
    std::copy(to.begin(), to.end(), flow.booked.begin());
  }
  booked_until(flow) = t;
}

/// What contact forces did to a body that turns, J; books what of their work is truncation.
double EventMotions::book_turn(BodyIndex i, Instant from, Instant to) {
  const Polynomial<3>& worked = ties(i).worked.front();
  const Instant start = start_of(i);
  const Vector3 done = worked(to - start) - worked(from - start);
  run_.ledger.add(EnergyLine::truncation, done.y());
  return done.x();
}

/// Friction takes what slides, belts and driven surfaces give what they carry. Forces are constant,
/// and so are angular accelerations.
void EventMotions::book_rubs(BodyIndex i, Instant t) {
  if (ties_[i] == nullptr) {
    return;
  }
  for (Rub& rub : ties_[i]->rubs) {
    const double h = t - rub.booked;
    const BodyState to_a = at(rub.a, t);
    const BodyState to_b = at(rub.b, t);
    const auto way = [h](const BodyState& from, const BodyState& to, const Vector3& arm) {
      const Vector3 turned = 0.5 * h * (from.twist.angular + to.twist.angular);
      return Vector3((to.pose.position - from.pose.position) + turned.cross(arm));
    };
    const Vector3 way_a = way(rub.from_a, to_a, rub.arm_a);
    const Vector3 way_b = way(rub.from_b, to_b, rub.arm_b);
    const Vector3 belts = h * (rub.belt_b - rub.belt_a);
    if (rub.curved) {
      run_.ledger.add(EnergyLine::friction,
                      rub.spent(t - rub.begun).x() - rub.spent(rub.booked - rub.begun).x());
    } else if (rub.slides) {
      run_.ledger.add(EnergyLine::friction, rub.along.dot((way_b - way_a) + belts));
    }
    if (!belts.isZero(0.0)) {
      run_.ledger.add(EnergyLine::conveyor_and_hand, -rub.along.dot(belts));
    }
    if (rub.rides) {
      // m (v1^2 - v0^2) / 2 - F.x, F what acts beside the plane.
      const BodyState& from = run_.model.is_free(rub.b) ? rub.from_b : rub.from_a;
      const BodyState& to = run_.model.is_free(rub.b) ? to_b : to_a;
      run_.ledger.add(
          EnergyLine::driven_work,
          run_.account.gained(i, from, to) - (run_.model.gravity_force(i) + ties(i).field_force)
                                                 .dot(to.pose.position - from.pose.position));
    } else if (run_.model.mobility(rub.a) == Mobility::driven) {
      run_.ledger.add(EnergyLine::driven_work, rub.force.dot(way_a));
    }
    if (!rub.rides && run_.model.mobility(rub.b) == Mobility::driven) {
      run_.ledger.add(EnergyLine::driven_work, -rub.force.dot(way_b));
    }
    rub.from_a = to_a;
    rub.from_b = to_b;
    rub.booked = t;
  }
}

/// Of a driven surface since the ledger last looked, J: the normal force m a_s.n - F.n, integrated
/// over the surface's displacement along n; F what is constant and what depends on the state.
double EventMotions::riding_work(const Flow& flow, Instant t) {
  const BodyIndex i = flow.island.bodies.front();
  const std::optional<Support>& support = ties(i).support;
  if (!support || run_.model.mobility(support->surface) != Mobility::driven) {
    return 0.0;
  }
  const Vector3& n = support->normal;
  const double v0 = n.dot(flow.booked[0].twist.linear);
  const double v1 = n.dot(now_[i].twist.linear);
  const double rise = n.dot(now_[i].pose.position - flow.booked[0].pose.position);
  return 0.5 * flow.island.inertia[0].mass * (v1 - v0) * (v1 + v0) - n.dot(net_force(i)) * rise +
         run_.account.bearing_work(run_.model.islands()[run_.model.island_of(i)].forces, of(i), n,
                                   booked_until(flow), t - booked_until(flow));
}

/// Roundoff of the current segment since the ledger last looked, J.
double EventMotions::new_roundoff(Flow& flow, Instant t) {
  const auto lost =
      flow.roundoff(t - start_of(flow.island.bodies.front()), flow.launched,
                    [&](std::size_t k) -> const BodyState& { return now_[flow.island.bodies[k]]; });
  return lost ? *lost - std::exchange(flow.lost, *lost) : 0.0;
}

}  // namespace core
}  // namespace kairos
