// How the ledger follows the motions of an event-driven run.

#include "core/joint_system.hpp"
#include "core/schemes/event/event_motions.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

/// A motion is asked for at most so much after its end, as a part of a frame: roundoff.
constexpr double most_late = 1e-9;

}  // namespace

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
    if (!run_.boxes_crossed.empty()) {
      now_[i].pose.position += run_.recorded_offset(i);
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

/// `book` of a body on which nothing but the uniform force of the model acts, exactly; whether it
/// was brought for that.
bool EventMotions::book_plain(BodyIndex i, Instant t) {
  Instant& until = booked_until_[i];
  if (!(t - until > 0.0)) {
    return false;
  }
  bring(i, t);
  if (!run_.model.gravity_force(i).isZero(0.0)) {  // else no energy changed its form
    run_.account.fallen(i, at(i, until), now_[i]);
  }
  until = t;
  return true;
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
  for (const BodyIndex i : flow.island.bodies) {
    book_surface_forces(i, t);
  }
  // The state at the end of a segment is the stepper's; the motion agrees with it up to roundoff
  // only.
  const double left = end_of(first) - t;
  if (left < -most_late * run_.mean_frame) {
    run_.stop(end_of(first), "the motion of '" + run_.model.body(first).name +
                                 "' ends and nothing follows it: an error of the program, worth a "
                                 "report with the scene");
  }
  const bool whole = !(left > 0.0) && !support(first);
  for (std::size_t k = 0; k < flow.states.size(); ++k) {
    const BodyIndex i = flow.island.bodies[k];
    now_[i] = whole ? flow.states[k] : at(i, t);
    mark_brought(i, t);
  }
  // Most islands are one body, and nothing has to be gathered for them.
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
  // The motion of a top is fitted by polynomials: its distance from the closed form is truncation.
  const bool exact =
      !turns && (flow.held || (flow.exact && !run_.model.tumbles(run_.model.island_of(first))));
  Leg leg{flow.island, booked, to, given, exact, roundoff, riding_work(flow, t)};
  double driven = 0.0;
  if (turns) {
    for (const BodyIndex i : flow.island.bodies) {
      const TurnedWork turned = book_turn(i, from, t);
      leg.contact_work += turned.on_body;
      driven += turned.through_joints;
    }
  }
  if (flow.island.forces.empty()) {
    run_.account.leg(leg);
  } else {
    const std::span motions(motions_.data(), flow.states.size());
    for (std::size_t k = 0; k < motions.size(); ++k) {
      motions[k] = of(flow.island.bodies[k]);
    }
    if (flow.island.joints != nullptr) {
      leg.contact_work += whole ? run_.account.projected(flow.projection) : 0.0;
      leg.riding_work = run_.account.joint_work(flow.island, motions, from, duration) +
                        (whole ? flow.projection.driven : 0.0) + driven;
    }
    run_.account.leg(leg, motions, from, duration);
  }
  if (!is_shared(flow)) {
    std::copy(to.begin(), to.end(), flow.booked.begin());
  }
  booked_until(flow) = t;
}

/// What contact forces do to a body that turns in touch; books the part of it that is truncation.
EventMotions::TurnedWork EventMotions::book_turn(BodyIndex i, Instant from, Instant to) {
  const Polynomial<3>& worked = ties(i).worked.front();
  const Instant start = start_of(i);
  const Vector3 done = worked(to - start) - worked(from - start);
  run_.ledger.add(EnergyLine::truncation, done.y());
  return {done.x(), done.z()};
}

/// Books the work of friction, belts and driven surfaces on body i. Forces and angular
/// accelerations are constant.
void EventMotions::book_surface_forces(BodyIndex i, Instant t) {
  if (ties_[i] == nullptr) {
    return;
  }
  for (SurfaceForce& surface : ties_[i]->surface_forces) {
    const double h = t - surface.booked;
    const BodyState to_a = at(surface.a, t);
    const BodyState to_b = at(surface.b, t);
    const auto way = [h](const BodyState& from, const BodyState& to, const Vector3& arm) {
      const Vector3 turned = 0.5 * h * (from.twist.angular + to.twist.angular);
      return Vector3((to.pose.position - from.pose.position) + turned.cross(arm));
    };
    const Vector3 way_a = way(surface.from_a, to_a, surface.arm_a);
    const Vector3 way_b = way(surface.from_b, to_b, surface.arm_b);
    const Vector3 belts = h * (surface.belt_b - surface.belt_a);
    if (surface.curved) {
      const Vector3 done =
          surface.spent(t - surface.begun) - surface.spent(surface.booked - surface.begun);
      run_.ledger.add(EnergyLine::friction, done.x());
      if (done.y() != 0.0) {
        run_.ledger.add(EnergyLine::conveyor_and_hand, done.y());
      }
      if (done.z() != 0.0) {
        run_.ledger.add(EnergyLine::driven_work, done.z());
      }
    } else if (surface.slides) {
      run_.ledger.add(EnergyLine::friction, surface.along.dot((way_b - way_a) + belts));
    }
    if (!belts.isZero(0.0) && !surface.curved) {
      run_.ledger.add(EnergyLine::conveyor_and_hand, -surface.along.dot(belts));
    }
    if (surface.curved) {
      // told with what is spent
    } else if (surface.rides) {
      // m (v1^2 - v0^2) / 2 - F.x, where F is every force but the contact's.
      const BodyState& from = run_.model.is_free(surface.b) ? surface.from_b : surface.from_a;
      const BodyState& to = run_.model.is_free(surface.b) ? to_b : to_a;
      run_.ledger.add(
          EnergyLine::driven_work,
          run_.account.gained(i, from, to) - (run_.model.gravity_force(i) + ties(i).field_force)
                                                 .dot(to.pose.position - from.pose.position));
    } else if (run_.model.mobility(surface.a) == Mobility::driven) {
      run_.ledger.add(EnergyLine::driven_work, surface.force.dot(way_a));
    }
    if (!surface.rides && !surface.curved && run_.model.mobility(surface.b) == Mobility::driven) {
      run_.ledger.add(EnergyLine::driven_work, -surface.force.dot(way_b));
    }
    surface.from_a = to_a;
    surface.from_b = to_b;
    surface.booked = t;
  }
}

/// Work of a driven surface since the island was last booked, J: the normal force m a_s.n - F.n,
/// integrated over the surface's displacement along n. F is every other force, constant or not.
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

/// Roundoff of the current segment since the island was last booked, J.
double EventMotions::new_roundoff(Flow& flow, Instant t) {
  const auto lost =
      flow.roundoff(t - start_of(flow.island.bodies.front()), flow.launched,
                    [&](std::size_t k) -> const BodyState& { return now_[flow.island.bodies[k]]; });
  return lost ? *lost - std::exchange(flow.lost, *lost) : 0.0;
}

}  // namespace core
}  // namespace kairos
