#include "core/schemes/event/event_run.hpp"

#include "core/archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace kairos {
inline namespace core {
namespace {

/// So many events in a frame are told, and then as many again: most frames have fewer.
constexpr std::int64_t told_every = 1024;

/// Who keeps a run busy: "'a' and 'b' (98 %), 'b' and 'c' (2 %)".
std::string busiest(const EventRun& run, std::vector<WorkBudget::Share> shares) {
  for (WorkBudget::Share& s : shares) {
    if (run.agenda.before(s.b, s.a)) {
      std::swap(s.a, s.b);
    }
  }
  std::sort(shares.begin(), shares.end(), [&](const auto& x, const auto& y) {
    return std::tuple(-x.share, run.model.body(x.a).name, run.model.body(x.b).name) <
           std::tuple(-y.share, run.model.body(y.a).name, run.model.body(y.b).name);
  });
  constexpr std::size_t most_pairs = 4;
  std::string text;
  for (std::size_t k = 0; k < std::min(shares.size(), most_pairs); ++k) {
    const WorkBudget::Share& s = shares[k];
    const std::string pair =
        s.a == s.b ? "'" + run.model.body(s.a).name + "'" : run.names(s.a, s.b);
    text += fmt::format("{}{} ({:.0f} %)", k == 0 ? "" : ", ", pair, 100.0 * s.share);
  }
  return text.empty() ? "many bodies" : text;
}

}  // namespace

void EventRun::begin_epoch(Instant t) {
  epoch_end_ = t + epoch_;
  const BodyIndex any = agenda.by_name().front();
  agenda.push(epoch_end_, DueKind::epoch_end, any, any);
}

void EventRun::spend(const DueEvent& event) {
  switch (budget_.spend(event)) {
    case WorkBudget::Spent::nothing:
      if (budget_.in_frame() % told_every == 0) {
        recorder.goes_on(event.time);
      }
      return;
    case WorkBudget::Spent::instant:
      return stop(event.time,
                  fmt::format("accumulation: {} events at one instant, and time does not go on: of "
                              "{}; they stay in touch; {}",
                              budget_.most_at_once(), busiest(*this, budget_.busiest()),
                              lasting_contact_advice));
    case WorkBudget::Spent::frame:
      return stop(event.time,
                  fmt::format("too many events: more than {} in one frame, most of them of {}; "
                              "allowed: shorter frames (--frame), more events (--max-events), or a "
                              "run that ends before (--duration)",
                              budget_.most_in_frame(), busiest(*this, budget_.busiest())));
  }
}

void EventRun::persist(Archive& archive) {
  archive(boxes_crossed, time, epoch_end_, agenda, budget_, ledger, cost);
}

}  // namespace core
}  // namespace kairos
