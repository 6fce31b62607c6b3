#pragma once

#include "core/recorder.hpp"
#include "simulation/penetration.hpp"

#include <optional>

namespace kairos {
inline namespace simulation {

/// What a run got wrong, as a person sees it: measured on the drawn frames, and at impacts.
struct RunMetrics {
  /// Deepest penetration of two solids.
  struct Deepest {
    double depth = 0.0;            ///< m
    std::optional<BodyPair> pair;  ///< none: nothing penetrates
    double time = 0.0;             ///< s

    /// Keeps a depth (m) of a pair if it is greater than all so far.
    void look(double found, BodyPair of, Instant t);
    /// Writes it to a checkpoint, or reads it back.
    void persist(Archive& archive);
  };

  Deepest in_frames;              ///< that are drawn
  Deepest in_impacts;             ///< between frames too: where two were when they were handled
  double time_overlapping = 0.0;  ///< for how long frames that show an overlap were shown, s
  std::int64_t frames_overlapping = 0;
  std::int64_t frames = 0;
  double final_energy_error = 0.0;  ///< J
  double max_energy_error = 0.0;    ///< largest magnitude in a drawn frame, J
  /// What energy errors are relative to, J: the larger of |initial energy| and the largest kinetic
  /// energy of a drawn frame.
  double energy_scale = 0.0;

  /// Writes it to a checkpoint, or reads it back.
  void persist(Archive& archive);
  /// The greater of both.
  [[nodiscard]] const Deepest& deepest() const {
    return in_impacts.depth > in_frames.depth ? in_impacts : in_frames;
  }
  /// `joules` relative to the scale; 0 where there is no energy at all.
  [[nodiscard]] double relative(double joules) const {
    return energy_scale > 0.0 ? joules / energy_scale : 0.0;
  }
};

/// Energy that no physics accounts for, J: the change since the start minus the work of fields,
/// driven bodies, belts and hands, and minus the restitution loss. What is left is truncation, late
/// impact, position correction, roundoff and what is unexplained.
[[nodiscard]] double energy_error(const EnergyLedger& ledger);

/// Measures while a run goes on, in constant memory.
class MetricsRecorder : public Recorder {
 public:
  void begin(const Model& model) override;
  void frame(const Frame& frame) override;
  void event(const Event& event) override;
  bool persist(Archive& archive) override;

  /// The metrics of what has been recorded so far.
  [[nodiscard]] const RunMetrics& metrics() const { return metrics_; }

 private:
  std::optional<PenetrationProbe> probe_;
  RunMetrics metrics_;
  bool overlapping_ = false;  ///< in the frame that is being shown
  Instant shown_since_;
};

}  // namespace simulation
}  // namespace kairos
