#include "core/schemes/event/event_contacts.hpp"

#include "core/archive.hpp"
#include "core/ball_detector.hpp"
#include "core/contacts/group_law.hpp"
#include "core/point_law.hpp"
#include "core/schemes/event/jump.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

/// Looks that follow each other by less than this part of the motions make no progress.
constexpr double least_progress = 1e-12;
/// `contact_begins` of a contact whose beginning has been recorded.
constexpr Instant recorded{-1.0, 0.0};
/// So often what stalls is settled as ever.
constexpr int most_in_vain = 8;
/// So often in a frame what no mode keeps goes on by itself.
constexpr int most_let_go = 8;

}  // namespace

EventContacts::EventContacts(EventRun& run, EventMotions& motions, EventPredictor& predictor,
                             ContactGraph& graph, const Method& method)
    : run_(run),
      motions_(motions),
      predictor_(predictor),
      graph_(graph),
      group_law_(dynamic_cast<const GroupLaw*>(&run.law)),
      accumulation_(run, motions),
      modes_(run, motions, predictor, accumulation_, graph, method.contact_stepper),
      ball_detector_(dynamic_cast<const BallDetector*>(&run.detector)) {
  if (!run.model.scene().periodic && !run.options.roundoff && run.law.info().needs_contact &&
      (group_law_ == nullptr || !group_law_->takes_what_touches())) {
    point_law_ = dynamic_cast<const PointLaw*>(&run.law);
  }
}

// --- Groups ------------------------------------------------------------------------------------

bool EventContacts::settle(std::span<const BodyIndex> seeds, Instant t,
                           const EventModes::SettleOptions& options) {
  const auto adopt = [this](BodyIndex ball) {
    const auto found = touching_.find(ball);
    return found == touching_.end() ? Instant::never()
                                    : std::exchange(found->second.contact_begins, Instant::never());
  };
  return modes_.settle(seeds, t, adopt, options);
}

/// Tells a person why bodies in touch cannot be kept there.
std::string EventContacts::unkept() const {
  std::string text = modes_.why_not().empty()
                         ? std::string(lasting_contact_advice)
                         : fmt::format("{}; {}", modes_.why_not(), lasting_contact_advice);
  if (run_.model.has_friction() && run_.model.scene().joints.empty()) {
    text +=
        "; schemes that treat friction between bodies that turn: moreau-jean, pgs, xpbd, penalty";
  }
  return text;
}

/// The bodies are held no longer: each flies on from `now`.
void EventContacts::set_free(std::span<const BodyIndex> bodies, Instant t) {
  const auto changes = modes_.part(bodies);
  for (const BodyIndex i : bodies) {
    const std::vector<BodyIndex>& island = motions_.island(i);
    const bool hangs = joints_of(i) != nullptr || island.size() > 1;
    for (const BodyIndex k : island) {
      // What joints hold together was struck together.
      if (joints_of(i) == nullptr && std::find(bodies.begin(), bodies.end(), k) == bodies.end()) {
        motions_.bring(k, t);
      }
    }
    if (hangs) {
      part_hanging(i, t);
    }
    if (motions_.support(i)) {
      resume_support(i, t);
    }
    const bool launched = hangs && std::any_of(bodies.begin(), bodies.end(), [&](BodyIndex k) {
                            return std::find(island.begin(), island.end(), k) <
                                   std::find(island.begin(), island.end(), i);
                          });
    if (!launched) {
      motions_.launch(i, t);
    }
  }
  modes_.tell(changes, t);
  for (const BodyIndex i : bodies) {
    predictor_.predict_island(i, t);
  }
}

void EventContacts::settle_anew(BodyIndex i, Instant t) {
  const std::array<BodyIndex, 1> seed{i};
  const std::vector<BodyIndex> bodies = modes_.group(seed);
  modes_.bring_group(bodies, t);
  if (settle(bodies, t, {.may_turn = true})) {
    return;
  }
  const std::string why = unkept();
  // Where a corner is to strike at once, it does.
  if (const auto worst = modes_.worst_approach(modes_.touching_pairs(bodies, {}, true))) {
    motions_.open_pair(worst->a, worst->b, t);
    Event event{.time = t, .kind = EventKind::impact, .a = worst->a, .b = worst->b};
    event.contact = worst->contact;
    return meet(event, t);
  }
  if (settle(bodies, t, {.may_turn = true, .last_resort = true})) {
    return;
  }
  set_free(bodies, t);
  if (!may_let_go(t)) {
    run_.stop(t, fmt::format("contact: the contacts of '{}' cannot be kept from here on: {}",
                             run_.model.body(i).name, why));
  }
}

/// Whether bodies that nothing draws together, and no mode keeps, may go on by themselves. What
/// presses them brings them together again, by impacts that are booked.
bool EventContacts::may_let_go(Instant t) {
  const double frame = std::floor(t.seconds / run_.mean_frame);
  let_go_ = let_go_in_ == frame ? let_go_ + 1 : 1;
  let_go_in_ = frame;
  return let_go_ <= most_let_go;
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

/// Two bodies meet: what hangs on joints goes on together, whether it strikes or not.
void EventContacts::open(BodyIndex a, BodyIndex b, Instant t) {
  motions_.open_pair(a, b, t);
  for (const BodyIndex i : {a, b}) {
    if (joints_of(i) != nullptr) {
      motions_.bring_others(i, t);
    }
  }
}

void EventContacts::stay(BodyIndex a, BodyIndex b, Instant t) {
  const std::array<BodyIndex, 2> pair{a, b};
  open(a, b, t);
  (void)meet_in_one_box(a, b, t);
  if (run_.stopped()) {
    return depart(a, b, t);
  }
  const Contact contact = contact_at(a, b, t, 0.0);
  if (lands(a, b, contact, t) || settle_stalled(pair, t)) {
    return;
  }
  if (meet_elsewhere(a, b, t) || leave_alone(a, b, t) || end_by_pushing(pair, 0.0, t) ||
      settle_at_last(pair, t)) {
    return;
  }
  depart(a, b, t);
  run_.stop(t, fmt::format("accumulation: {} stay in contact; {}", run_.names(a, b), unkept()));
}

/// Settles what is in touch where time does not go on. Where that was done in vain again and again,
/// it turns, as over a rim; or a step is made over all of it.
bool EventContacts::settle_stalled(std::span<const BodyIndex> seeds, Instant t) {
  stalled_ = stalled_at_ == t ? stalled_ + 1 : 0;
  stalled_at_ = t;
  const auto settle_turned = [&](bool step_over) {
    return settle(seeds, t,
                  {.turning = true, .may_turn = true, .not_flat = true, .step_over = step_over});
  };
  return go_on_if((stalled_ > most_in_vain && (settle_turned(false) || settle_turned(true))) ||
                      settle(seeds, t, {.unloaded = true, .may_turn = true}),
                  seeds);
}

/// The same of two that are held by nobody, or they are left alone; this first where it was settled
/// in vain, turned as well, and in the end this alone.
bool EventContacts::go_on_stalled(BodyIndex a, BodyIndex b, Instant t) {
  const std::array<BodyIndex, 2> pair{a, b};
  const int settled = stalled_at_ == t ? stalled_ : 0;
  const bool first_alone = settled > 2 * most_in_vain;
  if (first_alone && leave_alone(a, b, t)) {
    return true;
  }
  return (settled <= 4 * most_in_vain && settle_stalled(pair, t)) ||
         (!first_alone && leave_alone(a, b, t));
}

/// The same before a run would stop.
bool EventContacts::settle_at_last(std::span<const BodyIndex> seeds, Instant t) {
  return go_on_if(settle(seeds, t, {.may_turn = true, .last_resort = true}), seeds);
}

/// What settled has not stalled; returns whether it did.
bool EventContacts::go_on_if(bool settled, std::span<const BodyIndex> seeds) {
  for (std::size_t k = 0; k < seeds.size() && settled; ++k) {
    accumulation_.go_on(seeds[k]);
  }
  return settled;
}

/// Handles an impact where two bodies in touch come together elsewhere than at their nearest
/// points; false where they do not.
bool EventContacts::meet_elsewhere(BodyIndex a, BodyIndex b, Instant t) {
  const std::array<BodyPair, 1> both{BodyPair{a, b}};
  const auto worst = modes_.worst_approach(modes_.touching_pairs({}, both, true));
  if (worst) {
    Event event{.time = t, .kind = EventKind::impact, .a = a, .b = b};
    event.contact = worst->contact;
    meet(event, t);
  }
  return worst.has_value();
}

/// Whether one of the two is a ball that a face of the other could support.
bool EventContacts::could_be_supported(BodyIndex a, BodyIndex b, Instant t) const {
  for (const auto& [ball, surface] : {std::pair{a, b}, std::pair{b, a}}) {
    if (run_.model.is_free(ball) && !run_.model.is_free(surface) &&
        std::holds_alternative<Sphere>(run_.model.shape(ball)) && motions_.start_of(surface) <= t &&
        run_.model.friction(ball, surface) == 0.0) {
      return true;
    }
  }
  return false;
}

/// When corners that only just meet, and part as far as their first rates tell, approach within a
/// bracket that proves that they overlap, s; 0: not, or only deeper than roundoff.
double EventContacts::comes_together(BodyIndex a, BodyIndex b, Instant t, double bracket) const {
  constexpr int most_halvings = 40;
  if (!run_.detector.info().proves || run_.model.scene().periodic) {
    return 0.0;
  }
  double radii = 0.0;
  for (const BodyIndex i : {a, b}) {
    const double radius = bounding_radius(run_.model.shape(i));
    radii += std::isfinite(radius) ? radius : 0.0;
  }
  double h = bracket;
  for (int k = 0; k < most_halvings && t < t + h; ++k, h *= 0.5) {
    const BodyState at_a = motions_.at(a, t + h);
    const BodyState at_b = motions_.at(b, t + h);
    const Overlap o =
        run_.detector.overlap(run_.model.shape(a), at_a.pose, run_.model.shape(b), at_b.pose);
    const double sizes = at_a.pose.position.lpNorm<1>() + at_b.pose.position.lpNorm<1>() + radii;
    if (o.gap >= -64.0 * std::numeric_limits<double>::epsilon() * sizes) {
      return normal_velocity({o.point, o.normal, o.gap}, at_a, at_b) < 0.0 ? h : 0.0;
    }
  }
  return 0.0;
}

/// The two are in touch and do not approach: there is no impact, and no event to record. They go on
/// as before, unless they come to rest.
void EventContacts::touch(BodyIndex a, BodyIndex b, const Contact& contact, Instant t,
                          double bracket) {
  if (lands(a, b, contact, t)) {
    return;
  }
  const std::array<BodyIndex, 2> pair{a, b};
  if (modes_.holds(a) || modes_.holds(b)) {
    const bool again = accumulation_.stalls(a, b, t, least_progress * run_.epoch());
    // What the motions press together, and the mode does not, strikes when it has come nearer.
    if (const double until = again ? comes_together(a, b, t, bracket) : 0.0; until > 0.0) {
      return run_.agenda.push(t + until, DueKind::impact, a, b);
    }
    const std::vector<BodyIndex> bodies = modes_.group(pair);
    modes_.bring_group(bodies, t);
    // Asked again and again, it is at a rim: what goes over that turns.
    const bool settled = again ? settle_stalled(bodies, t) : settle(bodies, t, {.unloaded = true});
    return settled ? void() : set_free(bodies, t);
  }
  if (settle(pair, t, {.pressed = BodyPair{a, b}}) || meet_elsewhere(a, b, t)) {
    return;
  }
  if (accumulation_.stalls(a, b, t, least_progress * run_.epoch())) {
    if (go_on_stalled(a, b, t)) {
      return;
    }
    if (const double until = comes_together(a, b, t, bracket); until > 0.0) {
      return run_.agenda.push(t + until, DueKind::impact, a, b);
    }
    if (end_by_pushing(pair, 0.0, t) || settle_at_last(pair, t)) {
      return;
    }
    depart(a, b, t);
    return run_.stop(t,
                     fmt::format("accumulation: {} stay in touch; {}", run_.names(a, b), unkept()));
  }
  relaunch(a, b, t);
}

/// Whether all that is as near as a patch of this gap, or comes so within the bracket, draws away.
bool EventContacts::parts_all_over(BodyIndex a, BodyIndex b, double gap, double bracket) const {
  const BodyState& state_a = motions_.now(a);
  const BodyState& state_b = motions_.now(b);
  const Shape& shape_a = run_.model.shape(a);
  const Shape& shape_b = run_.model.shape(b);
  const auto speed = [](const BodyState& state, const Shape& shape) {
    const double turning = state.twist.angular.norm();  // a half-space that turns is nowhere slow
    return state.twist.linear.norm() + (turning > 0.0 ? turning * bounding_radius(shape) : 0.0);
  };
  const double fastest = speed(state_a, shape_a) + speed(state_b, shape_b);
  const double reach = 2.0 * (std::max(gap, predictor_.touching_gap(a, b)) + fastest * bracket);
  constexpr double still = 1e-9;  // what draws away slower than this part may as well approach
  if (modes_.has_parts(a) || modes_.has_parts(b)) {
    const auto least = modes_.least_parting(a, b, reach);
    return least && normal_velocity(*least, state_a, state_b) > still * fastest;
  }
  const ContactManifold near =
      run_.detector.manifold(shape_a, state_a.pose, shape_b, state_b.pose, reach);
  for (std::size_t k = 0; k < near.size; ++k) {
    const Contact point{near.points[k].position, near.normal, near.points[k].gap};
    if (!(normal_velocity(point, state_a, state_b) > still * fastest)) {
      return false;
    }
  }
  return near.size > 0;
}

/// Where the two touch at t: at the centroid of the contact patch, or, if that does not approach,
/// at another place of what has parts, or at the nearest points (one corner of several within
/// tolerance).
Contact EventContacts::contact_at(BodyIndex a, BodyIndex b, Instant t, double bracket) const {
  const BodyState& state_a = motions_.now(a);
  const BodyState& state_b = motions_.now(b);
  const Overlap o =
      run_.detector.overlap(run_.model.shape(a), state_a.pose, run_.model.shape(b), state_b.pose);
  const Contact patch{o.point, o.normal, o.gap};
  if (normal_velocity(patch, state_a, state_b) < 0.0) {
    return patch;
  }
  if (modes_.has_parts(a) || modes_.has_parts(b)) {
    const auto elsewhere = modes_.least_parting(a, b, predictor_.touching_gap(a, b));
    if (elsewhere && normal_velocity(*elsewhere, state_a, state_b) < 0.0) {
      return *elsewhere;
    }
  }
  if (bracket <= 0.0 || parts_all_over(a, b, patch.gap, bracket)) {
    return patch;
  }
  const TimeOfImpact toi = run_.detector.time_of_impact(motions_.moving(a), motions_.moving(b),
                                                        {t, bracket}, run_.options.toi_tolerance);
  const Contact nearest{0.5 * (toi.witness_a + toi.witness_b), toi.normal, toi.gap};
  const bool found = toi.status == ToiStatus::impact || toi.status == ToiStatus::undecided;
  return found && normal_velocity(nearest, state_a, state_b) < 0.0 ? nearest : patch;
}

/// Asks again about a pair within tolerance that does not approach, at the end of its bracket.
/// Brackets that hardly advance would be asked for without end: then the run stops.
void EventContacts::look_again(BodyIndex a, BodyIndex b, Instant t, double bracket) {
  const double window = std::min({motions_.of(a).duration, motions_.of(b).duration, run_.epoch()});
  if (accumulation_.stalls(a, b, t, least_progress * window)) {
    const std::array<BodyIndex, 2> pair{a, b};
    if (settle_stalled(pair, t) || meet_elsewhere(a, b, t) || leave_alone(a, b, t) ||
        end_by_pushing(pair, 0.0, t)) {
      return;
    }
    return run_.stop(t, fmt::format("accumulation: whether {} touch is undecided again and again, "
                                    "and time does not go on; {}",
                                    run_.names(a, b), unkept()));
  }
  run_.agenda.push(t + bracket, DueKind::recheck, a, b);
}

/// Whether a ball comes to rest on a face, as its hop is too small to resolve; it is then
/// supported.
bool EventContacts::lands(BodyIndex a, BodyIndex b, const Contact& contact, Instant t) {
  if (run_.model.is_free(a) && run_.model.is_free(b)) {
    return false;
  }
  const double e = run_.model.restitution(a, b);
  const double tolerance = accumulation_.rest_tolerance(a, b, e);
  for (const BodyIndex ball : {a, b}) {
    const BodyIndex surface = ball == a ? b : a;
    if (!run_.model.is_free(ball) || run_.model.is_free(surface)) {
      continue;
    }
    if (run_.model.friction(ball, surface) > 0.0 || modes_.holds(ball)) {
      continue;  // settled as a group in touch
    }
    const auto moving = motions_.moving(surface);
    const Motion& under = moving.motion();
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
      if (!accumulation_.stalls(a, b, t, least_progress * run_.epoch())) {
        continue;  // each surface in turn slows it down
      }
      if (settle_stalled(pair, t)) {
        return true;
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
  return !motions_.is_plain(a) && run_.model.is_free(a) && run_.model.is_free(b) &&
         run_.model.island_of(a) == run_.model.island_of(b);
}

/// Launches the islands of the two from `now`, where an impact has put them.
void EventContacts::depart(BodyIndex a, BodyIndex b, Instant t) {
  for (const BodyIndex i : {a, b}) {
    if (motions_.is_plain(i)) {
      continue;
    }
    // Bodies that joints hold together were struck together.
    if (joints_of(i) != nullptr) {
      part_hanging(i, t);
    } else if (run_.model.is_free(i)) {
      if (motions_.island(i).size() > 1) {
        part_hanging(i, t);
      }
      for (const BodyIndex k : motions_.island(i)) {
        if (k != a && k != b) {
          motions_.bring(k, t);
        }
      }
    }
  }
  for (const BodyIndex i : {a, b}) {
    if (!motions_.is_plain(i)) {
      if (!run_.model.is_free(i) || (i == b && in_one_island(a, b))) {
        continue;
      }
      if (motions_.support(i)) {
        resume_support(i, t);
      }
    }
    motions_.launch(i, t);
  }
}

void EventContacts::relaunch(BodyIndex a, BodyIndex b, Instant t) {
  depart(a, b, t);
  for (const BodyIndex i : {a, b}) {
    if (motions_.is_plain(i)) {
      predictor_.predict(i, t, i == b && run_.model.is_free(a) ? a : i);
      continue;
    }
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

/// Speed at which the ball leaves the surface, m/s.
double EventContacts::leaving_speed(BodyIndex ball, const Support& support, Instant t) const {
  const auto moving = motions_.moving(support.surface);
  const Motion& under = moving.motion();
  const double s = std::min(t - under.start, under.duration);
  return support.normal.dot(motions_.now(ball).twist.linear - under.twist(s).linear);
}

/// Gives the ball the velocity of the surface along its normal and the height over it that it had
/// when they met. A driven motion comes in pieces, each truncated at its order: their errors would
/// add up.
void EventContacts::follow(BodyIndex ball, const Support& support, Instant t) {
  const double away = leaving_speed(ball, support, t);
  const auto moving = motions_.moving(support.surface);
  const Motion& under = moving.motion();
  const double s = std::min(t - under.start, under.duration);
  if (run_.model.mobility(support.surface) == Mobility::driven) {
    Vector3& x = motions_.now(ball).pose.position;
    const double height = support.normal.dot(x - under.pose(s).position);
    const Vector3 before = x;
    x += (support.height - height) * support.normal;
    run_.account.moved(ball, x - before);
  }
  const double ground = support.normal.dot(under.twist(s).linear);
  const double m = run_.model.inertia(ball).mass;
  run_.ledger.add(EnergyLine::restitution_loss, -0.5 * m * away * away);
  run_.ledger.add(EnergyLine::driven_work, -m * away * ground);
  Vector3& v = motions_.now(ball).twist.linear;
  v -= support.normal * (support.normal.dot(v) - ground);
}

/// The ball stays on the surface from now on. The hops that are left, each e times as long as the
/// one before, would take 2 u / (a (1 - e)): contact begins after that time.
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
  auto& [settled, contact_begins] = touching_[ball];
  if (settled != Instant::never() &&
      accumulation_.stalls(ball, support.surface, t, least_progress * run_.epoch())) {
    // The ball is at the rim of the face, and goes on over the edge.
    const std::array<BodyIndex, 2> pair{ball, support.surface};
    if (settle(pair, t, {.unloaded = true, .may_turn = true})) {
      return;
    }
    return run_.stop(t, fmt::format("accumulation: {} leave and meet each other again and again, "
                                    "and time does not go on; {}",
                                    run_.names(ball, support.surface), lasting_contact_advice));
  }
  settled = t;
  contact_begins = t + still;
  if (contact_begins < Instant::never()) {
    run_.agenda.push(contact_begins, DueKind::contact_begins, ball, support.surface);
  }
  predictor_.predict_island(ball, t);
}

/// Keeps a supported ball that was pushed on its surface, if the push is along the surface.
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
  const auto touching = touching_.find(i);
  if (motions_.support(i) && touching != touching_.end() && touching->second.contact_begins == t) {
    run_.time = t;
    touching->second.contact_begins = recorded;
    motions_.note({.time = t,
                   .kind = EventKind::contact_begins,
                   .bracket = 0.0,
                   .a = i,
                   .b = motions_.support(i)->surface});
  }
}

void EventContacts::end_contact(BodyIndex i, Instant t) {
  Instant& began = touching_[i].contact_begins;
  const BodyIndex surface = motions_.support(i)->surface;
  motions_.set_support(i, std::nullopt);
  if (began < t) {  // otherwise its hops had not died down
    Event event{.time = t, .kind = EventKind::contact_ends, .a = i, .b = surface};
    event.before_a = event.after_a = motions_.now(i);  // what it was struck to, at this instant
    event.before_b = event.after_b = motions_.at(surface, t);
    run_.note(event);
  }
  began = Instant::never();
}

void EventContacts::leave_support(BodyIndex i, Instant t) {
  jump(motions_, predictor_, i, t, [&] { end_contact(i, t); });
}

void EventContacts::carry_riders(BodyIndex surface, Instant t) {
  std::vector<BodyIndex> settled;
  for (const BodyIndex i : modes_.held_by(surface)) {
    if (std::find(settled.begin(), settled.end(), i) == settled.end() && !run_.stopped()) {
      const std::array<BodyIndex, 1> seed{i};
      const std::vector<BodyIndex> group = modes_.group(seed);
      settled.insert(settled.end(), group.begin(), group.end());
      settle_anew(i, t);
    }
  }
  if (motions_.riders(surface) == 0) {
    return;
  }
  for (const BodyIndex i : run_.agenda.by_name()) {
    if (motions_.is_supported_by(i, surface)) {
      jump(motions_, predictor_, i, t, [&] { resume_support(i, t); });
    }
  }
}

// --- Fields ------------------------------------------------------------------------------------

void EventContacts::cross_field(BodyIndex a, BodyIndex b, Instant t, bool entering) {
  const BodyIndex field = run_.model.is_field(a) ? a : b;
  const BodyIndex body = field == a ? b : a;
  motions_.open(body, t);
  std::vector<BodyIndex> group;
  if (modes_.holds(body)) {
    const std::array<BodyIndex, 1> seed{body};
    group = modes_.group(seed);
    modes_.bring_group(group, t);
  }
  std::vector<BodyIndex> fields = motions_.fields(body);
  if (entering) {
    fields.push_back(field);
  } else {
    std::erase(fields, field);
  }
  motions_.set_fields(body, std::move(fields));
  motions_.note(entering ? EventKind::field_entered : EventKind::field_left, field, body, t);
  if (!group.empty()) {
    return settle(group, t) ? void() : set_free(group, t);
  }
  jump(motions_, predictor_, body, t, [&] {
    if (motions_.support(body)) {
      resume_support(body, t);
    }
  });
}

void EventContacts::Touching::persist(Archive& archive) { archive(settled, contact_begins); }

void EventContacts::persist(Archive& archive) {
  std::size_t n = touching_.size();
  archive.count(n);
  archive(stalled_, stalled_at_, let_go_, let_go_in_, pushed_, pushed_in_, struck_by_, struck_at_,
          struck_last_.first, struck_last_.second, struck_alike_, struck_here_);
  if (archive.reading()) {
    for (std::size_t k = 0; k < n; ++k) {
      BodyIndex i = 0;
      archive(i);
      archive.require(i < run_.model.size());
      archive(touching_[i]);
    }
  } else {
    for (auto& [i, touching] : touching_) {
      BodyIndex ball = i;
      archive(ball, touching);
    }
  }
  archive(accumulation_, modes_);
}

}  // namespace core
}  // namespace kairos
