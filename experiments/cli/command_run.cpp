#include "core/error.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/cli/run_options.hpp"
#include "experiments/metrics/run_metrics.hpp"
#include "experiments/output/broadcast.hpp"
#include "experiments/output/output_folder.hpp"
#include "experiments/output/run_files.hpp"
#include "experiments/output/run_summary.hpp"
#include "experiments/progress_bar.hpp"
#include "experiments/run_error.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <optional>

namespace kairos::experiments {
namespace {

/// Shows a person how far the run has come.
class ProgressRecorder : public Recorder {
 public:
  explicit ProgressRecorder(std::size_t frames) : frames_(frames), bar_("run", frames) {}

  void frame(const Frame& /*frame*/) override {
    if (drawn_ < frames_) {  // frame times that vary can be more than their mean tells
      ++drawn_;
      bar_.advance();
    }
  }

 private:
  std::size_t frames_;
  std::size_t drawn_ = 0;
  ProgressBar bar_;
};

std::size_t expected_frames(const Scene& scene, const RunChoice& choice) {
  return static_cast<std::size_t>(choice.duration.value_or(scene.duration) /
                                  mean_frame_duration(choice.frames.value_or(scene.frames))) +
         1;
}

struct RunCommand {
  SceneOptions scene;
  RunOptions method;
  std::optional<std::string> out;

  void run() const;
};

void RunCommand::run() const {
  const RunChoice choice = method.choice();
  const Model model(scene.scene());
  if (const std::string reason = why_refused(model, choice); !reason.empty()) {
    throw InputError(model.scene().path, 0, "", reason);  // before a folder is made for it
  }

  MetricsRecorder metrics;
  std::vector<Recorder*> listeners{&metrics};
  std::optional<OutputFolder> folder;
  std::optional<RunFiles> files;
  if (out) {
    folder.emplace(*out);
    files.emplace(*folder);
    listeners.push_back(&*files);
  }
  std::optional<ProgressRecorder> progress;
  if (::isatty(STDERR_FILENO) == 1) {
    listeners.push_back(&progress.emplace(expected_frames(model.scene(), choice)));
  }
  Broadcast recorder(listeners);
  const RunResult result = simulate(model, choice, recorder);
  progress.reset();

  const FinishedRun finished{model, choice, result, metrics.metrics()};
  if (folder) {
    folder->file("summary.json").write(summary_json(finished));
    folder->publish();
  }
  fmt::print("{}", summary_text(finished));
  if (result.status == RunStatus::stopped) {
    throw RunError(fmt::format("{}: stopped at t = {} s: {}", model.scene().path,
                               result.end.seconds, result.reason));
  }
}

}  // namespace

void add_run_command(CLI::App& app) {
  const auto command = std::make_shared<RunCommand>();
  CLI::App* run = app.add_subcommand("run", "Simulate a scene by a method");
  command->scene.add_to(*run);
  command->method.add_to(*run);
  run->add_option("--out", command->out,
                  "folder for trajectory.csv, events.csv, energy.csv and summary.json")
      ->type_name("DIR");
  run->callback([command] { command->run(); });
}

}  // namespace kairos::experiments
