#pragma once

#include "core/instant.hpp"

#include <string_view>

namespace kairos {
inline namespace core {

/// Port: who keeps checkpoints of a run.
///
/// A world offers itself after a frame was drawn, as long as nothing that it did depends on how
/// long the run is to last. A run that is resumed there gives the same bytes as one that was never
/// interrupted, to the same end or to a later one.
class CheckpointKeeper {
 public:
  virtual ~CheckpointKeeper() = default;
  /// Whether to keep the world after the frame at `t`; `last`: no other offer will come.
  [[nodiscard]] virtual bool wants(Instant t, bool last) = 0;
  /// The world as bytes, for `SchemeOptions::resume`.
  virtual void keep(Instant t, std::string_view world) = 0;
};

}  // namespace core
}  // namespace kairos
