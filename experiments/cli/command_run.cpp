#include "core/archive.hpp"
#include "core/error.hpp"
#include "experiments/checkpoint/file_keeper.hpp"
#include "experiments/checkpoint/run_identity.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/cli/run_options.hpp"
#include "experiments/output/atomic_file.hpp"
#include "experiments/output/broadcast.hpp"
#include "experiments/output/output_folder.hpp"
#include "experiments/output/run_files.hpp"
#include "experiments/output/run_summary.hpp"
#include "experiments/progress_bar.hpp"
#include "experiments/run_error.hpp"
#include "simulation/run_metrics.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

namespace kairos::experiments {
namespace {

/// Shows a person how far the run has come: frames, simulated time, and events a second, so that a
/// run that crawls is seen to, between two frames as well.
class ProgressRecorder : public Recorder {
 public:
  explicit ProgressRecorder(std::size_t frames) : frames_(frames), bar_("run", frames) {}

  void frame(const Frame& frame) override {
    if (drawn_ < frames_) {  // frame times that vary can be more than their mean tells
      ++drawn_;
      bar_.advance();
    }
    say(frame.time);
  }
  void event(const Event& event) override {
    ++events_;
    say(event.time);
  }
  bool persist(Archive& /*archive*/) override { return true; }

 private:
  using Clock = std::chrono::steady_clock;

  /// Ten times a second: events a second since the last time.
  void say(Instant t) {
    const double seconds = std::chrono::duration<double>(Clock::now() - said_).count();
    if (seconds > 0.1) {
      const auto news = static_cast<double>(events_ - said_events_);
      bar_.say(fmt::format("t = {:.6g} s, {:.0f} events/s", t.seconds, news / seconds));
      said_ = Clock::now();
      said_events_ = events_;
    }
  }

  Clock::time_point said_ = Clock::now();
  std::int64_t events_ = 0;
  std::int64_t said_events_ = 0;
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
  std::string save;
  double save_interval = 10.0;  ///< s
  std::string resume;

  void run() const;
  [[nodiscard]] CheckpointFile checkpoint(const Model& model, const RunIdentity& identity) const;
  [[nodiscard]] std::string scratch_folder() const;
  [[nodiscard]] RunResult go(const Model& model, const RunChoice& choice, Recorder& recorder,
                             FileKeeper& keeper, std::string_view begun) const;
};

/// What --resume names, if it is of this run.
CheckpointFile RunCommand::checkpoint(const Model& model, const RunIdentity& identity) const {
  if (resume.empty()) {
    return {};
  }
  CheckpointFile file = read_checkpoint(resume);
  require_same_run(resume, file.identity, identity);
  const double duration = method.choice().duration.value_or(model.scene().duration);
  if (file.time > duration) {
    throw InputError(resume, 0, "--duration",
                     fmt::format("is {} s, but the run was saved at {} s", duration, file.time));
  }
  return file;
}

/// A checkpoint holds all files of its run, wanted or not: where they grow until it is written.
std::string RunCommand::scratch_folder() const {
  const std::filesystem::path folder = std::filesystem::path(save).parent_path();
  return folder.empty() ? "." : folder.string();
}

void RunCommand::run() const {
  const RunChoice choice = method.choice();
  const Model model(scene.scene());
  if (const std::string reason = why_refused(model, choice); !reason.empty()) {
    throw InputError(model.scene().path, 0, "", reason);  // before a folder is made for it
  }
  if (!save.empty()) {
    const AtomicFile writable(save);  // what is wrong shows before the run
  }
  const RunIdentity identity = run_identity(model, scene.overrides(), choice);
  const CheckpointFile begun = checkpoint(model, identity);

  MetricsRecorder metrics;
  std::vector<Recorder*> listeners{&metrics};
  std::optional<OutputFolder> folder;
  std::optional<RunFiles> files;
  NoRunFiles no_files;
  if (out || !save.empty()) {
    folder.emplace(out.value_or(scratch_folder()));
    files.emplace(*folder);
    listeners.push_back(&*files);
  } else if (!resume.empty()) {
    listeners.push_back(&no_files);
  }
  std::optional<ProgressRecorder> progress;
  if (::isatty(STDERR_FILENO) == 1) {
    listeners.push_back(&progress.emplace(expected_frames(model.scene(), choice)));
  }
  Broadcast recorder(listeners);
  FileKeeper keeper(save, identity, save_interval);
  const RunResult result = go(model, choice, recorder, keeper, begun.world);
  progress.reset();

  const FinishedRun finished{model, choice, result, metrics.metrics()};
  if (out) {
    folder->file("summary.json").write(summary_json(finished));
    folder->publish();
  }
  fmt::print("{}", summary_text(finished));
  if (result.status == RunStatus::stopped) {
    throw RunError(fmt::format("{}: stopped at t = {} s: {}", model.scene().path,
                               result.end.seconds, result.reason));
  }
}

RunResult RunCommand::go(const Model& model, const RunChoice& choice, Recorder& recorder,
                         FileKeeper& keeper, std::string_view begun) const {
  try {
    return simulate(model, choice, recorder, {save.empty() ? nullptr : &keeper, begun});
  } catch (const ArchiveError& error) {
    throw InputError(resume, 0, "", fmt::format("is not of this run: it {}", error.what()));
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
  run->add_option("--save", command->save,
                  "keep a checkpoint of the run in this file: now and then, and at the end")
      ->type_name("FILE");
  run->add_option("--save-interval", command->save_interval,
                  "seconds of real time between checkpoints; 0: after every frame")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  run->add_option("--resume", command->resume,
                  "go on from a checkpoint of the same scene and method, to the end or beyond; "
                  "gives the bytes of a run that was never interrupted")
      ->type_name("FILE");
  run->callback([command] { command->run(); });
}

}  // namespace kairos::experiments
