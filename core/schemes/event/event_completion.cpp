// `EventContacts` where impacts have no end that contact could begin in, or are handed on without
// one: what they come to.
#include "core/contacts/contact_sweeps.hpp"
#include "core/schemes/event/event_contacts.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

using Vector6 = ContactSweeps::Vector6;

/// Of the fastest: sweeps that change less have settled; those that change more have not.
constexpr double settled = 1e-13;
constexpr double accepted = 1e-8;
/// Of the speed of an impact, and of what touches on average do not return: what is left is
/// plastic.
constexpr double nearly_handed_on = 0.1;
/// What was pushed apart and comes together again and again gets nowhere: so often in a frame.
constexpr int most_pushes = 1000;
/// After so many the last impact of a collapse is taken for one of its end.
constexpr int few_pushes = 8;

/// The touches of a group: where its rows are, with the friction of their pairs.
std::vector<SweptTouch> touches_of(const EventModes::GroupImpact& impact, const Model& model) {
  std::vector<SweptTouch> touches;
  for (std::size_t r = 0; r < impact.system.rows.size(); ++r) {
    const ContactRow& row = impact.system.rows[r];
    const auto& [a, b] = impact.pairs[impact.pair_of_row[r]];
    touches.push_back({row.a, row.b, row.direction,
                       impact.system.bodies[row.a].position + row.arm_a,
                       impact.system.bodies[row.b].position + row.arm_b, model.friction(a, b)});
  }
  return touches;
}

/// Leaves out of an impact the touches of other pairs than these: what only meets at this instant
/// has an impact of its own.
template <typename Takes>
void keep_pairs(EventModes::GroupImpact& impact, const Takes& takes) {
  std::size_t kept = 0;
  for (std::size_t r = 0; r < impact.system.rows.size(); ++r) {
    if (!takes(impact.pairs[impact.pair_of_row[r]])) {
      continue;
    }
    impact.system.rows[kept] = impact.system.rows[r];
    impact.pair_of_row[kept] = impact.pair_of_row[r];
    impact.gaps[kept] = impact.gaps[r];
    impact.restitution[static_cast<Eigen::Index>(kept)] =
        impact.restitution[static_cast<Eigen::Index>(r)];
    ++kept;
  }
  impact.system.rows.resize(kept);
  impact.pair_of_row.resize(kept);
  impact.gaps.resize(kept);
  impact.restitution.conservativeResize(static_cast<Eigen::Index>(kept));
}

}  // namespace

/// Impacts that are without end between all that touches the seeds, whose states are at `now`, end
/// in what contacts can do by pushing at once. How the last of the impacts would have divided what
/// is left is not known: it is less than what they still hop. What took an impulse has been in
/// contact, and is told so. Where nothing is left to push, what is in touch is settled. False, and
/// nothing has changed, where neither is possible, or it was done too often. `last`: the impact
/// that led here, which was told; after some pushes in a frame it is taken back.
bool EventContacts::end_by_pushing(std::span<const BodyIndex> seeds, double remaining, Instant t,
                                   const Event* last) {
  const double frame = std::floor(t.seconds / run_.mean_frame);
  pushed_ = pushed_in_ == frame ? pushed_ + 1 : 1;
  pushed_in_ = frame;
  if (pushed_ > most_pushes) {
    return false;
  }
  last = pushed_ > few_pushes ? last : nullptr;
  const EventModes::GroupImpact impact = group_before(last, seeds, t);
  const std::optional<Pushes> pushes = pushes_among(impact);
  if (!pushes) {
    return false;
  }
  if (!pushes->some || !pushes->settled) {
    return !pushes->some && settle_stalled(seeds, t);
  }
  if (last != nullptr) {
    take_back(*last);
  }
  const std::vector<BodyIndex> free = give(impact, pushes->swept.velocities, seeds, t);
  book_pushes(impact, *pushes, EnergyLine::zeno_completion);
  std::vector<EventModes::Change> changes;
  for (std::size_t r = 0; r < pushes->touches.size(); ++r) {
    const auto& [a, b] = impact.pairs[impact.pair_of_row[r]];
    const bool told = !changes.empty() && changes.back().a == a && changes.back().b == b;
    if (!pushes->swept.impulse[r].isZero(0.0) && !told && !graph_.joins(a, b)) {
      changes.push_back({EventKind::contact_begins, a, b, Grade::sampled, remaining});
      changes.push_back({EventKind::contact_ends, a, b, Grade::sampled});
    }
  }
  if (!settle(free, t, {.unloaded = true, .may_turn = true})) {
    set_free(free, t);
    modes_.tell(changes, t);
  }
  return true;
}

/// An impact that bodies in touch hand on among each other, of which they return only a part, or
/// nothing, ends in what they can do by pushing at once; each pair that took an impulse is told.
/// Returns the bodies that took part. None, and nothing has changed, where that is not possible,
/// where something is driven, which may squeeze others, or where an end is not near: what
/// approaches does so at this `part` of the speed of the impact, which is much beside what they do
/// not return.
std::vector<BodyIndex> EventContacts::hand_on_at_once(const Event& first,
                                                      std::span<const BodyIndex> bodies,
                                                      double part, Instant t) {
  EventModes::GroupImpact impact = modes_.impact_group(bodies, t, true, true);
  keep_pairs(impact, [&](const BodyPair& pair) {
    return pair == BodyPair{first.a, first.b} || pair == BodyPair{first.b, first.a} ||
           graph_.joins(pair.first, pair.second);
  });
  const bool driven = std::any_of(impact.bodies.begin(), impact.bodies.end(), [&](BodyIndex i) {
    return run_.model.mobility(i) == Mobility::driven;
  });
  if (driven || impact.restitution.size() == 0) {
    return {};
  }
  const double e = impact.restitution.mean();
  if (e > 0.0 && !(part <= nearly_handed_on * (1.0 - e))) {
    return {};
  }
  const std::optional<Pushes> pushes = pushes_among(impact);
  if (!pushes || !pushes->some || !pushes->settled) {
    return {};
  }
  std::vector<BodyIndex> free = give(impact, pushes->swept.velocities, bodies, t);
  book_pushes(impact, *pushes, EnergyLine::restitution_loss);
  std::vector<BodyState> before;
  for (std::size_t k = 0; k < impact.bodies.size(); ++k) {
    before.push_back(motions_.now(impact.bodies[k]));
    before.back().twist = impact.velocities[k];
  }
  Eigen::VectorXd along(impact.restitution.size());
  for (std::size_t r = 0; r < pushes->touches.size(); ++r) {
    along[static_cast<Eigen::Index>(r)] = pushes->touches[r].normal.dot(pushes->swept.impulse[r]);
  }
  Event event = first;
  event.flag = EventFlag::plastic;
  tell_group(impact, along, before, event);
  return free;
}

/// Impulses at all touches of a group at once, after which nothing approaches any more; they are
/// within the cones of friction, and what nobody presses parts as it will [Moreau1988]. None where
/// what is driven moves joints, where belts take part, or nothing touches.
std::optional<EventContacts::Pushes> EventContacts::pushes_among(
    const EventModes::GroupImpact& impact) {
  const bool belts = std::any_of(impact.bodies.begin(), impact.bodies.end(), [&](BodyIndex i) {
    return !run_.model.entity(i).surface_velocity(run_.model.body(i), motions_.now(i)).isZero(0.0);
  });
  const std::shared_ptr<const GroupJoints>& joints = impact.system.joints;
  const bool driven = joints != nullptr && joints->driven();
  if (!impact.refusal.empty() || driven || impact.system.rows.empty() || belts) {
    return std::nullopt;
  }
  Pushes pushes;
  pushes.touches = touches_of(impact, run_.model);
  double fastest = 0.0;
  for (std::size_t k = 0; k < impact.bodies.size(); ++k) {
    pushes.before.push_back(stacked(impact.velocities[k]));
    fastest = std::max(fastest, impact.velocities[k].linear.norm());
  }
  const ContactSweeps sweeps(impact.system.bodies, pushes.touches, joints);
  pushes.swept = sweeps.sweep(pushes.before, {}, {}, settled * fastest, true);
  run_.cost.contact_solves += pushes.swept.solves;
  double pushed = 0.0;
  for (std::size_t k = 0; k < pushes.before.size(); ++k) {
    pushed = std::max(pushed, (pushes.swept.velocities[k] - pushes.before[k]).head<3>().norm());
  }
  pushes.some = pushed > settled * fastest;
  pushes.settled = pushes.swept.changed <= accepted * fastest;
  return pushes;
}

/// All that touches the seeds, as it was before the last impact of a collapse: contacts end there,
/// too, in what they can do by pushing.
EventModes::GroupImpact EventContacts::group_before(const Event* last,
                                                    std::span<const BodyIndex> seeds, Instant t) {
  if (last == nullptr) {
    return modes_.impact_group(seeds, t, true);
  }
  BodyState& a = motions_.now(last->a);
  BodyState& b = motions_.now(last->b);
  const std::pair<Twist, Twist> struck{a.twist, b.twist};
  a.twist = last->before_a.twist;
  b.twist = last->before_b.twist;
  EventModes::GroupImpact impact = modes_.impact_group(seeds, t, true);
  a.twist = struck.first;
  b.twist = struck.second;
  return impact;
}

/// The two of an impact have not struck each other: they are as before, and so are the books.
void EventContacts::take_back(const Event& impact) {
  double gained = 0.0;
  Vector3 push = Vector3::Zero();  // on b
  for (const auto& [i, before, after, sign] :
       {std::tuple{impact.a, &impact.before_a, &impact.after_a, -1.0},
        {impact.b, &impact.before_b, &impact.after_b, 1.0}}) {
    if (run_.model.is_free(i)) {
      BodyState& now = motions_.now(i);
      const BodyState struck = now;
      now.twist = before->twist;
      gained += run_.account.gained(i, struck, now);
      run_.account.struck(i, struck, now);
      push = sign * run_.model.inertia(i).mass * (after->twist.linear - before->twist.linear);
    }
  }
  const Contact& contact = impact.contact;
  const double rates = normal_velocity(contact, impact.before_a, impact.before_b) +
                       normal_velocity(contact, impact.after_a, impact.after_b);
  const bool rubs = run_.model.friction(impact.a, impact.b) > 0.0;
  const double along = rubs ? -0.5 * contact.normal.dot(push) * rates : gained;
  run_.ledger.add(EnergyLine::restitution_loss, along);
  run_.ledger.add(EnergyLine::impact_friction, gained - along);
}

/// Gives the bodies of a group other velocities; returns those that are free.
std::vector<BodyIndex> EventContacts::give(const EventModes::GroupImpact& impact,
                                           const std::vector<Vector6>& velocities,
                                           std::span<const BodyIndex> seeds, Instant t) {
  std::vector<BodyIndex> free;
  for (std::size_t k = 0; k < impact.bodies.size(); ++k) {
    const BodyIndex i = impact.bodies[k];
    if (!run_.model.is_free(i)) {
      continue;
    }
    free.push_back(i);
    const bool known = struck_with(run_.model, seeds, i);
    motions_.book(i, t);
    const BodyState struck = motions_.now(i);
    motions_.bring(i, t);
    BodyState& now = motions_.now(i);
    now = known ? struck : now;
    BodyState from = now;
    from.twist = impact.velocities[k];
    run_.ledger.add(EnergyLine::projection, run_.account.gained(i, now, from));
    now.twist = {velocities[k].head<3>(), velocities[k].tail<3>()};
    run_.account.struck(i, from, now);
  }
  run_.ledger.add(EnergyLine::projection, -impact.driven);
  run_.ledger.add(EnergyLine::driven_work, impact.driven);
  return free;
}

/// What impulses did: p (u- + u+) / 2, along the normals (in this line of the ledger) and across,
/// beside what driven bodies did. Together they never gave. Where one of the two would have given,
/// as friction does by this formula where others turned the slip against it, the other has less.
void EventContacts::book_pushes(const EventModes::GroupImpact& impact, const Pushes& pushes,
                                EnergyLine normal) {
  const ContactSweeps::Swept& swept = pushes.swept;
  double whole = 0.0;
  double across = 0.0;
  for (std::size_t r = 0; r < pushes.touches.size(); ++r) {
    const SweptTouch& touch = pushes.touches[r];
    const Vector3& p = swept.impulse[r];
    const auto at = [&](const Vector6& v, std::size_t k, const Vector3& point) {
      const Vector3 arm = point - impact.system.bodies[k].position;
      return Vector3(v.head<3>() + Vector3(v.tail<3>()).cross(arm));
    };
    const auto slip = [&](const std::vector<Vector6>& v) {
      return Vector3(at(v[touch.b], touch.b, touch.point_b) -
                     at(v[touch.a], touch.a, touch.point_a));
    };
    const Vector3 mean = 0.5 * (slip(pushes.before) + slip(swept.velocities));
    const Vector3 along = touch.normal * touch.normal.dot(p);
    whole += p.dot(mean);
    across += (p - along).dot(mean);
    for (const auto& [k, point, sign] :
         {std::tuple{touch.a, touch.point_a, 1.0}, {touch.b, touch.point_b, -1.0}}) {
      if (run_.model.mobility(impact.bodies[k]) == Mobility::driven) {
        run_.ledger.add(EnergyLine::driven_work, sign * p.dot(at(pushes.before[k], k, point)));
      }
    }
  }
  across = std::min(std::max(across, whole), 0.0);
  run_.ledger.add(normal, whole - across);
  run_.ledger.add(EnergyLine::impact_friction, across);
}

}  // namespace core
}  // namespace kairos
