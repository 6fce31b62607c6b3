// What `EventModes` does with groups that turn where forces at an instant are not known: steps that
// are implicit.
#include "core/contacts/implicit_mode.hpp"
#include "core/schemes/event/gathered_group.hpp"
#include "core/schemes/event/turning_group.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

/// A body that turns has so many steps in a frame at most in which forces are those of an instant.
constexpr int most_exact_steps = 150;
/// The same of what hangs on joints, which a step costs several times as much.
constexpr int most_exact_on_joints = 100;
/// An implicit step takes this part of a frame at most, and so many follow each other before forces
/// at an instant are looked for again: twice as many each time that there are none.
constexpr double implicit_part = 1.0 / 16.0;
/// The same of few touches: these steps cost little there.
constexpr double part_of_few = 1.0 / 128.0;
constexpr std::size_t few_touches = 4;
constexpr int first_stretch = 16;
constexpr int longest_stretch = 1024;
/// So often an implicit step is corrected at most.
constexpr int most_corrections = 2;
constexpr int most_halvings = 30;
/// Where impulses of a step are not found, those of one half as long may be: so often.
constexpr int most_refused = 4;
/// Where contacts give energy, impulses are found for the step as it was cut off before they would
/// have taken it, or for half of it: so often.
constexpr int most_cuts = 6;
/// What ends a step after less than this part of it strikes at once.
constexpr double least_part = 1e-9;

/// How far velocities at the end of an implicit step are from what its impulses were found for,
/// m/s, at most, of what is held.
double most_missed(const TurningMode& mode, const TurningStep& step) {
  double most = 0.0;
  for (std::size_t k = 0; k < mode.choices.size(); ++k) {
    if (mode.choices[k].does != FrictionChoice::Does::opens) {
      most = std::max(most, (step.reached[k] - mode.foreseen[k]).norm());
    }
  }
  return most;
}

/// What contacts give the group in a step, beside what belts do, J.
double given(const TurningStep& step) {
  double work = 0.0;
  for (const Polynomial<3>& leaked : step.leaked) {
    work += leaked(step.duration).x();
  }
  for (const Polynomial<3>& rubbed : step.rubbed) {
    work += rubbed(step.duration).x();
  }
  return work;
}

/// Whether something gives the group energy through what touches: a drive or a belt.
bool something_drives(const TurningGroup& group) {
  return !group.drivers.empty() ||
         std::any_of(group.start.touches.begin(), group.start.touches.end(),
                     [](const Touch& touch) { return !touch.belt.isZero(0.0); });
}

}  // namespace

/// Whether forces are not even looked for: there were none lately, or too many bodies turn, or what
/// slides makes steps too short.
bool EventModes::goes_on_implicitly(const Gathered& found, Instant t) const {
  const double frame = std::floor(t.seconds / run_.mean_frame);
  const int most_exact = has_joints(found) ? most_exact_on_joints : most_exact_steps;
  const auto free = std::count_if(found.bodies.begin(), found.bodies.end(),
                                  [&](BodyIndex i) { return run_.model.is_free(i); });
  return free > TurningLimits::most_bodies ||
         short_steps(found) >= TurningLimits::few_short_steps || implicit_steps(found).first > 0 ||
         std::any_of(found.bodies.begin(), found.bodies.end(), [&](BodyIndex i) {
           return has_turned_[i].frame == frame && has_turned_[i].steps >= most_exact;
         });
}

/// Of the pairs of a group, the most: implicit steps that are left, and those made last.
std::pair<int, int> EventModes::implicit_steps(const Gathered& found) const {
  std::pair<int, int> most{0, 0};
  for (const auto& [a, b] : found.pairs) {
    if (const Patch* const patch = graph_.find(a, b)) {
      most.first = std::max(most.first, patch->implicit_steps);
      most.second = std::max(most.second, patch->stretch);
    }
  }
  return most;
}

/// Steps over what forces at an instant are not known of: with forces that act all through a step,
/// which is as short as it takes to keep gaps. False, and why not, where none is.
bool EventModes::step_over(const Gathered& found, Turning& turning, Instant t,
                           const SettleOptions& asked) {
  turning.all = asked.step_over;
  const std::string exactly = turning.mode.refusal;
  std::vector<Vector3> warm;
  for (const Touch& touch : turning.group.start.touches) {
    const auto& [a, b] = found.pairs[touch.pair];
    const Patch* const patch = graph_.find(a, b);
    const std::size_t point = touch.point;
    warm.push_back(patch != nullptr && point < patch->force.size() ? patch->force[point]
                                                                   : Vector3(Vector3::Zero()));
  }
  const double frame = run_.options.step > 0.0 ? run_.options.step : run_.mean_frame;
  const double before = implicit_steps(found).second > 0 ? next_step(found) : frame;
  const bool few = turning.group.start.touches.size() <= few_touches;
  double h =
      std::min({(few ? part_of_few : implicit_part) * frame, given_until(turning) - t, before});
  int refused = 0;
  int cuts = 0;
  double tried = 0.0;
  std::optional<std::pair<TurningMode, TurningStep>> gave;  // one in which contacts give energy
  for (int round = 0; round < most_halvings; ++round, h *= 0.5) {
    turning.mode = implicit_mode(turning.group.start, h, warm, asked.last_resort,
                                 asked.last_resort ? 0 : halvings(found, t, &Turned::unsettled));
    count_in_vain(found, turning, t, &Turned::unsettled);
    turning.mode.keeps_all = turning.all;
    run_.cost.contact_solves += turning.mode.solves;
    if (gave && (!turning.mode.refusal.empty() || turning.mode.flies)) {
      break;
    }
    if (!turning.mode.refusal.empty()) {
      if (++refused > most_refused) {
        break;
      }
      continue;
    }
    if (turning.mode.flies && !turning.all) {
      return true;
    }
    const std::unique_ptr<Stepper> stepper = stepper_(h);
    turning.step = turning_step(turning.group, turning.mode, *stepper, t, h);
    if (turning.step.refusal.empty() && turning.step.stepped < h) {
      h = 2.0 * turning.step.stepped;  // impulses are those of a step that is so long
      continue;
    }
    if (few || something_drives(turning.group)) {
      correct(turning, t, h, asked);
    }
    const bool made = turning.step.refusal.empty() && turning.step.duration > least_part * h;
    const bool parts = made && h > least_part * frame && !ends_in_touch(found, turning);
    const bool found_one = made && !parts && short_steps(found) <= TurningLimits::most_short_steps;
    if (!found_one) {
      if (gave) {
        break;
      }
      continue;
    }
    // How long the next step may be, that of this one tells which was not yet shortened for it.
    tried = std::max(tried, turning.step.stepped);
    turning.step.stepped = tried;
    turning.step.halved = turning.step.halved || round > cuts;
    // What strikes has to be met within a step, not just after its end.
    const double end = turning.step.duration;
    const bool may_be_shorter = end == h || 2.0 * end < h;
    const bool gives = turning.mode.gives && given(turning.step) > turning.mode.nothing;
    if (!gives || !may_be_shorter || cuts == most_cuts) {
      return true;
    }
    gave.emplace(turning.mode, turning.step);
    ++cuts;
    h = end == h ? h : 4.0 * end;
  }
  if (gave) {
    std::tie(turning.mode, turning.step) = std::move(*gave);
    return true;
  }
  why_not_ = exactly.empty() ? turning.mode.refusal : exactly;
  if (why_not_.empty()) {
    why_not_ = "a corner of a body in touch is to strike at once";
  }
  return false;
}

/// Looks again for impulses of an implicit step where the motions that follow from them end with
/// other velocities than those that they were sought for: where bodies are, and what drives them,
/// is taken at the start of the step. With what was missed made good the step is of second order
/// but for touches that begin or end to stick in it. Where nothing drives, what is missed costs
/// energy as its square only.
void EventModes::correct(Turning& turning, Instant t, double h, const SettleOptions& asked) {
  const auto& touches = turning.group.start.touches;
  std::vector<Vector3> missed(touches.size(), Vector3::Zero());
  for (int round = 0; round < most_corrections && turning.step.refusal.empty(); ++round) {
    const double before = most_missed(turning.mode, turning.step);
    for (std::size_t k = 0; k < touches.size(); ++k) {
      missed[k] += turning.step.reached[k] - turning.mode.foreseen[k];
    }
    TurningMode next = implicit_mode(turning.group.start, h, turning.mode.forces.force,
                                     asked.last_resort, 0, missed);
    run_.cost.contact_solves += next.solves;
    if (!next.refusal.empty()) {
      return;
    }
    next.keeps_all = turning.all;
    const std::unique_ptr<Stepper> stepper = stepper_(h);
    TurningStep step = turning_step(turning.group, next, *stepper, t, h);
    if (!step.refusal.empty() || step.stepped < h || !(step.duration > least_part * h) ||
        !(most_missed(next, step) < before)) {
      return;
    }
    turning.mode = std::move(next);
    turning.step = std::move(step);
  }
}

/// How a pair goes on stepping over what forces are not known of: a stretch of such steps begins,
/// or goes on; `left` of it there were.
void EventModes::count_implicit(const Turning& turning, const std::pair<int, int>& left,
                                bool is_short, Patch& patch) {
  if (!turning.mode.implicit) {
    patch.stretch = is_short ? left.second : 0;
    patch.implicit_steps = 0;
    return;
  }
  const bool begins = left.first == 0;
  patch.stretch = !begins           ? left.second
                  : left.second > 0 ? std::min(2 * left.second, longest_stretch)
                                    : first_stretch;
  patch.implicit_steps = begins ? patch.stretch - 1 : left.first - 1;
}

/// The next implicit step begins its search with the forces of this one.
void EventModes::keep_forces(const Gathered& found, const Turning& turning) {
  for (std::size_t p = 0; p < found.pairs.size(); ++p) {
    if (Patch* const patch = graph_.find(found.pairs[p].first, found.pairs[p].second)) {
      patch->force.assign(found.group.patches[p].manifold.size, Vector3::Zero());
    }
  }
  for (std::size_t k = 0; k < turning.group.start.touches.size(); ++k) {
    const Touch& touch = turning.group.start.touches[k];
    Patch* const patch = graph_.find(found.pairs[touch.pair].first, found.pairs[touch.pair].second);
    if (patch != nullptr) {
      patch->force.resize(std::max(patch->force.size(), touch.point + 1), Vector3::Zero());
      patch->force[touch.point] = turning.mode.forces.force[k];
    }
  }
}

}  // namespace core
}  // namespace kairos
