// `EventModes` where nothing turns: what a few roundoffs and a last hop left is put in order.
#include "core/schemes/event/gathered_group.hpp"
#include "core/schemes/event/turning_group.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

/// Dense systems: so many touches at most.
constexpr std::size_t most_touches = 64;

/// What of a patch is off, m: how far its points are in, and by how much their gaps differ.
struct Off {
  double sunk = 0.0;
  double tilt = 0.0;
  double middle = 0.0;  ///< mean of the gaps
};

Off off_of(const ContactManifold& m) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  double sum = 0.0;
  for (std::size_t k = 0; k < m.size; ++k) {
    least = std::min(least, m.points[k].gap);
    most = std::max(most, m.points[k].gap);
    sum += m.points[k].gap;
  }
  const bool face = m.size > 2;
  return {-least, face ? most - least : 0.0, sum / static_cast<double>(m.size)};
}

}  // namespace

/// Where contact lasts without turning, faces that came to rest by hops are tilted by as much as
/// the last hop, and one that slides over the edge of another would come to be inside of it; and
/// what flies in touch from impact to impact sinks in by a roundoff each time. The gaps that such
/// pairs are to have, m, by pair; NaN: theirs is fine.
std::vector<double> EventModes::better_gaps(const Gathered& found, const FlatMode& mode) const {
  std::vector<double> gaps(found.pairs.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t p = 0; p < found.pairs.size(); ++p) {
    const GroupPatch& patch = found.group.patches[p];
    if (mode.kept[p] == 0 || patch.manifold.size == 0) {
      continue;
    }
    double coordinates = 0.0;
    for (const std::size_t k : {patch.a, patch.b}) {
      const double radius = bounding_radius(run_.model.shape(found.bodies[k]));
      coordinates += found.states[k].pose.position.lpNorm<1>();
      coordinates += std::isfinite(radius) ? radius : 0.0;
    }
    // A gap is a sum of coordinates: four times the bound of its roundoff (ccd/README.md, eq. 11).
    const double hidden = 48.0 * std::numeric_limits<double>::epsilon() * coordinates;
    const Off off = off_of(patch.manifold);
    const bool begins = !graph_.joins(found.pairs[p].first, found.pairs[p].second);
    if (off.sunk > hidden || (begins && off.tilt > hidden)) {
      gaps[p] = std::max(off.middle, 0.0);
    }
  }
  return gaps;
}

/// The group with the poses that have these gaps, moved least as masses measure; `near`: what else
/// is near keeps its gap. Nothing where that is not known, or another body is in the way.
std::optional<EventModes::Gathered> EventModes::at_gaps(const Gathered& found,
                                                        const std::vector<double>& gaps, Instant t,
                                                        SettleOptions options) {
  Gathered all = options.near ? gather(found.bodies, t, options) : found;
  Turning turning;
  if (!all.refusal.empty() || !add_touches(all, t, turning).empty()) {
    return std::nullopt;
  }
  TurningState& start = turning.group.start;
  if (start.touches.size() > most_touches) {
    return std::nullopt;
  }
  for (Touch& touch : start.touches) {
    const auto p = std::find(found.pairs.begin(), found.pairs.end(), all.pairs[touch.pair]);
    const double gap = p != found.pairs.end()
                           ? gaps[static_cast<std::size_t>(p - found.pairs.begin())]
                           : std::max(touch.gap, 0.0);
    touch.gap = std::isnan(gap) ? touch.gap : gap;
  }
  for (std::size_t k = 0; k < all.bodies.size(); ++k) {
    if (!found.has(all.bodies[k])) {
      start.bodies[k] = GroupBody{0.0, Matrix3::Zero(), start.bodies[k].position};
    }
  }
  put_at_gaps(start, std::vector<char>(start.touches.size(), 1));
  const std::vector<BodyState> before = all.states;
  for (std::size_t k = 0; k < all.bodies.size(); ++k) {
    if (moves(start.bodies[k])) {
      all.states[k].pose = start.states[k].pose;
    }
  }
  return has_room(before, all, t) ? std::optional(std::move(all)) : std::nullopt;
}

/// What touches where at other poses: bodies and patches of a group again. Whether all still do.
bool EventModes::touches_again(Gathered& found) const {
  for (std::size_t k = 0; k < found.bodies.size(); ++k) {
    found.group.bodies[k] = group_body(run_.model.inertia(found.bodies[k]), found.states[k].pose);
  }
  bool all = true;
  for (std::size_t p = 0; p < found.pairs.size(); ++p) {
    const auto& [a, b] = found.pairs[p];
    GroupPatch& patch = found.group.patches[p];
    patch.manifold =
        run_.detector.manifold(run_.model.shape(a), found.states[patch.a].pose, run_.model.shape(b),
                               found.states[patch.b].pose, predictor_.touching_gap(a, b));
    all = all && patch.manifold.size > 0;
  }
  return all;
}

/// Moves bodies so that faces are parallel and nothing is inside of another, and finds the mode
/// that goes on along these faces. What that does to the energy is `position_correction`. Nothing
/// changes where another mode would.
void EventModes::put_in_order(Gathered& found, FlatMode& mode, Instant t, SettleOptions options) {
  const std::vector<double> gaps = better_gaps(found, mode);
  if (std::all_of(gaps.begin(), gaps.end(), [](double gap) { return std::isnan(gap); })) {
    return;
  }
  options.near = false;
  std::optional<Gathered> better = at_gaps(found, gaps, t, options);
  if (!better) {
    options.near = true;
    better = at_gaps(found, gaps, t, options);
  }
  if (!better) {
    return;
  }
  Gathered straight = found;
  for (std::size_t k = 0; k < found.bodies.size(); ++k) {
    if (run_.model.is_free(found.bodies[k])) {
      straight.states[k].pose = better->states[better->place(found.bodies[k])].pose;
    }
  }
  if (!touches_again(straight)) {
    return;
  }
  FlatMode along = contact_mode(straight.group, {options.unloaded, options.unite});
  if (!along.refusal.empty() || along.curved || along.kept != mode.kept) {
    return;
  }
  for (std::size_t k = 0; k < found.bodies.size(); ++k) {
    const BodyIndex i = found.bodies[k];
    if (run_.model.is_free(i)) {
      const BodyState& is = straight.states[k];
      run_.account.moved(i, is.pose.position - found.states[k].pose.position);
      run_.ledger.add(EnergyLine::position_correction, run_.account.gained(i, found.states[k], is));
    }
  }
  found = std::move(straight);
  mode = std::move(along);
}

}  // namespace core
}  // namespace kairos
