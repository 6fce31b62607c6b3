#include "core/schemes/frame/frame_world.hpp"

#include "core/archive.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace kairos {
inline namespace core {

FrameWorld::FrameWorld(const Model& model, const Method& method, const SchemeOptions& options,
                       Recorder& recorder)
    : run_(model, method, options, recorder),
      grasps_(model),
      motions_(run_, method),
      contacts_(run_, motions_),
      hands_(run_, motions_, grasps_),
      clock_(run_.options),
      resumed_(!options.resume.empty()) {
  if (resumed_) {
    Archive archive(run_.options.resume);
    persist(archive);
  } else {
    hands_.follow();
  }
}

bool FrameWorld::draw() {
  if (!resumed_) {
    motions_.check_finite();
    run_.account.balance(run_.time, run_.bodies);
    trace(Stage::draw, 1.0);
    run_.recorder.frame({clock_.index(), run_.time, run_.bodies, run_.ledger, grasps_.in_hand()});
    ++run_.cost.frames;
  }
  clock_.look(run_.time);
  if (clock_.whole() && !resumed_ && !run_.stopped()) {
    run_.offer_checkpoint(clock_.last(), [this](Archive& archive) { persist(archive); });
  }
  resumed_ = false;
  return !run_.stopped() && clock_.advance();
}

RunResult FrameWorld::result() && {
  run_.cost.right_hand_sides += motions_.evaluations();
  return std::move(run_).result(std::move(run_.bodies));
}

void FrameWorld::advance(double h) {
  contacts_.tell_fields_left();
  motions_.advance(h);
  hands_.follow();
  run_.forget_given_forces();
}

// --- Proposals ---------------------------------------------------------------------------------

void FrameWorld::propose(double h) {
  contacts_.tell_fields_left();
  motions_.propose(h);
}

double FrameWorld::largest_movement() const {
  double largest = 0.0;
  for (BodyIndex i = 0; i < size(); ++i) {
    if (movable(i)) {
      const Vector3 there = motions_.on_path(i, motions_.proposed()).pose.position;
      largest = std::max(largest, (there - run_.bodies[i].pose.position).norm());
    }
  }
  return largest;
}

void FrameWorld::accept(double s) {
  motions_.accept(s);
  run_.tell_held_events();
  hands_.follow();
  run_.forget_given_forces();
}

void FrameWorld::bend(BodyIndex a, BodyIndex b, double s) {
  run_.hold_events();
  const bool both = run_.model.is_free(a) && run_.model.is_free(b) &&
                    run_.model.island_of(a) != run_.model.island_of(b);
  const auto for_each_island = [&](const auto& act) {
    if (run_.model.is_free(a)) {
      act(a);
    }
    if (run_.model.is_free(b) && (both || !run_.model.is_free(a))) {
      act(b);
    }
  };
  State meeting = run_.bodies;
  for (const BodyIndex i : {a, b}) {
    meeting[i] = motions_.on_path(i, s);
    if (run_.model.mobility(i) == Mobility::driven) {
      meeting[i].twist.linear = run_.bodies[i].twist.linear;  // what the tracker said last
    }
  }
  for_each_island([&](BodyIndex i) {
    for (const BodyIndex k : run_.model.islands()[run_.model.island_of(i)].bodies) {
      meeting[k] = motions_.on_path(k, s);
    }
    motions_.cut(i, s);
  });
  contacts_.handle(a, b, meeting[a], meeting[b], run_.time + s);
  for_each_island([&](BodyIndex i) { motions_.fly_on(i, s, meeting); });
}

TimeOfImpact FrameWorld::time_of_impact(BodyIndex a, BodyIndex b, double until) {
  TimeOfImpact answer;
  int evaluations = 0;
  for (double s = settled_until(a, b); s < until;) {
    const double length = std::max(motions_.common_stretch(a, b, s, until), 0.0);
    ++run_.cost.toi_queries;
    answer = run_.detector.time_of_impact({run_.model.shape(a), motions_.path_motion(a, s)},
                                          {run_.model.shape(b), motions_.path_motion(b, s)},
                                          {run_.time + s, length}, run_.options.toi_tolerance);
    evaluations += answer.evaluations;
    answer.t_lo += s;
    answer.t_hi += s;
    if (answer.status != ToiStatus::separated || !(s + length > s)) {
      break;
    }
    s += length;
  }
  answer.evaluations = evaluations;
  run_.cost.toi_evaluations += evaluations;
  return answer;
}

bool FrameWorld::swept_overlap(BodyIndex a, BodyIndex b) {
  if (grasps_.involve(a, b)) {
    return false;
  }
  for (double s = settled_until(a, b); s < motions_.proposed();) {
    const double length = std::max(motions_.common_stretch(a, b, s, motions_.proposed()), 0.0);
    ++run_.cost.overlap_tests;
    if (run_.detector.swept_overlap({run_.model.shape(a), motions_.path_motion(a, s)},
                                    {run_.model.shape(b), motions_.path_motion(b, s)},
                                    {run_.time + s, length})) {
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
  ++run_.cost.overlap_tests;
  return run_.detector.overlaps(run_.model.shape(a), motions_.on_path(a, s).pose,
                                run_.model.shape(b), motions_.on_path(b, s).pose);
}

/// Saves or restores what a run needs to go on, between two frames.
void FrameWorld::persist(Archive& archive) {
  archive(run_, clock_, motions_, contacts_, grasps_);
  run_.recorder.persist(archive);
}

/// Whether the two are neighbours on a joint: these do not meet as solids.
static bool held_by_a_joint(const Model& model, BodyIndex a, BodyIndex b) {
  return !model.scene().joints.empty() && !model.interacts(a, b) &&
         (model.is_free(a) || model.is_free(b)) && !model.is_field(a) && !model.is_field(b);
}

int detect_and_handle(FrameWorld& world) {
  constexpr BodyIndex none = std::numeric_limits<BodyIndex>::max();
  BodyIndex last_next = none;
  int handled = 0;
  for (BodyIndex current = 0; current < world.size(); ++current) {
    for (BodyIndex next = current + 1; next < world.size(); ++next) {
      if ((!world.movable(current) && !world.movable(next)) ||
          held_by_a_joint(world.model(), current, next)) {
        continue;
      }
      if (world.overlap(current, next) && next != last_next) {
        last_next = next;
        world.handle(current, next);
        ++handled;
        break;
      }
    }
  }
  return handled;
}

void give_field_forces(FrameWorld& world) {
  for (const auto& [a, b] : world.model().pairs()) {
    if ((world.model().is_field(a) || world.model().is_field(b)) && world.overlap(a, b)) {
      world.handle(a, b);
    }
  }
}

}  // namespace core
}  // namespace kairos
