// Where bodies that turn are too near to what they touch for their gaps to be held, `EventModes`
// makes these larger.
#include "core/schemes/event/gathered_group.hpp"
#include "core/schemes/event/turning_group.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace kairos {
inline namespace core {
namespace {

/// What touches, and has been made to touch less, is no further away than this times what touches.
constexpr double nearly_touching = 1.25;

/// What comes nearer than this strikes, m, of two bodies or of their pieces.
double nearest_of(const TurningGroup& group, std::size_t p) {
  return std::find_if(group.pairs.begin(), group.pairs.end(),
                      [p](const TurningPair& pair) { return pair.of == p; })
      ->nearest;
}

}  // namespace

/// Gathers what touches, with gaps that can be held. Where that brings one nearer to what passes
/// by, this makes way, too; and where that does not help, gaps may be larger than they need to be,
/// and what is near without a touch keeps clear: again from where that led, as corners may have
/// come to touch elsewhere.
bool EventModes::make_room(std::span<const BodyIndex> seeds, Instant t, SettleOptions options,
                           Gathered& found, Turning& turning) {
  std::vector<std::pair<BodyIndex, BodyState>> was;
  std::vector<std::pair<BodyIndex, BodyState>> moved;
  for (const auto& [near, at_least] :
       {std::pair{false, false}, {true, false}, {true, true}, {true, true}, {true, true}}) {
    options.near = near;
    options.far = at_least;
    options.moved = moved;
    found = gather(seeds, t, options);
    turning = {};
    why_not_ = found.refusal.empty() ? why_not_turn(found, t) : found.refusal;
    if (why_not_.empty()) {
      why_not_ = add_touches(found, t, turning);
    }
    if (!why_not_.empty()) {
      return false;
    }
    std::vector<BodyState> before = found.states;
    for (std::size_t k = 0; k < before.size(); ++k) {
      const auto first = std::find_if(was.begin(), was.end(),
                                      [&](const auto& of) { return of.first == found.bodies[k]; });
      before[k] = first != was.end() ? first->second : before[k];
    }
    lift(found, turning, t, at_least);
    if (has_room(before, found, t)) {
      return true;
    }
    was.clear();
    moved.clear();
    for (std::size_t k = 0; at_least && k < before.size(); ++k) {
      was.emplace_back(found.bodies[k], before[k]);
      moved.emplace_back(found.bodies[k], found.states[k]);
    }
  }
  why_not_ = "a body turns, and another is too near to it";
  return false;
}

/// Gaps that are too small to be held are made larger, `at_least`: maybe others, too; then touches
/// are those alone that are at rest along their normals.
void EventModes::lift(Gathered& found, Turning& turning, Instant t, bool at_least) {
  TurningState& start = turning.group.start;
  raise(found, turning, t, at_least);
  std::erase_if(start.touches, [&](const Touch& touch) {
    const TouchNow now = look_at(touch, start.states[touch.a], start.states[touch.b]);
    const double touching = predictor_.touching_gap(found.bodies[touch.a], found.bodies[touch.b]);
    return found.passes[touch.pair] != 0 || now.gap > nearly_touching * touching ||
           std::abs(now.normal.dot(now.velocity)) > found.group.patches[touch.pair].rest_speed;
  });
}

/// Where touches are held along a normal that is not the one by which their bodies are apart: along
/// that.
std::vector<Clearance> EventModes::beside_touches(const Gathered& found,
                                                  const TurningGroup& group) const {
  constexpr double same = 1e-6;
  std::vector<Clearance> others;
  for (std::size_t p = 0; p < found.pairs.size(); ++p) {
    const GroupPatch& patch = found.group.patches[p];
    const auto& [a, b] = found.pairs[p];
    const Overlap o = run_.detector.overlap(run_.model.shape(a), found.states[patch.a].pose,
                                            run_.model.shape(b), found.states[patch.b].pose);
    if ((o.normal - patch.manifold.normal).norm() > same) {
      const double nearest = nearest_of(group, p);
      const double missing = found.passes[p] != 0    ? std::max(-o.gap, 0.0)
                             : o.gap < 0.5 * nearest ? nearest - o.gap
                                                     : 0.0;
      others.push_back({patch.a, patch.b, o.point, o.normal, missing});
    }
  }
  return others;
}

void EventModes::raise(Gathered& found, Turning& turning, Instant t, bool at_least) {
  TurningState& start = turning.group.start;
  const std::vector<char> all(start.touches.size(), 1);
  std::vector<double> missing(found.pairs.size(), 0.0);
  for (Touch& touch : start.touches) {
    const double nearest = turning.group.pairs[touch.watched].nearest;
    if (found.passes[touch.pair] != 0) {
      touch.gap = std::max(touch.gap, 0.0);
    } else if (touch.gap < 0.5 * nearest) {
      missing[touch.pair] = std::max(missing[touch.pair], nearest - touch.gap);
    }
  }
  if (std::all_of(missing.begin(), missing.end(), [](double x) { return x == 0.0; })) {
    return;
  }
  for (Touch& touch : start.touches) {
    touch.gap += missing[touch.pair];
  }
  if (!at_least || !put_clear(start, beside_touches(found, turning.group))) {
    put_at_gaps(start, all);
  }
  for (Touch& touch : start.touches) {
    touch.gap = look_at(touch, start.states[touch.a], start.states[touch.b]).gap;
  }
  for (std::size_t k = 0; k < found.bodies.size(); ++k) {
    if (run_.model.is_free(found.bodies[k])) {
      found.states[k].pose = start.states[k].pose;
      start.bodies[k] = group_body(turning.group.inertia[k], start.states[k].pose);
    }
  }
  start.joints = group_joints(turning.group.mechanisms, t, start.states);
}

/// Whether bodies whose gaps were made larger stay clear of all others: those of the group, too,
/// that they do not rest on.
bool EventModes::has_room(std::span<const BodyState> before, const Gathered& found, Instant t) {
  std::vector<Neighbour> near;
  for (std::size_t k = 0; k < found.bodies.size(); ++k) {
    const BodyIndex i = found.bodies[k];
    const Pose& was = before[k].pose;
    const Pose& is = found.states[k].pose;
    if (!run_.model.is_free(i) ||
        (was.position == is.position && was.orientation.coeffs() == is.orientation.coeffs())) {
      continue;
    }
    near.clear();
    predictor_.solids_near(i, near);
    for (const auto& [j, image] : near) {
      const std::size_t place = found.place(j);
      const bool here = place < found.bodies.size();
      Pose other_was = here ? before[place].pose : motions_.at(j, t).pose;
      Pose other_is = here ? found.states[place].pose : other_was;
      if (const auto& box = run_.model.scene().periodic) {
        other_was.position += box->shift(image);
        other_is.position += box->shift(image);
      }
      const Shape& own = run_.model.shape(i);
      const Shape& other = run_.model.shape(j);
      const double gap = run_.detector.overlap(own, is, other, other_is).gap;
      if (gap < 0.0 && gap < run_.detector.overlap(own, was, other, other_was).gap) {
        return false;
      }
    }
  }
  return true;
}

/// What gaps that were made larger did to the energy.
void EventModes::book_lift(const Gathered& found, Instant t) {
  for (const BodyIndex first : found.bodies) {
    const Island* const island =
        run_.model.is_free(first) ? &run_.model.islands()[run_.model.island_of(first)] : nullptr;
    if (island == nullptr || island->bodies.front() != first) {
      continue;
    }
    motions_.book(first, t);
    std::vector<BodyState> before;
    std::vector<BodyState> after;
    for (const BodyIndex i : island->bodies) {
      after.push_back(found.states[found.place(i)]);
      // What it was is asked of its motion: `now` may have been drawn since it was brought.
      before.push_back(after.back());
      before.back().pose = motions_.at(i, t).pose;
    }
    run_.account.moved(*island, t, before, after);
    for (std::size_t k = 0; k < before.size(); ++k) {
      run_.ledger.add(EnergyLine::position_correction,
                      run_.account.gained(island->bodies[k], before[k], after[k]));
    }
  }
}

}  // namespace core
}  // namespace kairos
