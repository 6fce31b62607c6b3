#pragma once

#include "core/model.hpp"
#include "core/recorder.hpp"
#include "core/scheme.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace kairos {
inline namespace simulation {

/// The last line of defence: NaN and infinity never travel, in states or in the energy ledger, and
/// no run goes on whose integrator has lost a body's rotation. Ends the run at the first of either,
/// with the last frame that was whole.
///
/// A free body of angular momentum L turns with an energy of at most L^2 / (2 I), I its smallest
/// principal moment. A frame that shows twice as much, with no torque since the last impact, is not
/// a large error but an unstable step: of Runge-Kutta methods beyond about 3 rad a step.
class RunGuard : public Recorder {
 public:
  /// What ends a run.
  struct Broken {
    std::string reason;
  };

  /// `watch_spin`: torques come from forces and impacts alone, not from contacts that last.
  explicit RunGuard(Recorder& inner, bool watch_spin = true)
      : inner_(inner), watch_spin_(watch_spin) {}

  void begin(const Model& model) override;
  [[nodiscard]] bool wants_motions() const override { return inner_.wants_motions(); }
  void frame(const Frame& frame) override;
  void motion(BodyIndex body, const Motion& motion) override { inner_.motion(body, motion); }
  void event(const Event& event) override;
  void goes_on(Instant t) override { inner_.goes_on(t); }
  void stage(Stage stage, double fraction) override { inner_.stage(stage, fraction); }
  bool persist(Archive& archive) override;

  /// The run up to its last frame. Of its cost, frames and events are known.
  [[nodiscard]] RunResult stopped(std::string reason) &&;

 private:
  void check_finite(const BodyState& body, BodyIndex i, Instant t) const;
  void check_energy(const Frame& frame) const;
  [[noreturn]] void refuse_energy(const Frame& frame, double joules, std::string_view name) const;
  void check_spin(const BodyState& body, BodyIndex i, Instant t);
  [[nodiscard]] double most_spin_energy(const BodyState& body, BodyIndex i) const;

  Recorder& inner_;
  const bool watch_spin_;
  const Model* model_ = nullptr;
  std::vector<char> free_top_;       ///< turns, and neither force nor contact involves that
  bool has_free_tops_ = false;       ///< else nobody's spin is watched
  std::vector<double> most_energy_;  ///< J, since the last impact; infinite: not known yet
  RunResult last_;
};

}  // namespace simulation
}  // namespace kairos
