#include "core/schemes/event/event_contacts.hpp"

#include "core/archive.hpp"
#include "core/contacts/group_law.hpp"
#include "core/impact_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// Looks that go on by less than this part of the motions get nowhere.
constexpr double least_progress = 1e-12;
/// An impact among bodies in touch is handed on so often at most, for each of them.
constexpr std::size_t most_rounds = 1000;
/// `contact_begins` of a contact that has been told.
constexpr Instant told{-1.0, 0.0};

}  // namespace

EventContacts::EventContacts(EventRun& run, EventMotions& motions, EventPredictor& predictor,
                             ContactGraph& graph)
    : run_(run),
      motions_(motions),
      predictor_(predictor),
      accumulation_(run, motions),
      modes_(run, motions, predictor, accumulation_, graph),
      bodies_(run.model.size()) {}

// --- Impacts -----------------------------------------------------------------------------------

void EventContacts::impact(BodyIndex a, BodyIndex b, Instant t, double patience, bool decided) {
  for (const BodyIndex i : {a, b}) {
    if (run_.model.is_free(i)) {
      motions_.book(i, t);
    }
    if (run_.model.mobility(i) != Mobility::fixed) {
      motions_.bring(i, t);
    }
  }
  Event event{.time = t, .kind = EventKind::impact, .a = a, .b = b};
  event.contact = contact_at(a, b, t, patience);
  const double approach = normal_velocity(event.contact, motions_.now(a), motions_.now(b));
  const std::array<BodyIndex, 2> pair{a, b};
  if (!decided && approach >= 0.0 && patience > 0.0) {
    if (!could_be_supported(a, b, t) && settle(pair, t, {.pressed = BodyPair{a, b}})) {
      return;
    }
    return look_again(a, b, t, patience);
  }
  if (approach >= 0.0 && run_.law.info().needs_contact) {
    return touch(a, b, event.contact, t);
  }
  if (run_.detector.info().proves && event.contact.gap > predictor_.touching_gap(a, b)) {
    return run_.stop(t,
                     fmt::format("undecided: the detector '{}' tells {} to touch, which are {} "
                                 "m apart; allowed: a larger --tolerance, or another detector",
                                 run_.detector.info().name, run_.names(a, b), event.contact.gap));
  }
  if (strike_group({a, b}, std::max(-approach, 0.0), t)) {
    return;
  }
  std::vector<BodyIndex> group;
  if (modes_.holds(a) || modes_.holds(b)) {
    group = modes_.group(pair);
    modes_.bring_group(group, t);
  }
  strike(event);
  if (still_approaching(event, approach, t)) {
    return;
  }
  if (!group.empty()) {
    return hand_on(event, std::max(-approach, 0.0), std::move(group), t);
  }
  if (lands(a, b, event.contact, t)) {
    return;
  }
  using Kind = EventAccumulation::Finding::Kind;
  const auto finding = accumulation_.after_impact(a, b, std::max(-approach, 0.0), t);
  if (finding.kind == Kind::none) {
    return relaunch(a, b, t);
  }
  if (finding.kind != Kind::squeezed) {
    const bool unite = finding.kind != Kind::rests;
    if (settle(pair, t,
               {.unloaded = unite,
                .unite = unite,
                .remaining = finding.remaining,
                .pairs = finding.pairs})) {
      return;
    }
    if (finding.kind == Kind::collapse) {
      return relaunch(a, b, t);  // not over yet
    }
  }
  depart(a, b, t);  // what the last frame shows, and the ledger has booked
  run_.stop(t, finding.kind == Kind::squeezed ? finding.reason
                                              : fmt::format("{}; {}", finding.reason, unkept()));
}

/// The impact law acts, and the ledger knows.
void EventContacts::strike(Event& event) {
  Vector3 unused_a = Vector3::Zero();  // solids that push (none does) would need fields
  Vector3 unused_b = Vector3::Zero();
  const ImpactEnergy energy =
      run_.exchange(event, motions_.now(event.a), motions_.now(event.b), unused_a, unused_b);
  assert(!run_.law.info().needs_contact ||
         broken_restitution(event, event.contact.restitution).empty());
  run_.ledger.add(EnergyLine::restitution_loss, energy.restitution_loss);
  run_.ledger.add(EnergyLine::driven_work, energy.driven_work);
  run_.ledger.add(EnergyLine::conveyor_and_hand, energy.conveyor_and_hand);
}

/// After a law that does not part them nothing can go on.
bool EventContacts::still_approaching(const Event& event, double approach, Instant t) {
  const auto [a, b] = std::pair{event.a, event.b};
  const double rebound = normal_velocity(event.contact, event.after_a, event.after_b);
  const double scale =
      std::abs(approach) + event.after_a.twist.linear.norm() + event.after_b.twist.linear.norm();
  if (!(rebound < -16.0 * epsilon * scale)) {  // roundoff of a product and a few sums
    return false;
  }
  depart(a, b, t);
  run_.stop(t, fmt::format("still approaching: the impact law '{}' leaves {} approaching each "
                           "other at {} m/s",
                           run_.law.info().name, run_.names(a, b), -rebound));
  return true;
}

/// What moves by less than roundoff of the fastest does not move.
void EventContacts::leave_at_rest(const EventModes::GroupImpact& impact,
                                  std::vector<Twist>& v) const {
  double fastest = 0.0;
  for (const Twist& before : impact.velocities) {
    fastest = std::max(fastest, before.linear.norm());
  }
  const double least = 64.0 * epsilon * fastest;
  for (std::size_t k = 0; k < v.size(); ++k) {
    if (!run_.model.is_free(impact.bodies[k])) {
      continue;
    }
    const double radius = bounding_radius(run_.model.shape(impact.bodies[k]));
    for (int axis = 0; axis < 3; ++axis) {
      double& linear = v[k].linear[axis];
      double& angular = v[k].angular[axis];
      linear = std::abs(linear) <= least ? 0.0 : linear;
      angular = std::abs(angular) * radius <= least ? 0.0 : angular;
    }
  }
}

/// A law that knows groups strikes all of them at once; false where there is no group, or the law
/// knows none.
bool EventContacts::strike_group(const BodyPair& pair, double approach, Instant t) {
  const auto* law = dynamic_cast<const GroupLaw*>(&run_.law);
  const bool held = modes_.holds(pair.first) || modes_.holds(pair.second);
  if (law == nullptr || !(held || law->takes_what_touches())) {
    return false;
  }
  EventModes::GroupImpact impact = modes_.impact_group(pair, t, law->takes_what_touches());
  if (!impact.refusal.empty() || impact.pairs.size() < (held ? 1U : 2U)) {
    return false;
  }
  std::vector<Twist> velocities = impact.velocities;
  const Eigen::VectorXd impulses = law->strike(impact.system, impact.restitution, velocities);
  if (impulses.size() == 0) {
    return false;
  }
  leave_at_rest(impact, velocities);
  std::vector<BodyState> before;
  std::vector<BodyIndex> bodies;
  for (std::size_t k = 0; k < impact.bodies.size(); ++k) {
    const BodyIndex i = impact.bodies[k];
    if (run_.model.is_free(i)) {
      motions_.book(i, t);
      motions_.bring(i, t);
      bodies.push_back(i);
    } else if (run_.model.mobility(i) == Mobility::driven) {
      motions_.bring(i, t);
    }
    before.push_back(motions_.now(i));
    if (run_.model.is_free(i)) {
      motions_.now(i).twist = velocities[k];
      run_.account.struck(i, before.back(), motions_.now(i));
    }
  }
  // p (u- + u+) / 2 of each row is what it did to the energy, but for the work of what is driven.
  for (std::size_t r = 0; r < impact.system.rows.size(); ++r) {
    const ContactRow& row = impact.system.rows[r];
    const double p = impulses[static_cast<Eigen::Index>(r)];
    if (p == 0.0) {
      continue;
    }
    const double u = impact.system.rate(row, impact.velocities);
    run_.ledger.add(EnergyLine::restitution_loss,
                    0.5 * p * (u + impact.system.rate(row, velocities)));
    for (const std::size_t k : {row.a, row.b}) {
      if (run_.model.mobility(impact.bodies[k]) == Mobility::driven) {
        const Twist& v = impact.velocities[k];
        const Vector3& arm = k == row.a ? row.arm_a : row.arm_b;
        run_.ledger.add(EnergyLine::driven_work,
                        (k == row.a ? p : -p) * row.direction.dot(v.linear + v.angular.cross(arm)));
      }
    }
  }
  tell_group(impact, impulses, before, pair, t);
  go_on_from(bodies, pair, approach, t);
  return true;
}

/// An impact of each pair that took an impulse, that which began it first; its contact is where
/// their impulses act together.
void EventContacts::tell_group(const EventModes::GroupImpact& impact,
                               const Eigen::VectorXd& impulses, std::span<const BodyState> before,
                               const BodyPair& first, Instant t) {
  const auto state = [&](BodyIndex i) -> const BodyState& {
    const auto place = std::find(impact.bodies.begin(), impact.bodies.end(), i);
    return before[static_cast<std::size_t>(place - impact.bodies.begin())];
  };
  const auto is_first = [&](const BodyPair& p) {
    return p == first || p == BodyPair{first.second, first.first};
  };
  double fastest = 0.0;
  for (const BodyState& s : before) {
    fastest = std::max(fastest, s.twist.linear.norm());
  }
  const double resolved = 64.0 * epsilon * fastest;
  const auto tell = [&](std::size_t p) {
    const auto [a, b] = impact.pairs[p];
    Event event{.time = t, .kind = EventKind::impact, .a = a, .b = b};
    double total = 0.0;
    Vector3 point = Vector3::Zero();
    for (std::size_t r = 0; r < impact.pair_of_row.size(); ++r) {
      const double share = impulses[static_cast<Eigen::Index>(r)];
      if (impact.pair_of_row[r] == p && share > 0.0) {
        const ContactRow& row = impact.system.rows[r];
        total += share;
        point += share * (impact.system.bodies[row.a].position + row.arm_a);
        event.contact.normal = row.direction;
        event.contact.gap = impact.gaps[r];
      }
    }
    if (total == 0.0) {
      return;
    }
    const bool only_handed_on =
        (state(a).twist.linear - motions_.now(a).twist.linear).norm() <= resolved &&
        (state(b).twist.linear - motions_.now(b).twist.linear).norm() <= resolved;
    if (only_handed_on && !is_first(impact.pairs[p])) {
      return;
    }
    event.contact.point = point / total;
    event.contact.restitution = run_.model.restitution(a, b);
    event.contact.friction = run_.model.friction(a, b);
    event.before_a = state(a);
    event.before_b = state(b);
    event.after_a = motions_.now(a);
    event.after_b = motions_.now(b);
    ++run_.cost.impacts;
    run_.note(event);
  };
  for (const bool turn : {true, false}) {
    for (std::size_t p = 0; p < impact.pairs.size(); ++p) {
      if (is_first(impact.pairs[p]) == turn) {
        tell(p);
      }
    }
  }
}

/// An impact on bodies that are held together goes on through their patches, pair by pair, always
/// where they approach fastest, until none does; then what is left of the group is settled.
void EventContacts::hand_on(const Event& first, double approach, std::vector<BodyIndex> bodies,
                            Instant t) {
  const std::array<BodyPair, 1> struck{BodyPair{first.a, first.b}};
  const std::size_t most = most_rounds * bodies.size();
  for (std::size_t round = 0; run_.law.info().needs_contact; ++round) {
    const auto worst = modes_.worst_approach(bodies, struck);
    if (!worst) {
      break;
    }
    if (round == most) {
      set_free(bodies, t);
      return run_.stop(t, fmt::format("accumulation: an impact of {} is handed on between bodies "
                                      "in touch more than {} times; {}",
                                      run_.names(first.a, first.b), most, part_them));
    }
    Event event{.time = t, .kind = EventKind::impact, .a = worst->a, .b = worst->b};
    event.contact = worst->contact;
    strike(event);
  }
  go_on_from(bodies, {first.a, first.b}, approach, t);
}

/// What an impact has left of a group is settled, or flies apart.
void EventContacts::go_on_from(std::span<const BodyIndex> bodies, const BodyPair& first,
                               double approach, Instant t) {
  using Kind = EventAccumulation::Finding::Kind;
  const auto finding = accumulation_.after_impact(first.first, first.second, approach, t);
  const bool unite = finding.kind == Kind::collapse || finding.kind == Kind::creeps;
  if (settle(bodies, t,
             {.unloaded = unite,
              .unite = unite,
              .remaining = finding.remaining,
              .pairs = finding.pairs})) {
    return;
  }
  set_free(bodies, t);
  if (finding.kind != Kind::none && finding.kind != Kind::collapse) {
    run_.stop(t, finding.kind == Kind::squeezed ? finding.reason
                                                : fmt::format("{}; {}", finding.reason, unkept()));
  }
}

// --- Groups ------------------------------------------------------------------------------------

bool EventContacts::settle(std::span<const BodyIndex> seeds, Instant t,
                           const EventModes::Wish& wish) {
  const auto adopt = [this](BodyIndex ball) {
    return std::exchange(bodies_[ball].contact_begins, Instant::never());
  };
  return modes_.settle(seeds, t, adopt, wish);
}

/// Why what stays in touch is not kept, for a person.
std::string EventContacts::unkept() const {
  return modes_.why_not().empty() ? std::string(part_them)
                                  : fmt::format("{}; {}", modes_.why_not(), part_them);
}

/// Nothing is held any longer: each flies on from `now`.
void EventContacts::set_free(std::span<const BodyIndex> bodies, Instant t) {
  const auto changes = modes_.part(bodies);
  for (const BodyIndex i : bodies) {
    motions_.bring_others(i, t);
    if (motions_.support(i)) {
      resume_support(i, t);
    }
    motions_.launch(i, t);
  }
  modes_.tell(changes, t);
  for (const BodyIndex i : bodies) {
    predictor_.predict(i, t);
  }
}

void EventContacts::settle_anew(BodyIndex i, Instant t) {
  const std::array<BodyIndex, 1> seed{i};
  const std::vector<BodyIndex> bodies = modes_.group(seed);
  modes_.bring_group(bodies, t);
  if (settle(bodies, t)) {
    return;
  }
  const std::string why = unkept();
  set_free(bodies, t);
  run_.stop(t, fmt::format("contact: what '{}' and what it touches do from here on is not kept: {}",
                           run_.model.body(i).name, why));
}

void EventContacts::take_out(BodyIndex i, Instant t) {
  if (!modes_.holds(i)) {
    return;
  }
  const std::array<BodyIndex, 1> taken{i};
  std::vector<BodyIndex> others = modes_.group(taken);
  modes_.bring_group(others, t);
  const auto changes = modes_.part(taken);
  modes_.tell(changes, t);
  std::erase(others, i);
  if (!others.empty() && !settle(others, t)) {
    set_free(others, t);
  }
}

void EventContacts::stay(BodyIndex a, BodyIndex b, Instant t) {
  const std::array<BodyIndex, 2> pair{a, b};
  for (const BodyIndex i : pair) {
    if (run_.model.is_free(i)) {
      motions_.book(i, t);
    }
    if (run_.model.mobility(i) != Mobility::fixed) {
      motions_.bring(i, t);
    }
  }
  const Contact contact = contact_at(a, b, t, 0.0);
  if (lands(a, b, contact, t) || settle(pair, t, {.unloaded = true})) {
    return;
  }
  depart(a, b, t);
  run_.stop(t, fmt::format("accumulation: {} stay in contact; {}", run_.names(a, b), unkept()));
}

/// Whether one of the two is a ball that a face of the other could support.
bool EventContacts::could_be_supported(BodyIndex a, BodyIndex b, Instant t) const {
  for (const auto& [ball, surface] : {std::pair{a, b}, std::pair{b, a}}) {
    if (run_.model.is_free(ball) && !run_.model.is_free(surface) &&
        std::holds_alternative<Sphere>(run_.model.shape(ball)) && motions_.of(surface).start <= t) {
      return true;
    }
  }
  return false;
}

/// In touch without approaching: no impact, and nothing that would be told. The two go on as they
/// do, unless they come to rest.
void EventContacts::touch(BodyIndex a, BodyIndex b, const Contact& contact, Instant t) {
  if (lands(a, b, contact, t)) {
    return;
  }
  const std::array<BodyIndex, 2> pair{a, b};
  if (modes_.holds(a) || modes_.holds(b)) {
    const std::vector<BodyIndex> bodies = modes_.group(pair);
    modes_.bring_group(bodies, t);
    return settle(bodies, t, {.unloaded = true}) ? void() : set_free(bodies, t);
  }
  if (settle(pair, t, {.pressed = BodyPair{a, b}})) {
    return;
  }
  if (accumulation_.stalls(a, b, t, least_progress * run_.epoch)) {
    if (settle(pair, t, {.unloaded = true})) {
      return;
    }
    depart(a, b, t);
    return run_.stop(t,
                     fmt::format("accumulation: {} stay in touch; {}", run_.names(a, b), unkept()));
  }
  relaunch(a, b, t);
}

/// Where the two touch at t: the centroid of the contact patch; where that does not approach, the
/// nearest points (one corner of several that are within tolerance).
Contact EventContacts::contact_at(BodyIndex a, BodyIndex b, Instant t, double patience) const {
  const BodyState& state_a = motions_.now(a);
  const BodyState& state_b = motions_.now(b);
  const Overlap o =
      run_.detector.overlap(run_.model.shape(a), state_a.pose, run_.model.shape(b), state_b.pose);
  const Contact patch{o.point, o.normal, o.gap};
  if (normal_velocity(patch, state_a, state_b) < 0.0 || patience <= 0.0) {
    return patch;
  }
  const TimeOfImpact toi = run_.detector.time_of_impact(motions_.moving(a), motions_.moving(b),
                                                        {t, patience}, run_.options.toi_tolerance);
  const Contact nearest{0.5 * (toi.witness_a + toi.witness_b), toi.normal, toi.gap};
  const bool found = toi.status == ToiStatus::impact || toi.status == ToiStatus::undecided;
  return found && normal_velocity(nearest, state_a, state_b) < 0.0 ? nearest : patch;
}

/// A pair within tolerance that does not approach is asked about again where the answer ends.
/// Answers that hardly get on, one after the other, would be asked for without end.
void EventContacts::look_again(BodyIndex a, BodyIndex b, Instant t, double patience) {
  const double window = std::min({motions_.of(a).duration, motions_.of(b).duration, run_.epoch});
  if (accumulation_.stalls(a, b, t, least_progress * window)) {
    const std::array<BodyIndex, 2> pair{a, b};
    if (settle(pair, t, {.unloaded = true})) {
      return;
    }
    return run_.stop(t, fmt::format("accumulation: whether {} touch is undecided again and again, "
                                    "and time does not go on; {}",
                                    run_.names(a, b), unkept()));
  }
  run_.agenda.push(t + patience, Due::recheck, a, b);
}

/// Whether a ball comes to rest on a face: its hop is too small to tell.
bool EventContacts::lands(BodyIndex a, BodyIndex b, const Contact& contact, Instant t) {
  const double e = run_.model.restitution(a, b);
  const double tolerance = accumulation_.rest_tolerance(a, b, e);
  for (const BodyIndex ball : {a, b}) {
    const BodyIndex surface = ball == a ? b : a;
    if (!run_.model.is_free(ball) || run_.model.is_free(surface)) {
      continue;
    }
    const Motion& under = motions_.of(surface);
    const double s = std::min(t - under.start, under.duration);
    const Vector3 normal = ball == b ? contact.normal : Vector3(-contact.normal);
    const auto support =
        find_support(run_.model, ball, motions_.now(ball).pose.position, surface, under, s, normal);
    if (!support) {
      continue;
    }
    const double rebound = leaving_speed(ball, *support, t);
    const double pressing = motions_.pressing(ball, *support, t);
    const double held = motions_.pressing(ball, *support, t, true);
    const double strongest = std::max(pressing, held);
    if (!(strongest > 0.0 && rebound * rebound <= 2.0 * strongest * tolerance)) {
      continue;
    }
    if (motions_.support(ball) && held > 0.0 && !leaves_for(ball, *support, tolerance, t)) {
      const std::array<BodyIndex, 2> pair{a, b};
      if (settle(pair, t)) {
        return true;
      }
      if (!accumulation_.stalls(a, b, t, least_progress * run_.epoch)) {
        continue;  // one surface after the other slows it down
      }
      const BodyIndex other = motions_.support(ball)->surface;
      depart(a, b, t);
      run_.stop(t, fmt::format("accumulation: '{}' comes to rest between '{}' and '{}'; {}",
                               run_.model.body(ball).name, run_.model.body(other).name,
                               run_.model.body(surface).name, unkept()));
      return true;
    }
    if (pressing > 0.0) {
      settle(ball, *support, pressing, e, t);
      return true;
    }
  }
  return false;
}

/// Whether a ball that comes to rest on another surface leaves the one that it has.
bool EventContacts::leaves_for(BodyIndex ball, const Support& other, double tolerance, Instant t) {
  const Support own = *motions_.support(ball);
  motions_.set_support(ball, other);
  const double pressing = motions_.pressing(ball, own, t, true);
  motions_.set_support(ball, own);
  const double away = leaving_speed(ball, own, t);
  return pressing < 0.0 || (away > 0.0 && away * away > 2.0 * pressing * tolerance);
}

bool EventContacts::in_one_island(BodyIndex a, BodyIndex b) const {
  return run_.model.is_free(a) && run_.model.is_free(b) &&
         run_.model.island_of(a) == run_.model.island_of(b);
}

/// The islands of the two fly on from `now`, where an impact has put them.
void EventContacts::depart(BodyIndex a, BodyIndex b, Instant t) {
  for (const BodyIndex i : {a, b}) {
    if (run_.model.is_free(i)) {
      for (const BodyIndex k : motions_.island(i)) {
        if (k != a && k != b) {
          motions_.bring(k, t);
        }
      }
    }
  }
  for (const BodyIndex i : {a, b}) {
    if (!run_.model.is_free(i) || (i == b && in_one_island(a, b))) {
      continue;
    }
    if (motions_.support(i)) {
      resume_support(i, t);
    }
    motions_.launch(i, t);
  }
}

void EventContacts::relaunch(BodyIndex a, BodyIndex b, Instant t) {
  depart(a, b, t);
  for (const BodyIndex i : {a, b}) {
    if (!run_.model.is_free(i) || (i == b && in_one_island(a, b))) {
      continue;
    }
    for (const BodyIndex k : motions_.island(i)) {
      // The pair itself is predicted once.
      predictor_.predict(k, t, i == b && run_.model.is_free(a) ? a : k);
    }
  }
}

// --- Supports ----------------------------------------------------------------------------------

/// At which the ball leaves the surface, m/s.
double EventContacts::leaving_speed(BodyIndex ball, const Support& support, Instant t) const {
  const Motion& under = motions_.of(support.surface);
  const double s = std::min(t - under.start, under.duration);
  return support.normal.dot(motions_.now(ball).twist.linear - under.twist(s).linear);
}

/// The ball takes the velocity of the surface along its normal.
void EventContacts::follow(BodyIndex ball, const Support& support, Instant t) {
  const double away = leaving_speed(ball, support, t);
  const Motion& under = motions_.of(support.surface);
  const double ground =
      support.normal.dot(under.twist(std::min(t - under.start, under.duration)).linear);
  const double m = run_.model.inertia(ball).mass;
  run_.ledger.add(EnergyLine::restitution_loss, -0.5 * m * away * away);
  run_.ledger.add(EnergyLine::driven_work, -m * away * ground);
  Vector3& v = motions_.now(ball).twist.linear;
  v -= support.normal * (support.normal.dot(v) - ground);
}

/// The ball stays on the surface from now on. The hops it would still make, each e times as long as
/// the one before, add up to 2 u / (a (1 - e)): that is when contact begins.
void EventContacts::settle(BodyIndex ball, const Support& support, double pressing, double e,
                           Instant t) {
  if (motions_.support(ball)) {
    end_contact(ball, t);  // one surface at a time
  }
  const double rebound = std::max(leaving_speed(ball, support, t), 0.0);
  const double still = e < 1.0 ? 2.0 * rebound / (pressing * (1.0 - e)) : 0.0;
  follow(ball, support, t);
  motions_.set_support(ball, support);
  motions_.launch(ball, t);
  auto& [settled, contact_begins] = bodies_[ball];
  if (settled != Instant::never() &&
      accumulation_.stalls(ball, support.surface, t, least_progress * run_.epoch)) {
    return run_.stop(t, fmt::format("accumulation: {} leave and meet each other again and again, "
                                    "and time does not go on; {}",
                                    run_.names(ball, support.surface), part_them));
  }
  settled = t;
  contact_begins = t + still;
  if (contact_begins < Instant::never()) {
    run_.agenda.push(contact_begins, Due::contact_begins, ball, support.surface);
  }
  predictor_.predict(ball, t);
}

/// A supported ball was pushed: it stays if the push is along the surface.
void EventContacts::resume_support(BodyIndex i, Instant t) {
  const Support support = *motions_.support(i);
  const double away = leaving_speed(i, support, t);
  const double pressing = motions_.pressing(i, support, t);
  const double tolerance = accumulation_.rest_tolerance(i, support.surface, 0.0);
  if (pressing > 0.0 && away * away <= 2.0 * pressing * tolerance) {
    return follow(i, support, t);
  }
  end_contact(i, t);
}

void EventContacts::begin_contact(BodyIndex i, BodyIndex j, Instant t) {
  modes_.begin_contact(i, j, t);
  Instant& begins = bodies_[i].contact_begins;
  if (motions_.support(i) && begins == t) {
    run_.time = t;
    begins = told;
    motions_.note(EventKind::contact_begins, i, motions_.support(i)->surface, t);
  }
}

void EventContacts::end_contact(BodyIndex i, Instant t) {
  Instant& began = bodies_[i].contact_begins;
  const BodyIndex surface = motions_.support(i)->surface;
  motions_.set_support(i, std::nullopt);
  if (began < t) {  // otherwise it was still hopping
    motions_.note(EventKind::contact_ends, i, surface, t);
  }
  began = Instant::never();
}

void EventContacts::leave_support(BodyIndex i, Instant t) {
  motions_.book(i, t);
  motions_.bring(i, t);
  end_contact(i, t);
  motions_.launch(i, t);
  predictor_.predict(i, t);
}

void EventContacts::carry_riders(BodyIndex surface, Instant t) {
  for (const BodyIndex i : run_.agenda.by_name()) {
    if (motions_.is_supported_by(i, surface)) {
      motions_.book(i, t);
      motions_.bring(i, t);
      resume_support(i, t);
      motions_.launch(i, t);
      predictor_.predict(i, t);
    }
  }
}

// --- Fields ------------------------------------------------------------------------------------

void EventContacts::cross_field(BodyIndex a, BodyIndex b, Instant t, bool entering) {
  const auto [field, body] = run_.model.is_field(a) ? std::pair{a, b} : std::pair{b, a};
  motions_.book(body, t);
  for (const BodyIndex k : motions_.island(body)) {
    motions_.bring(k, t);
  }
  std::vector<BodyIndex> group;
  if (modes_.holds(body)) {
    const std::array<BodyIndex, 1> seed{body};
    group = modes_.group(seed);
    modes_.bring_group(group, t);
  }
  if (entering) {
    motions_.fields(body).push_back(field);
  } else {
    std::erase(motions_.fields(body), field);
  }
  motions_.note(entering ? EventKind::field_entered : EventKind::field_left, field, body, t);
  if (!group.empty()) {
    return settle(group, t) ? void() : set_free(group, t);
  }
  if (motions_.support(body)) {
    resume_support(body, t);
  }
  motions_.launch(body, t);
  for (const BodyIndex k : motions_.island(body)) {
    predictor_.predict(k, t);
  }
}

void EventContacts::Touching::persist(Archive& archive) { archive(settled, contact_begins); }
void EventContacts::persist(Archive& archive) { archive(accumulation_, bodies_); }

}  // namespace core
}  // namespace kairos
