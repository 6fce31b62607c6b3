// What `EventModes` counts of bodies that turn while they touch: steps, and searches in vain.
#include "core/archive.hpp"
#include "core/schemes/event/gathered_group.hpp"
#include "core/schemes/event/turning_group.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {

/// Whether one of these has turned while it touched, now or before.
bool EventModes::has_turned(std::span<const BodyIndex> bodies) const {
  return std::any_of(bodies.begin(), bodies.end(),
                     [&](BodyIndex i) { return has_turned_[i].once; });
}

/// Of a group in which meshes or compounds turn, how often something has in the frame of `t`.
int EventModes::pieces_turned(const Gathered& found, Instant t) const {
  const double frame = std::floor(t.seconds / run_.mean_frame);
  int most = 0;
  bool of_pieces = false;
  for (const BodyIndex i : found.bodies) {
    of_pieces = of_pieces || has_parts(i);
    most = has_turned_[i].frame == frame ? std::max(most, has_turned_[i].steps) : most;
  }
  return of_pieces ? most : 0;
}

/// Why these are not even tried: there are too many of them, or they have had their share of work.
std::string EventModes::why_not_turn(const Gathered& found, Instant t) const {
  const auto free = std::count_if(found.bodies.begin(), found.bodies.end(),
                                  [&](BodyIndex i) { return run_.model.is_free(i); });
  if (free > TurningLimits::most_bodies && has_joints(found)) {
    return fmt::format("more than {} bodies on joints that touch each other turn",
                       TurningLimits::most_bodies);
  }
  const double frame = std::floor(t.seconds / run_.mean_frame);
  for (const BodyIndex i : found.bodies) {
    if (has_turned_[i].frame == frame && has_turned_[i].steps >= TurningLimits::most_steps) {
      return fmt::format("'{}', which turns, takes more than {} steps in a frame",
                         run_.model.body(i).name, TurningLimits::most_steps);
    }
  }
  return {};
}

/// What is counted of a body in the frame of `t`.
EventModes::Turned& EventModes::turned_in_frame(BodyIndex i, Instant t) {
  Turned& turned = has_turned_[i];
  const double frame = std::floor(t.seconds / run_.mean_frame);
  if (turned.frame != frame) {
    turned = {.once = turned.once, .frame = frame};
  }
  return turned;
}

void EventModes::count_step(const Gathered& found, Instant t) {
  for (const BodyIndex i : found.bodies) {
    if (run_.model.is_free(i)) {
      Turned& turned = turned_in_frame(i, t);
      turned.once = true;
      ++turned.steps;
    }
  }
}

/// Where nothing is found, again and again, each search takes half as long as the one before.
void EventModes::count_in_vain(const Gathered& found, const Turning& turning, Instant t,
                               int Turned::*what) {
  for (const BodyIndex i : found.bodies) {
    if (run_.model.is_free(i)) {
      int& in_vain = turned_in_frame(i, t).*what;
      in_vain = turning.mode.refusal.empty() ? 0 : in_vain + 1;
    }
  }
}

/// How many times the longest search for forces of a group is halved.
int EventModes::halvings(const Gathered& found, Instant t, int Turned::*what) {
  int most = 0;
  for (const BodyIndex i : found.bodies) {
    if (run_.model.is_free(i)) {
      most = std::max(most, turned_in_frame(i, t).*what);
    }
  }
  return std::min(most, TurningLimits::most_halvings);
}

void EventModes::Turned::persist(Archive& archive) {
  archive(once, frame, steps, in_vain, unsettled);
}
void EventModes::persist(Archive& archive) {
  archive(has_turned_);
  archive.require(has_turned_.size() == run_.model.size());
}

/// Whether some of these have turned while they touch.
bool EventModes::turned(std::span<const BodyIndex> bodies) {
  return std::any_of(bodies.begin(), bodies.end(), [&](BodyIndex i) {
    const auto& partners = graph_.partners(i);
    return std::any_of(partners.begin(), partners.end(),
                       [&](BodyIndex j) { return graph_.find(i, j)->turns; });
  });
}

/// How many steps of a group in a row got nowhere.
int EventModes::short_steps(const Gathered& found) const {
  int most = 0;
  for (const auto& [a, b] : found.pairs) {
    const Patch* const patch = graph_.find(a, b);
    most = std::max(most, patch != nullptr ? patch->short_steps : 0);
  }
  return most;
}

/// How long the next step of a group may be, as its last ones tell, s.
double EventModes::next_step(const Gathered& found) {
  double longest = std::numeric_limits<double>::infinity();
  for (const auto& [a, b] : found.pairs) {
    const Patch* const patch = graph_.find(a, b);
    if (patch != nullptr && patch->step > 0.0) {
      longest = std::min(longest, patch->step);
    }
  }
  return longest;
}

}  // namespace core
}  // namespace kairos
