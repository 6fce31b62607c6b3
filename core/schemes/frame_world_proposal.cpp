#include "core/schemes/frame_world.hpp"

#include <algorithm>
#include <utility>

// Where everything would go, for the schemes that look before they leap.

namespace kairos {
inline namespace core {

void FrameWorld::propose(double h) {
  record_fields_left();
  proposed_ = h;
  for (Mover& mover : movers_) {
    if (mover.carried) {
      continue;
    }
    gather(mover);
    mover.booked = mover.states;
    mover.booked_until = 0.0;
    for (const BodyIndex i : mover.island.bodies) {
      paths_[i].clear();
    }
    fly(mover, 0.0, h);
  }
  for (const BodyIndex i : driven_) {
    paths_[i].clear();
    for (double done = 0.0; done < h; done += paths_[i].back().duration) {
      paths_[i].push_back(model_.body(i).drive->motion(now_ + done, h - done));
    }
  }
  for (const auto& [hand, held] : model_.grips()) {
    if (movers_[model_.island_of(held)].carried) {
      paths_[held] = paths_[hand];
    }
  }
}

/// Extends the paths of an island from `from` to `to` of the proposal.
void FrameWorld::fly(Mover& mover, double from, double to) {
  begin_step(mover, now_ + from);
  for (double done = from; done < to;) {
    if (!step(mover, done, to)) {
      return;
    }
    mover.stepper->dense_output(mover.motions);
    for (std::size_t k = 0; k < mover.motions.size(); ++k) {
      paths_[mover.island.bodies[k]].push_back(mover.motions[k]);
    }
  }
}

const Motion& FrameWorld::path_motion(BodyIndex i, double s) const {
  const std::vector<Motion>& path = paths_[i];
  // A stiff force makes many motions of one frame: they are not searched one by one.
  const auto after = std::partition_point(
      path.begin() + 1, path.end(), [&](const Motion& motion) { return motion.start - now_ <= s; });
  return *(after - 1);
}

BodyState FrameWorld::on_path(BodyIndex i, double s) const {
  if (paths_[i].empty()) {
    return bodies_[i];
  }
  const Motion& motion = path_motion(i, s);
  const double local = std::min((now_ - motion.start) + s, motion.duration);
  return {motion.pose(local), motion.twist(local)};
}

double FrameWorld::common_stretch(BodyIndex a, BodyIndex b, double s, double until) const {
  const auto left = [&](BodyIndex i) { return path_motion(i, s).end() - (now_ + s); };
  return std::min({left(a), left(b), until - s});
}

double FrameWorld::largest_movement() const {
  double largest = 0.0;
  for (BodyIndex i = 0; i < size(); ++i) {
    if (movable(i)) {
      const Vector3 there = on_path(i, proposed_).pose.position;
      largest = std::max(largest, (there - bodies_[i].pose.position).norm());
    }
  }
  return largest;
}

void FrameWorld::accept(double s) {
  const bool whole = s >= proposed_;
  for (Mover& mover : movers_) {
    if (mover.carried) {
      continue;
    }
    book_path(mover, s);
    for (std::size_t k = 0; k < mover.states.size(); ++k) {
      const BodyIndex i = mover.island.bodies[k];
      bodies_[i] = whole ? mover.states[k] : on_path(i, s);
    }
    mover.jumped = mover.jumped || !whole;
  }
  end_step(s);
}

/// The ledger follows an island along its path up to `until` of the proposal.
void FrameWorld::book_path(Mover& mover, double until) {
  const BodyIndex first = mover.island.bodies.front();
  std::vector<BodyState>& to = mover.reached;
  to.resize(mover.states.size());
  while (mover.booked_until < until) {
    const double from = mover.booked_until;
    double end = from + common_stretch(first, first, from, until);
    if (!(end > from)) {
      end = until;  // what rounding left between the last motion and `until`
    }
    const bool at_end = end >= proposed_;
    // Only the stepper's last step can be replayed, and only from where it began.
    const bool replayable = path_motion(first, from).start == paths_[first].back().start &&
                            paths_[first].back().start == now_ + from;
    for (std::size_t k = 0; k < to.size(); ++k) {
      const BodyIndex i = mover.island.bodies[k];
      mover.motions[k] = path_motion(i, from);
      mover.motions[k].duration =
          std::min(mover.motions[k].duration, end - (mover.motions[k].start - now_));
      to[k] = at_end ? mover.states[k] : on_path(i, end);
      bodies_[i] = mover.booked[k];
    }
    std::swap(to, mover.states);
    book_step(mover, now_ + from, end - from, replayable);
    std::swap(to, mover.states);
    mover.booked = to;
    mover.booked_until = end;
  }
}

void FrameWorld::cut_path(BodyIndex i, double s) {
  std::vector<Motion>& path = paths_[i];
  while (path.size() > 1 && path.back().start - now_ >= s) {
    path.pop_back();
  }
  path.back().duration = std::min(path.back().duration, s - (path.back().start - now_));
}

void FrameWorld::bend(BodyIndex a, BodyIndex b, double s) {
  // The islands of both are brought to s, handled there, and sent on.
  std::vector<Mover*> bent;
  for (const BodyIndex i : {a, b}) {
    if (model_.is_free(i)) {
      Mover* mover = &movers_[model_.island_of(i)];
      if (bent.empty() || bent.front() != mover) {
        bent.push_back(mover);
      }
    }
  }
  const State present = bodies_;
  for (const BodyIndex i : {a, b}) {
    bodies_[i] = on_path(i, s);
    if (model_.mobility(i) == Mobility::driven) {
      bodies_[i].twist.linear = present[i].twist.linear;  // what the tracker said last
    }
  }
  State meeting = bodies_;
  for (Mover* mover : bent) {
    for (const BodyIndex i : mover->island.bodies) {
      meeting[i] = on_path(i, s);
    }
    book_path(*mover, s);
    for (const BodyIndex i : mover->island.bodies) {
      cut_path(i, s);
    }
  }
  collide(a, b, meeting[a], meeting[b], now_ + s);
  for (Mover* mover : bent) {
    for (std::size_t k = 0; k < mover->states.size(); ++k) {
      mover->states[k] = meeting[mover->island.bodies[k]];
    }
    mover->booked = mover->states;
    mover->booked_until = s;
    if (s < proposed_) {
      fly(*mover, s, proposed_);
    }
  }
  bodies_ = present;
}

TimeOfImpact FrameWorld::time_of_impact(BodyIndex a, BodyIndex b, double until) {
  TimeOfImpact answer;
  int evaluations = 0;
  for (double s = 0.0; s < until;) {
    const double length = std::max(common_stretch(a, b, s, until), 0.0);
    ++cost_.toi_queries;
    answer = detector_.time_of_impact({model_.shape(a), path_motion(a, s)},
                                      {model_.shape(b), path_motion(b, s)}, {now_ + s, length},
                                      options_.toi_tolerance);
    evaluations += answer.evaluations;
    answer.t_lo += s;
    answer.t_hi += s;
    if (answer.status != ToiStatus::separated || !(s + length > s)) {
      break;
    }
    s += length;
  }
  answer.evaluations = evaluations;
  cost_.toi_evaluations += evaluations;
  return answer;
}

bool FrameWorld::swept_overlap(BodyIndex a, BodyIndex b) {
  if (grasps_.involve(a, b)) {
    return false;
  }
  for (double s = 0.0; s < proposed_;) {
    const double length = std::max(common_stretch(a, b, s, proposed_), 0.0);
    ++cost_.overlap_tests;
    if (detector_.swept_overlap({model_.shape(a), path_motion(a, s)},
                                {model_.shape(b), path_motion(b, s)}, {now_ + s, length})) {
      return true;
    }
    if (!(s + length > s)) {
      break;
    }
    s += length;
  }
  return false;
}

bool FrameWorld::overlap_at(BodyIndex a, BodyIndex b, double s) {
  if (grasps_.involve(a, b)) {
    return false;
  }
  ++cost_.overlap_tests;
  return detector_.overlaps(model_.shape(a), on_path(a, s).pose, model_.shape(b),
                            on_path(b, s).pose);
}

}  // namespace core
}  // namespace kairos
