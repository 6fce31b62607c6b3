#pragma once

#include "core/schemes/event/event_predictor.hpp"

namespace kairos {
inline namespace core {

/// The state of the island of body i jumps at t: the ledger follows it up to there, its bodies are
/// brought, `change` changes their states at `now` or what acts on them, it is launched from there,
/// and what it meets is predicted.
///
/// This serves whatever happens to one island, whoever its neighbours are. Two kinds of events take
/// the same steps by themselves: an impact opens both islands before it is known what comes of it
/// (`EventContacts::impact`, which ends in `relaunch` or in a mode of contact), and a group in
/// touch launches its bodies from states that were solved for together (`EventModes::commit`).
/// `JumpWatch` holds all three to the same protocol.
template <typename Change>
void jump(EventMotions& motions, EventPredictor& predictor, BodyIndex i, Instant t,
          const Change& change) {
  motions.open(i, t);
  change();
  motions.launch(i, t);
  predictor.predict_island(i, t);
}

}  // namespace core
}  // namespace kairos
