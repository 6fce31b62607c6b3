#pragma once

#include "core/recorder.hpp"
#include "core/scheme.hpp"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments {

/// A number that a run is judged by.
struct MetricInfo {
  std::string_view name;
  std::string_view unit;  ///< empty: a count or a ratio
  std::string_view meaning;
};
[[nodiscard]] std::span<const MetricInfo> metric_catalogue();
[[nodiscard]] bool is_metric(std::string_view name);
[[nodiscard]] std::string metric_names();
[[nodiscard]] std::string_view metric_unit(std::string_view name);

/// The body of that name, the first free one if it is empty. Throws `InputError`.
[[nodiscard]] BodyIndex subject_of(const Model& model, const std::string& name);

/// Which metrics are wanted: only what they need is watched. Unknown names throw `InputError`.
struct MetricRequest {
  std::vector<std::string> metrics;
  std::string subject;  ///< body that is followed; empty: the first free one
};

/// Watches a run and measures it. `value` may be asked after the run, with its result.
class MetricRecorder : public Recorder {
 public:
  explicit MetricRecorder(MetricRequest request);
  MetricRecorder(const MetricRecorder&) = delete;
  MetricRecorder& operator=(const MetricRecorder&) = delete;
  ~MetricRecorder() override;
  [[nodiscard]] bool wants_motions() const override;
  void begin(const Model& model) override;
  void frame(const Frame& frame) override;
  void motion(BodyIndex body, const Motion& motion) override;
  void event(const Event& event) override;

  /// A metric of the request, or nothing where it has no meaning in this run (no impact: no time
  /// of impact) or is not finite. Throws `InputError` if it was not requested.
  [[nodiscard]] std::optional<double> value(std::string_view metric, const RunResult& result) const;

 private:
  struct Watches;
  MetricRequest request_;
  std::unique_ptr<Watches> watches_;
};

}  // namespace kairos::experiments
