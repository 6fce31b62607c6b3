#pragma once

#include "core/schemes/event/event_predictor.hpp"

namespace kairos {
inline namespace core {

/// The state of the island of body i jumps at t: the ledger follows it up to there, its bodies are
/// brought, `change` changes their states at `now` or what acts on them, it is launched from there,
/// and what it meets is predicted. Whoever jumps this way forgets none of these.
template <typename Change>
void jump(EventMotions& motions, EventPredictor& predictor, BodyIndex i, Instant t,
          const Change& change) {
  motions.open(i, t);
  change();
  motions.launch(i, t);
  for (const BodyIndex k : motions.island(i)) {
    predictor.predict(k, t);
  }
}

}  // namespace core
}  // namespace kairos
