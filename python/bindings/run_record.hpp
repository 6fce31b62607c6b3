#pragma once

#include "core/trajectory.hpp"
#include "simulation/run_metrics.hpp"
#include "simulation/simulate.hpp"
#include "simulation/view/view_recorder.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "python/bindings/errors.hpp"
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace kairos::python {

/// A line of the ledger, as numpy sees it: a row of a structured array.
struct LedgerRow {
  std::int64_t frame = 0;
  double time = 0.0;
  double kinetic = 0.0, potential = 0.0;
  std::array<double, energy_line_count> lines{};
  double unexplained = 0.0, flow = 0.0;
};
static_assert(sizeof(LedgerRow) == (6 + energy_line_count) * 8, "numpy sees no padding");

/// Keeps a run for Python: frames in one piece of memory each, so that arrays refer to them.
class RunKeeper final : public Recorder {
 public:
  /// `listener`: an object of the user's with any of `frame` and `event`; None: none.
  RunKeeper(bool keep_motions, const pybind11::object& listener);

  void begin(const Model& model) override;
  [[nodiscard]] bool wants_motions() const override { return keep_motions_; }
  void frame(const Frame& frame) override;
  void motion(BodyIndex body, const Motion& motion) override;
  void event(const Event& event) override;

  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  [[nodiscard]] const std::vector<BodyState>& states() const { return states_; }
  [[nodiscard]] const std::vector<LedgerRow>& ledger() const { return ledger_; }
  [[nodiscard]] const Trajectory& trajectory() const { return trajectory_; }
  /// Ends the recording for a page; call once, after the run. None where no motions were kept, or
  /// more than a page can hold.
  [[nodiscard]] std::optional<ViewRun> finish_view();
  [[nodiscard]] const RunMetrics& metrics() const { return metrics_.metrics(); }

 private:
  void tell_frame(const Frame& frame);
  /// Calls `tell(recorder)` for the page's recorder, as long as a page can hold the run.
  template <typename Tell>
  void view(const Tell& tell);

  bool keep_motions_;
  const Model* model_ = nullptr;
  std::vector<double> times_;
  std::vector<BodyState> states_;
  std::vector<LedgerRow> ledger_;
  Trajectory trajectory_;
  MetricsRecorder metrics_;
  std::optional<ViewRecorder> viewer_;
  pybind11::object frame_listener_, event_listener_;
  Interrupts interrupts_;
};

/// A finished run: what it was told, what became of it.
struct RunRecord {
  std::unique_ptr<Model> model;
  RunChoice choice;
  std::unique_ptr<RunKeeper> kept;
  RunResult result;
  std::optional<ViewRun> view;
};

/// Events as a structured array, the columns of `events.csv`.
[[nodiscard]] pybind11::array events_array(const Model& model, const std::vector<Event>& events);
/// What `summary.json` says, as dicts.
[[nodiscard]] pybind11::dict summary_of(const RunRecord& run);
[[nodiscard]] pybind11::dict cost_of(const RunRecord& run);
/// The page that shows runs in step, one or two, as HTML text. Throws `std::invalid_argument`.
[[nodiscard]] std::string page_of(const std::string& page_template,
                                  const std::vector<const RunRecord*>& runs);

}  // namespace kairos::python
