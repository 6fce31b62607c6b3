#pragma once

#include "core/recorder.hpp"
#include "simulation/view/view_run.hpp"

#include <cstddef>

namespace kairos {
inline namespace simulation {

/// Collects what a page needs of a run: motions instead of frames. A frame is compared with the
/// motions; what those do not tell (a driven body of a frame-based scheme, a ball in a hand, a body
/// that was pushed out of another) is filled in from what was drawn, on straight lines.
class ViewRecorder : public Recorder {
 public:
  void begin(const Model& model) override;
  [[nodiscard]] bool wants_motions() const override { return true; }
  /// Throws `std::length_error` where the run becomes larger than a page can be.
  void frame(const Frame& frame) override;
  void motion(BodyIndex body, const Motion& motion) override;
  void event(const Event& event) override;

  /// What was collected; call once, after the run.
  [[nodiscard]] ViewRun finish() &&;

 private:
  void follow(BodyIndex i, Instant t, const BodyState& drawn);
  void keep_energy(const EnergyLedger& ledger);
  void check_size() const;

  const Model* model_ = nullptr;
  ViewRun run_;
  State drawn_;  ///< in the last frame
  Instant drawn_at_;
  std::size_t motions_ = 0;
};

}  // namespace simulation
}  // namespace kairos
