// `EventContacts` when bodies strike each other: two of them, or a group in touch.
#include "core/ball_detector.hpp"
#include "core/contacts/group_law.hpp"
#include "core/impact_check.hpp"
#include "core/point_law.hpp"
#include "core/schemes/event/draws_apart.hpp"
#include "core/schemes/event/event_contacts.hpp"
#include "core/schemes/event/slides_past.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// How often an impact among bodies in touch is handed on at most, for each of them.
constexpr std::size_t most_rounds = 1000;
/// After so many rounds for each of them, what is left is looked for at once.
constexpr std::size_t few_rounds = 4;

/// What strikes so often at one instant, and nothing else in between, is held back by what settles
/// what it strikes each time: a heavy ball on a light box on a floor.
constexpr int most_alike = 64;
/// So do many that strike in turns, for each body: elastic rows of n hand on n / 2 for each.
constexpr int most_in_turns = 200;
constexpr int few_in_turns = 2000;

/// What approaches by less than this part of the fastest that struck at the instant is nothing, if
/// both move by less than `still` of it: pairs hand impacts to and fro that no coordinate tells.
constexpr double nothing = 0x1p-120;
constexpr double still = 0x1p-80;

/// Joints leave velocities off their equations by roundoff, on which their impulses do work: at
/// most this part of what an impact exchanges.
constexpr double off_by_joints = 1e-12;

/// The two that began an impact strike where they came together. What is in touch at one point of a
/// corner may part at another, whose normal is not the same.
void strike_where_met(const Event& first, double restitution, EventModes::GroupImpact& impact) {
  const auto place = [&](BodyIndex i) {
    return static_cast<std::size_t>(std::find(impact.bodies.begin(), impact.bodies.end(), i) -
                                    impact.bodies.begin());
  };
  const BodyPair pair{first.a, first.b};
  const auto p = static_cast<std::size_t>(
      std::find(impact.pairs.begin(), impact.pairs.end(), pair) - impact.pairs.begin());
  for (std::size_t r = 0; r < impact.system.rows.size(); ++r) {
    if (impact.pair_of_row[r] == p &&
        impact.system.rate(impact.system.rows[r], impact.velocities) < 0.0) {
      return;
    }
  }
  impact.system.add(place(first.a), place(first.b), first.contact.point, first.contact.normal);
  if (!(impact.system.rate(impact.system.rows.back(), impact.velocities) < 0.0)) {
    impact.system.rows.pop_back();
    return;
  }
  if (p == impact.pairs.size()) {
    impact.pairs.push_back(pair);
  }
  impact.pair_of_row.push_back(p);
  impact.gaps.push_back(first.contact.gap);
  impact.restitution.conservativeResize(impact.restitution.size() + 1);
  impact.restitution[impact.restitution.size() - 1] = restitution;
}

}  // namespace

/// An impact that has yet to be told of. No bracket: a step of bodies that turn ended in it.
Event EventContacts::impact_in(BodyIndex a, BodyIndex b, Instant t, double bracket) {
  Event event{.time = t, .kind = EventKind::impact, .a = a, .b = b};
  if (bracket > 0.0) {
    event.bracket = bracket;
  }
  return event;
}

/// If one body meets a periodic image of the other, the other continues as this image; returns
/// whether it did.
bool EventContacts::meet_in_one_box(BodyIndex a, BodyIndex b, Instant t) {
  const auto& box = run_.model.scene().periodic;
  if (!box || std::holds_alternative<HalfSpace>(run_.model.shape(a)) ||
      std::holds_alternative<HalfSpace>(run_.model.shape(b))) {
    return false;
  }
  const BodyIndex mover = predictor_.mover(a, b);
  const BodyIndex other = mover == a ? b : a;
  const Image n =
      box->nearest(motions_.now(mover).pose.position - motions_.now(other).pose.position);
  if (is_zero(n)) {
    return false;
  }
  if (!predictor_.goes_alone(mover)) {
    run_.stop(t, fmt::format("contact: {} meet across the side of the periodic box, and both are "
                             "held by bodies that they touch, which is not handled; {}",
                             run_.names(a, b), lasting_contact_advice));
    return false;
  }
  motions_.go_on_as(mover, n);
  predictor_.go_on_as(mover, n);
  motions_.bring(mover, t);
  return true;
}

/// How long what slides past a body that never moves is to be left alone, s; 0: it strikes.
double EventContacts::passes_by(BodyIndex a, BodyIndex b, Instant t) const {
  if (run_.model.mobility(a) != Mobility::fixed && run_.model.mobility(b) != Mobility::fixed) {
    return 0.0;  // both may be moved in the meantime
  }
  const BodyIndex mover = run_.model.mobility(a) == Mobility::fixed ? b : a;
  if (!modes_.holds(mover) && !motions_.support(mover)) {
    return 0.0;  // it comes along nothing that would hold it at one level
  }
  const auto of_a = motions_.moving(a);
  const auto of_b = motions_.moving(b);
  return slides_past({run_.model.shape(a), of_a.motion()}, motions_.now(a),
                     {run_.model.shape(b), of_b.motion()}, motions_.now(b), t);
}

/// Whether two that touch, and would meet at this instant for ever, draw apart where their patch
/// is: they are asked about again later. What goes on as an image is launched anew instead.
bool EventContacts::leave_alone(BodyIndex a, BodyIndex b, Instant t) {
  if (run_.model.scene().periodic) {
    return false;
  }
  const auto moving_a = motions_.moving(a);
  const auto moving_b = motions_.moving(b);
  const MovingShape of_a{run_.model.shape(a), moving_a.motion()};
  const MovingShape of_b{run_.model.shape(b), moving_b.motion()};
  const ContactManifold m =
      run_.detector.manifold(of_a.shape, motions_.now(a).pose, of_b.shape, motions_.now(b).pose,
                             predictor_.touching_gap(a, b));
  if (m.size == 0) {
    return false;
  }
  const double d =
      std::max(draws_apart(of_a, of_b, m.normal, t), draws_apart(of_b, of_a, -m.normal, t));
  if (d > 0.0) {
    run_.agenda.push(t + d, DueKind::recheck, a, b);
  }
  return d > 0.0;
}

void EventContacts::impact(BodyIndex a, BodyIndex b, Instant t, double bracket, bool decided) {
  if (impact_of_balls(a, b, t, bracket)) {
    return;
  }
  open(a, b, t);
  const bool moved = meet_in_one_box(a, b, t);
  if (run_.stopped()) {
    return depart(a, b, t);
  }
  Event event = impact_in(a, b, t, bracket);
  const auto landing = modes_.landing(a, b);
  event.contact = landing ? landing->contact : contact_at(a, b, t, bracket);
  const double approach = normal_velocity(event.contact, motions_.now(a), motions_.now(b));
  const std::array<BodyIndex, 2> pair{a, b};
  if (!decided && bracket > 0.0 && approach >= -no_approach(event.contact, a, b, bracket)) {
    if (!could_be_supported(a, b, t) && settle(pair, t, {.pressed = BodyPair{a, b}})) {
      return;
    }
    // A body that continues as another image must be launched before it is asked about again.
    return moved ? relaunch(a, b, t) : look_again(a, b, t, bracket);
  }
  // What is struck again and again may be struck by the roundoff of speeds, without end.
  const double none = accumulation_.creep(a, b) ? roundoff(event.contact, a, b) : 0.0;
  if (approach >= -none && run_.law.info().needs_contact) {
    return touch(a, b, event.contact, t, bracket);
  }
  if (const double past = moved ? 0.0 : passes_by(a, b, t); past > 0.0) {
    return run_.agenda.push(t + past, DueKind::recheck, a, b);
  }
  if (decided && event.contact.gap > predictor_.touching_gap(a, b)) {
    // The step ended where no plane told that they are apart. The detector does.
    const std::vector<BodyIndex> bodies = modes_.group(pair);
    modes_.bring_group(bodies, t);
    return settle(bodies, t, {.may_turn = true}) ? void() : set_free(bodies, t);
  }
  if (run_.detector.info().proves && event.contact.gap > predictor_.touching_gap(a, b)) {
    return run_.stop(t,
                     fmt::format("undecided: the detector '{}' reports that {} touch, which are {} "
                                 "m apart; allowed: a larger --tolerance, or another detector",
                                 run_.detector.info().name, run_.names(a, b), event.contact.gap));
  }
  meet(event, t);
}

/// An approach below this, m/s, is roundoff of what it is a sum of.
double EventContacts::roundoff(const Contact& contact, BodyIndex a, BodyIndex b) const {
  double rates = 0.0;
  for (const BodyIndex i : {a, b}) {
    const BodyState& state = motions_.now(i);
    const double arm = (contact.point - state.pose.position).lpNorm<1>();
    rates += contact.normal.cwiseAbs().dot(state.twist.linear.cwiseAbs()) +
             state.twist.angular.norm() * (arm + state.pose.position.lpNorm<Eigen::Infinity>());
  }
  return 64.0 * epsilon * rates;
}

/// An approach below this, m/s, of which the detector does not prove that it leads anywhere, is
/// none: it is roundoff, and the way of a whole bracket is roundoff of a gap.
double EventContacts::no_approach(const Contact& contact, BodyIndex a, BodyIndex b,
                                  double bracket) const {
  double sizes = 0.0;
  for (const BodyIndex i : {a, b}) {
    sizes += (contact.point - motions_.now(i).pose.position).lpNorm<1>();
  }
  return std::min(roundoff(contact, a, b), epsilon * sizes / bracket);
}

/// Two bodies that approach each other strike, and with them those that they touch.
void EventContacts::meet(Event& event, Instant t) {
  const auto [a, b] = std::pair{event.a, event.b};
  const std::array<BodyIndex, 2> pair{a, b};
  const double approach = normal_velocity(event.contact, motions_.now(a), motions_.now(b));
  count_strike({a, b}, -approach, t);
  if (is_nothing(a, b, -approach)) {
    const std::vector<BodyIndex> bodies = modes_.group(pair);
    modes_.bring_group(bodies, t);
    lay_still(a, b);
    return settle(bodies, t, {.may_turn = true}) ? void() : set_free(bodies, t);
  }
  if (strikes_on() && end_by_pushing(pair, 0.0, t)) {
    return;
  }
  if (strike_group(event, std::max(-approach, 0.0))) {
    return;
  }
  std::vector<BodyIndex> group;
  if (modes_.holds(a) || modes_.holds(b)) {
    group = modes_.group(pair);
    modes_.bring_group(group, t);
  }
  strike(event);
  go_on_struck(event, approach, std::move(group), t);
}

/// The two strike each other at this speed, m/s.
void EventContacts::count_strike(const BodyPair& pair, double speed, Instant t) {
  const bool same = struck_at_ == t;
  struck_by_ = same ? std::max(struck_by_, speed) : speed;
  struck_alike_ = same && struck_last_ == pair ? struck_alike_ + 1 : 1;
  struck_here_ = same ? struck_here_ + 1 : 1;
  struck_at_ = t;
  struck_last_ = pair;
}

/// Whether what struck last, and before at this instant, does so without end.
bool EventContacts::strikes_on() const {
  const int turns = std::max(few_in_turns, most_in_turns * static_cast<int>(run_.model.size()));
  return run_.law.info().needs_contact &&
         (struck_alike_ % most_alike == 0 || struck_here_ % turns == 0);
}

/// Whether an approach at this speed, m/s, is nothing beside what struck at this instant.
bool EventContacts::is_nothing(BodyIndex a, BodyIndex b, double speed) const {
  const auto is_still = [&](BodyIndex i) {
    const Twist& v = motions_.now(i).twist;
    return run_.model.mobility(i) == Mobility::fixed ||
           (run_.model.is_free(i) &&
            v.linear.norm() + v.angular.norm() * run_.model.inertia(i).bounding_radius <=
                still * struck_by_);
  };
  return struck_by_ > 0.0 && speed <= nothing * struck_by_ && is_still(a) && is_still(b);
}

void EventContacts::lay_still(BodyIndex a, BodyIndex b) {
  for (const BodyIndex i : {a, b}) {
    if (run_.model.is_free(i)) {
      BodyState& now = motions_.now(i);
      const BodyState before = now;
      now.twist = {};
      run_.ledger.add(EnergyLine::zeno_completion, run_.account.gained(i, before, now));
      run_.account.struck(i, before, now);
    }
  }
}

/// The two have struck each other, which they met at this rate; `group`: those that they touch.
void EventContacts::go_on_struck(const Event& event, double approach, std::vector<BodyIndex> group,
                                 Instant t) {
  const auto [a, b] = std::pair{event.a, event.b};
  if (still_approaching(event, approach, t)) {
    return;
  }
  if (!group.empty()) {
    return hand_on(event, std::max(-approach, 0.0), std::move(group), t);
  }
  if (lands(a, b, event.contact, t) || rest_on_joints(event, t)) {
    return;
  }
  // Infinite friction may throw apart faster than they met.
  const double parting = normal_velocity(event.contact, motions_.now(a), motions_.now(b));
  go_on_as_found(event, accumulation_.after_impact(a, b, std::max({-approach, parting, 0.0}), t),
                 t);
}

/// They go on, or impacts like theirs have no end.
void EventContacts::go_on_as_found(const Event& event, const EventAccumulation::Finding& finding,
                                   Instant t) {
  const auto [a, b] = std::pair{event.a, event.b};
  const std::array<BodyIndex, 2> pair{a, b};
  using Kind = EventAccumulation::Finding::Kind;
  if (finding.kind == Kind::none) {
    // Bodies that do not bounce go on in touch at once.
    const bool stays = modes_.stays(a, b, event.contact);
    return stays && settle(pair, t, {.pressed = BodyPair{a, b}, .turning_only = true})
               ? void()
               : relaunch(a, b, t);
  }
  if (finding.kind != Kind::squeezed) {
    const bool unite = finding.kind != Kind::rests;
    EventModes::SettleOptions options{.unloaded = unite,
                                      .unite = unite,
                                      .remaining = finding.remaining,
                                      .pairs = finding.pairs,
                                      .may_turn = finding.kind != Kind::collapse,
                                      .may_part = !finding.endless};
    if (settle(pair, t, options)) {
      return;
    }
    if (finding.goes_on) {
      return relaunch(a, b, t);
    }
    // What turns may be slow in its middle and come together at its corners.
    if (finding.kind == Kind::rests && meet_elsewhere(a, b, t)) {
      return;
    }
    // What a driven body gave, or a law that takes no contact, is not taken back.
    const bool known = run_.law.info().needs_contact &&
                       run_.model.mobility(a) != Mobility::driven &&
                       run_.model.mobility(b) != Mobility::driven;
    options.last_resort = true;
    if (end_by_pushing(pair, finding.remaining, t, unite && known ? &event : nullptr) ||
        settle(pair, t, options)) {
      return;
    }
  }
  depart(a, b, t);  // the last frame shows the states after the impact, as booked
  run_.stop(t, finding.kind == Kind::squeezed ? finding.reason
                                              : fmt::format("{}; {}", finding.reason, unkept()));
}

/// Applies the impact law, and books what it did.
void EventContacts::strike(Event& event) {
  if (joints_of(event.a) != nullptr || joints_of(event.b) != nullptr) {
    return strike_jointed(event);
  }
  Vector3 unused_a = Vector3::Zero();  // no law gives a solid a force beside the impulse
  Vector3 unused_b = Vector3::Zero();
  const ImpactEnergy energy =
      run_.exchange(event, motions_.now(event.a), motions_.now(event.b), unused_a, unused_b,
                    run_.model.friction(event.a, event.b) > 0.0 && strikes_flat(event));
  run_.ledger.add(EnergyLine::impact_friction, energy.impact_friction);
  assert(!run_.law.info().kinematic || event.contact.friction > 0.0 ||
         !run_.law.info().needs_contact ||
         broken_restitution(event, event.contact.restitution).empty());
  run_.ledger.add(EnergyLine::restitution_loss, energy.restitution_loss);
  run_.ledger.add(EnergyLine::driven_work, energy.driven_work);
  run_.ledger.add(EnergyLine::conveyor_and_hand, energy.conveyor_and_hand);
}

/// Stops the run if the impact law left the two approaching each other.
bool EventContacts::still_approaching(const Event& event, double approach, Instant t) {
  const auto [a, b] = std::pair{event.a, event.b};
  const double rebound = normal_velocity(event.contact, event.after_a, event.after_b);
  double scale = std::abs(approach);
  double unfelt = 0.0;  // levers that coordinates cannot tell from none turn nothing
  for (const auto& [before, after] :
       {std::pair{&event.before_a, &event.after_a}, {&event.before_b, &event.after_b}}) {
    const Vector3 arm = event.contact.point - after->pose.position;
    const double spin = after->twist.angular.norm();
    scale += after->twist.linear.norm() + before->twist.linear.norm() +
             (spin + before->twist.angular.norm()) * arm.norm();
    unfelt +=
        512.0 * epsilon * spin * (arm.lpNorm<1>() + after->pose.position.lpNorm<Eigen::Infinity>());
  }
  // Roundoff of a product and a few sums; with friction, the tolerance to which an impact is
  // integrated; with joints, roundoff of the equations by which they pass it on.
  const bool jointed = joints_of(a) != nullptr || joints_of(b) != nullptr;
  const bool rough = run_.model.friction(a, b) > 0.0;
  const double allowed = rough || jointed ? 1e-12 : 16.0 * epsilon;
  if (!(rebound < -(allowed * scale + unfelt))) {
    return false;
  }
  depart(a, b, t);
  std::string why = fmt::format(
      "still approaching: the impact law '{}' leaves {} approaching each other at {} m/s",
      run_.law.info().name, run_.names(a, b), -rebound);
  if (rough && jointed) {
    const auto is_driven = [&](BodyIndex i) {
      return joints_of(i) != nullptr && joints_of(i)->driven();
    };
    why +=
        fmt::format(": friction locks what {}, and no impulse parts them; allowed: less friction",
                    is_driven(a) || is_driven(b) ? "a drive presses together through joints"
                                                 : "joints press together");
  }
  run_.stop(t, why);
  return true;
}

/// Sets velocities to zero that are roundoff of the fastest.
void EventContacts::leave_at_rest(const EventModes::GroupImpact& impact,
                                  const Eigen::VectorXd& impulses, std::vector<Twist>& v) const {
  double fastest = 0.0;
  for (const Twist& before : impact.velocities) {
    fastest = std::max(fastest, before.linear.norm());
  }
  const double least = 64.0 * epsilon * fastest;
  const std::vector<Twist> struck = v;
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
  // A velocity along a contact is kept whole: without one of its components it would lead into the
  // contact.
  ContactSystem at_rest{impact.system.bodies, {}};
  for (const ContactRow& row : impact.system.rows) {
    if (std::abs(impact.system.rate(row, struck)) <= least) {
      at_rest.rows.push_back(row);
    }
  }
  at_rest.undo_where_faster(struck, v);
  return_as_struck(impact, impulses, struck, v);
}

/// What is slow among the fastest may not be among the two that strike: they leave as they were
/// struck where their restitution would show the difference.
void EventContacts::return_as_struck(const EventModes::GroupImpact& impact,
                                     const Eigen::VectorXd& impulses,
                                     const std::vector<Twist>& struck, std::vector<Twist>& v) {
  const auto same = [&](std::size_t k) {
    return v[k].linear == struck[k].linear && v[k].angular == struck[k].angular;
  };
  for (bool again = true; again;) {
    again = false;
    for (std::size_t r = 0; r < impact.system.rows.size(); ++r) {
      const ContactRow& row = impact.system.rows[r];
      const auto at = static_cast<Eigen::Index>(r);
      if (!(impulses[at] > 0.0) || (same(row.a) && same(row.b))) {
        continue;
      }
      const double returned = -impact.restitution[at] * impact.system.rate(row, impact.velocities);
      const auto off = [&](const std::vector<Twist>& u) {
        return std::abs(impact.system.rate(row, u) - returned);
      };
      const double speeds =
          struck[row.a].linear.norm() + struck[row.a].angular.norm() * row.arm_a.norm() +
          struck[row.b].linear.norm() + struck[row.b].angular.norm() * row.arm_b.norm();
      if (off(v) > 16.0 * epsilon * speeds && off(v) > off(struck)) {
        v[row.a] = struck[row.a];
        v[row.b] = struck[row.b];
        again = true;
      }
    }
  }
}

/// Strikes all bodies of a group at once, if the impact law takes groups; false if it does not, or
/// there is no group.
bool EventContacts::strike_group(const Event& first, double approach) {
  const BodyPair pair{first.a, first.b};
  const Instant t = first.time;
  const GroupLaw* const law = group_law_;
  const bool held = modes_.holds(pair.first) || modes_.holds(pair.second);
  if (!held && (joints_of(pair.first) != nullptr || joints_of(pair.second) != nullptr)) {
    return false;
  }
  if (law == nullptr || !(held || law->takes_what_touches())) {
    return false;
  }
  EventModes::GroupImpact impact =
      modes_.impact_group(std::array{pair.first, pair.second}, t, law->takes_what_touches());
  const auto rubs = [&](const BodyPair& p) { return run_.model.friction(p.first, p.second) > 0.0; };
  if (rubs(pair) || std::any_of(impact.pairs.begin(), impact.pairs.end(), rubs)) {
    return false;  // with friction, pairs are struck one after the other
  }
  if (!impact.refusal.empty() || impact.pairs.size() < (held ? 1U : 2U)) {
    return false;
  }
  strike_where_met(first, run_.model.restitution(pair.first, pair.second), impact);
  std::vector<Twist> velocities = impact.velocities;
  const Eigen::VectorXd impulses = law->strike(impact.system, impact.restitution, velocities);
  if (impulses.size() == 0) {
    return false;
  }
  leave_at_rest(impact, impulses, velocities);
  std::vector<BodyState> before;
  std::vector<BodyIndex> bodies;
  double gained = 0.0;
  for (std::size_t k = 0; k < impact.bodies.size(); ++k) {
    const BodyIndex i = impact.bodies[k];
    if (run_.model.is_free(i)) {
      motions_.book(i, t);
      motions_.bring(i, t);
      bodies.push_back(i);
    } else if (run_.model.mobility(i) == Mobility::driven) {
      motions_.bring(i, t);
    }
    BodyState& now = motions_.now(i);
    before.push_back(now);
    if (run_.model.is_free(i)) {
      before.back().twist = impact.velocities[k];
      run_.ledger.add(EnergyLine::projection, run_.account.gained(i, now, before.back()));
      now.twist = velocities[k];
      run_.account.struck(i, before.back(), now);
      gained += run_.account.gained(i, before.back(), now);
    }
  }
  const double of_joints = impact.system.driven_work(impulses);
  run_.ledger.add(EnergyLine::projection, -impact.driven);
  run_.ledger.add(EnergyLine::driven_work, impact.driven + of_joints);
  gained -= of_joints;
  double exchanged = 0.0;
  // Each row changed the energy by p (u- + u+) / 2, beside the work of driven bodies.
  for (std::size_t r = 0; r < impact.system.rows.size(); ++r) {
    const ContactRow& row = impact.system.rows[r];
    const double p = impulses[static_cast<Eigen::Index>(r)];
    if (p == 0.0) {
      continue;
    }
    const double u = impact.system.rate(row, impact.velocities);
    const double lost = 0.5 * p * (u + impact.system.rate(row, velocities));
    run_.ledger.add(EnergyLine::restitution_loss, lost);
    gained -= lost;
    exchanged += std::abs(p * u);
    for (const std::size_t k : {row.a, row.b}) {
      if (run_.model.mobility(impact.bodies[k]) == Mobility::driven) {
        const Twist& v = impact.velocities[k];
        const Vector3& arm = k == row.a ? row.arm_a : row.arm_b;
        const double work =
            (k == row.a ? p : -p) * row.direction.dot(v.linear + v.angular.cross(arm));
        run_.ledger.add(EnergyLine::driven_work, work);
        gained -= work;
      }
    }
  }
  // What is left is the work of the impulses of joints, on what their equations are off.
  if (impact.system.joints != nullptr && std::abs(gained) <= off_by_joints * exchanged) {
    run_.ledger.add(EnergyLine::projection, gained);
  }
  tell_group(impact, impulses, before, first);
  go_on_from(bodies, pair, approach, t);
  return true;
}

/// Records an impact of each pair that took an impulse, the pair that began it first. Its contact
/// is the centre of the impulses of the points that approached, which leave as restitution says; if
/// none approached, the centre of all impulses.
void EventContacts::tell_group(const EventModes::GroupImpact& impact,
                               const Eigen::VectorXd& impulses, std::span<const BodyState> before,
                               const Event& first) {
  const auto place = [&](BodyIndex i) {
    const auto found = std::find(impact.bodies.begin(), impact.bodies.end(), i);
    return static_cast<std::size_t>(found - impact.bodies.begin());
  };
  const auto is_first = [&](const BodyPair& p) {
    return p == BodyPair{first.a, first.b} || p == BodyPair{first.b, first.a};
  };
  double fastest = 0.0;
  for (const BodyState& s : before) {
    fastest = std::max(fastest, s.twist.linear.norm());
  }
  const double resolved = 64.0 * epsilon * fastest;
  const auto tell = [&](std::size_t p) {
    const auto [a, b] = impact.pairs[p];
    Event event{.time = first.time,
                .kind = EventKind::impact,
                .flag = first.flag,
                .bracket = first.bracket,
                .a = a,
                .b = b};
    struct Centre {
      double total = 0.0;
      Vector3 sum = Vector3::Zero();
    } of_all, of_approaching;
    for (std::size_t r = 0; r < impact.pair_of_row.size(); ++r) {
      const double share = impulses[static_cast<Eigen::Index>(r)];
      if (impact.pair_of_row[r] != p || !(share > 0.0)) {
        continue;
      }
      const ContactRow& row = impact.system.rows[r];
      const bool approaches = impact.system.rate(row, impact.velocities) < 0.0;
      for (Centre* centre : {&of_all, approaches ? &of_approaching : nullptr}) {
        if (centre != nullptr) {
          centre->total += share;
          centre->sum += share * (impact.system.bodies[row.a].position + row.arm_a);
        }
      }
      event.contact.normal = row.direction;
      event.contact.gap = impact.gaps[r];
    }
    if (of_all.total == 0.0) {
      return;
    }
    const Centre& centre = of_approaching.total > 0.0 ? of_approaching : of_all;
    // What the two gave each other may be roundoff of what others gave them.
    const auto gained = [&](BodyIndex i) {
      return of_all.total * impact.system.bodies[place(i)].inverse_mass;
    };
    const bool only_handed_on = gained(a) <= resolved && gained(b) <= resolved;
    // What began it is told where it approached, once nothing is off any more.
    const bool began = is_first(impact.pairs[p]) && of_approaching.total > 0.0;
    if (only_handed_on && !began) {
      return;
    }
    event.contact.point = centre.sum / centre.total;
    event.contact.restitution = run_.model.restitution(a, b);
    event.contact.friction = run_.model.friction(a, b);
    event.before_a = before[place(a)];
    event.before_b = before[place(b)];
    // What holds, and parts by what its step is off, was pressed through: it did not strike.
    const double speeds = event.before_a.twist.linear.norm() + event.before_b.twist.linear.norm() +
                          event.before_a.twist.angular.norm() *
                              (event.contact.point - event.before_a.pose.position).norm() +
                          event.before_b.twist.angular.norm() *
                              (event.contact.point - event.before_b.pose.position).norm();
    if (of_approaching.total == 0.0 &&
        normal_velocity(event.contact, event.before_a, event.before_b) > 64.0 * epsilon * speeds) {
      return;
    }
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

/// Hands an impact on through the patches of bodies in touch: pair by pair, always where they
/// approach fastest, until none approaches, or what is left can be had at once. Then the rest of
/// the group is settled.
void EventContacts::hand_on(const Event& first, double approach, std::vector<BodyIndex> bodies,
                            Instant t) {
  const std::array<BodyPair, 1> struck{BodyPair{first.a, first.b}};
  const std::vector<EventModes::TouchingPair> pairs = modes_.touching_pairs(bodies, struck);
  const std::size_t most = most_rounds * bodies.size();
  std::size_t at_once = few_rounds * bodies.size();  // when that is tried next
  for (std::size_t round = 0; run_.law.info().needs_contact; ++round) {
    const auto worst = modes_.worst_approach(pairs);
    if (!worst) {
      break;
    }
    if (round == most) {
      if (end_by_pushing(bodies, 0.0, t)) {
        return;
      }
      const std::string squeezed =
          accumulation_.squeeze({first.a, first.b}, {worst->a, worst->b}, t);
      set_free(bodies, t);
      return run_.stop(
          t, !squeezed.empty()
                 ? squeezed
                 : fmt::format("accumulation: an impact of {} is handed on between "
                               "bodies in touch more than {} times; {}",
                               run_.names(first.a, first.b), most, lasting_contact_advice));
    }
    if (round == at_once) {
      // The longer it lasts, the more of it is left to the impact that ends it.
      const double tried = static_cast<double>(round / (few_rounds * bodies.size()));
      const double part = worst->speed / approach / tried;
      if (std::vector<BodyIndex> all = hand_on_at_once(first, bodies, part, t); !all.empty()) {
        bodies = std::move(all);
        at_once = round + few_rounds * bodies.size();
        continue;
      }
      at_once *= 2;
    }
    if (is_nothing(worst->a, worst->b, worst->speed)) {
      lay_still(worst->a, worst->b);
      continue;
    }
    Event event{.time = t,
                .kind = EventKind::impact,
                .flag = EventFlag::set_valued,
                .bracket = first.bracket,
                .a = worst->a,
                .b = worst->b};
    event.contact = worst->contact;
    strike(event);
  }
  go_on_from(bodies, {first.a, first.b}, approach, t);
}

/// Settles the bodies that an impact left in touch, or sets them free.
void EventContacts::go_on_from(std::span<const BodyIndex> bodies, const BodyPair& first,
                               double approach, Instant t) {
  using Kind = EventAccumulation::Finding::Kind;
  const auto finding = accumulation_.after_impact(first.first, first.second, approach, t);
  const bool unite = finding.kind == Kind::collapse || finding.kind == Kind::creeps;
  EventModes::SettleOptions options{
      .unloaded = unite,
      .unite = unite,
      .remaining = finding.remaining,
      .pairs = finding.pairs,
      .may_turn = finding.kind != Kind::none && finding.kind != Kind::collapse,
      .may_part = !finding.endless};
  if (settle(bodies, t, options)) {
    return;
  }
  const bool endless = finding.kind != Kind::none && !finding.goes_on;
  options.last_resort = true;
  if (endless && finding.kind != Kind::squeezed &&
      (end_by_pushing(bodies, finding.remaining, t) || settle(bodies, t, options))) {
    return;
  }
  set_free(bodies, t);
  if (endless) {
    run_.stop(t, finding.kind == Kind::squeezed ? finding.reason
                                                : fmt::format("{}; {}", finding.reason, unkept()));
  }
}

}  // namespace core
}  // namespace kairos
