#pragma once

#include "core/energy_ledger.hpp"
#include "core/event.hpp"
#include "core/model.hpp"
#include "core/motion.hpp"

#include <cstdint>
#include <span>

namespace kairos {
inline namespace core {

class Archive;

/// What a scheme does in a frame, for the flow diagrams of figs. 7 and 15.
enum class Stage { draw, calculate_positions, restrict_movement, detect, handle, advance, locate };
/// The word for it in the flow diagrams.
[[nodiscard]] std::string_view to_string(Stage stage);

/// A rendered frame: the world as a person sees it.
struct Frame {
  std::int64_t index = 0;
  Instant time;
  std::span<const BodyState> bodies;  ///< indexed by `BodyIndex`
  const EnergyLedger& ledger;         ///< balanced at `time`
  /// Nonzero for bodies that a fist holds, or has let go of and not yet cleared: they have no
  /// contacts. Indexed by `BodyIndex`; empty: none.
  std::span<const char> in_hand = {};
};

/// Listens to a run. All callbacks come in order of time (motions: in order of creation) from the
/// thread that runs the scheme; references are valid during the call only.
class Recorder {
 public:
  virtual ~Recorder() = default;
  /// Once, before anything else; the model outlives the run.
  virtual void begin(const Model& /*model*/) {}
  /// Whether `motion` is wanted: if not, schemes that need none for themselves make none.
  [[nodiscard]] virtual bool wants_motions() const { return false; }
  /// A frame is drawn: at the start, after each frame, at the end.
  virtual void frame(const Frame& /*frame*/) {}
  /// Body `body` moves like this; a later motion of the same body ends it earlier, if it starts
  /// before this one ends.
  virtual void motion(BodyIndex /*body*/, const Motion& /*motion*/) {}
  /// Something happened between two bodies.
  virtual void event(const Event& /*event*/) {}
  /// Work goes on at this time, where much of it lies between two frames or events.
  virtual void goes_on(Instant /*t*/) {}
  /// A stage of the flow of events; `fraction` of the frame done (fig. 15).
  virtual void stage(Stage /*stage*/, double /*fraction*/) {}
  /// Writes what it has gathered so far to a checkpoint, or reads it back (after `begin`). Returns
  /// false and does nothing where it cannot: its run then leaves no checkpoint.
  virtual bool persist(Archive& /*archive*/) { return false; }
};

}  // namespace core
}  // namespace kairos
