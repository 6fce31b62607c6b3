#include "experiments/tradeoff/measured_run.hpp"

#include "core/error.hpp"
#include "experiments/output/broadcast.hpp"
#include "experiments/way_of_run.hpp"

#include <chrono>
#include <optional>

namespace kairos::experiments {
namespace {

constexpr std::int64_t most_calls = 2'000'000;

struct TooLong {
  double time;
};

class ImpactTimes : public Recorder {
 public:
  void frame(const Frame& frame) override { count(frame.time); }
  void event(const Event& event) override {
    count(event.time);
    if (event.kind == EventKind::impact) {
      times[std::minmax(event.a, event.b)].push_back(event.time.seconds);
    }
  }
  std::map<BodyPair, std::vector<double>> times;

 private:
  void count(Instant t) {
    if (++calls_ > most_calls) {
      throw TooLong{t.seconds};
    }
  }
  std::int64_t calls_ = 0;
};

}  // namespace

MeasuredRun measure(const Model& model, const RunChoice& choice, ProgressBar* bar) {
  MeasuredRun run;
  MetricsRecorder metrics;
  ImpactTimes impacts;
  std::vector<Recorder*> listeners{&metrics, &impacts};
  std::optional<WayOfRun> way;
  if (bar != nullptr && bar->is_drawn()) {
    listeners.push_back(&way.emplace(*bar, choice.duration.value_or(model.scene().duration)));
  }
  Broadcast recorder(listeners);
  try {
    RunResult result = simulate(model, choice, recorder);
    run.status = result.status == RunStatus::completed ? "completed" : "stopped";
    run.reason = std::move(result.reason);
    run.end = std::move(result.state);
    run.reached = result.end.seconds;
    run.cost = result.cost;
  } catch (const InputError& error) {
    run.status = "refused";
    run.reason = error.reason();
  } catch (const TooLong& at) {
    run.status = "too long";
    run.reason = "more frames and events than a comparison is worth";
    run.reached = at.time;
  }
  run.impacts = std::move(impacts.times);
  run.metrics = metrics.metrics();
  return run;
}

double time_run(const Model& model, const RunChoice& choice) {
  Recorder nobody;
  const auto start = std::chrono::steady_clock::now();
  (void)simulate(model, choice, nobody);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace kairos::experiments
