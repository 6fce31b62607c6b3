#include "core/schemes/event/event_world.hpp"

#include "core/archive.hpp"

#include <cassert>
#include <utility>

namespace kairos {
inline namespace core {

namespace {

/// So many bodies are found fast enough when they are asked for.
constexpr std::size_t most_in_cache = 16384;

}  // namespace

EventWorld::EventWorld(const Model& model, const Method& method, const SchemeOptions& options,
                       Recorder& recorder)
    : run_(model, method, options, recorder),
      grasps_(model),
      graph_(run_.agenda.ranks()),
      motions_(run_, method),
      predictor_(run_, motions_, grasps_, graph_, method),
      contacts_(run_, motions_, predictor_, graph_, method),
      hands_(run_, motions_, predictor_, contacts_, grasps_),
      clock_(run_.options),
      looks_ahead_(model.size() > most_in_cache) {
  if (model.scene().periodic) {
    run_.boxes_crossed.resize(model.size());
  }
}

bool EventWorld::begin() {
  if (!run_.options.resume.empty()) {
    Archive archive(run_.options.resume);
    persist(archive);
    return open_frame();
  }
  run_.begin_epoch(Instant{});
  motions_.begin();
  for (const auto& grip : run_.model.grips()) {
    hands_.follow(grip.hand, run_.time);
  }
  predictor_.predict_all(run_.time);
  return true;
}

void EventWorld::take() {
  const DueEvent event = run_.agenda.pop();
  if (looks_ahead_) {
    look_ahead();
  }
  if constexpr (watches_jumps) {
    run_.jumps.begin();
  }
  take(event);
  assert(stopped() || motions_.left_out().empty());
  if (event.own && !stopped() && !run_.agenda.is_filed(event.owner)) {
    predictor_.renew(event.owner, event.time);  // its motion is the same
  }
}

/// What comes next is fetched while this event is taken. It changes nothing that is computed.
void EventWorld::look_ahead() {
  run_.agenda.see_day([this](BodyIndex a, BodyIndex b) {
    for (const BodyIndex i : {a, b}) {
      run_.agenda.look_up(static_cast<std::uint32_t>(i));
      motions_.look_up_all(i);
      predictor_.look_up(i);
      contacts_.look_up(i);
    }
  });
  run_.agenda.see_soon([this](BodyIndex a, BodyIndex b) {
    predictor_.look_around(a);
    if (b != a) {
      predictor_.look_around(b);
    }
  });
}

void EventWorld::take(const DueEvent& event) {
  if (event.kind == DueKind::epoch_end) {
    return next_epoch(event.time);
  }
  if (event.kind == DueKind::contact_begins) {
    return contacts_.begin_contact(event.a, event.b, event.time);
  }
  if (event.stale) {
    return event.own ? predictor_.renew(event.owner, event.time) : void();
  }
  run_.spend(event);
  if (stopped()) {
    return;
  }
  run_.time = event.time;
  switch (event.kind) {
    case DueKind::segment_end:
      return end_segment(event.a, event.time);
    case DueKind::support_ends:
      return contacts_.leave_support(event.a, event.time);
    case DueKind::mode_ends:
    case DueKind::step_ends:
      return contacts_.settle_anew(run_.model.is_free(event.a) ? event.a : event.b, event.time);
    case DueKind::stays:
      return contacts_.stay(event.a, event.b, event.time);
    case DueKind::epoch_end:
    case DueKind::contact_begins:
      return;
    case DueKind::field_entered:
      return contacts_.cross_field(event.a, event.b, event.time, true);
    case DueKind::field_left:
      return contacts_.cross_field(event.a, event.b, event.time, false);
    case DueKind::clear_of_hand:
      return hands_.clear(event.a, event.b, event.time);
    case DueKind::crossing:
      return predictor_.cross(event.a, event.time);
    case DueKind::recheck:
      return predictor_.predict_pair(event.a, event.b, event.image, event.time);
    case DueKind::impact:
      return contacts_.impact(event.a, event.b, event.time, event.bracket, event.decided);
  }
}

/// Predictions were made up to here: makes those of the next epoch.
void EventWorld::next_epoch(Instant t) {
  run_.begin_epoch(t);
  for (const BodyIndex i : run_.agenda.by_name()) {
    // The end of a support was looked for in one epoch only. A surface that is driven tells by its
    // next motion.
    const auto& support = motions_.support(i);
    if (support && run_.model.mobility(support->surface) != Mobility::driven) {
      motions_.open(i, t);
      motions_.launch(i, t);
    }
  }
  for (const BodyIndex i : contacts_.modes().moving()) {
    if (motions_.start_of(i) < t) {  // its group has not been settled yet
      contacts_.settle_anew(i, t);
    }
  }
  predictor_.predict_all(t);
}

void EventWorld::end_segment(BodyIndex i, Instant t) {
  motions_.go_on(i, t);
  if (run_.model.mobility(i) == Mobility::driven) {
    contacts_.carry_riders(i, t);
    hands_.follow(i, t);
    return predictor_.predict(i, t);
  }
  predictor_.predict_island(i, t);
}

bool EventWorld::draw() {
  run_.time = stopped() ? run_.stopped_at() : clock_.next();
  motions_.book_all(run_.time);
  const State& drawn = motions_.draw(run_.time);
  run_.account.balance(run_.time, drawn);
  run_.recorder.stage(Stage::draw, 1.0);
  run_.recorder.frame({clock_.index(), run_.time, drawn, run_.ledger, grasps_.in_hand()});
  motions_.end_drawing();
  ++run_.cost.frames;
  return !stopped() && open_frame();
}

/// Begins the frame after the one that was drawn last; false where the run ends.
bool EventWorld::open_frame() {
  run_.begin_frame();
  clock_.look(run_.time);
  if (clock_.whole()) {
    run_.offer_checkpoint(clock_.last(), [this](Archive& archive) { persist(archive); });
  }
  return clock_.advance();
}

RunResult EventWorld::result() && {
  run_.cost.right_hand_sides += motions_.evaluations();
  return std::move(run_).result(std::move(motions_).last_drawn());
}

/// Saves or restores what a run needs to go on, between two frames.
void EventWorld::persist(Archive& archive) {
  archive(run_, clock_, grasps_, graph_, motions_, predictor_, contacts_);
  run_.recorder.persist(archive);
}

}  // namespace core
}  // namespace kairos
