#include "core/archive.hpp"
#include "core/error.hpp"
#include "experiments/checkpoint/file_keeper.hpp"
#include "experiments/checkpoint/run_identity.hpp"
#include "experiments/cli/checks.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/cli/run_options.hpp"
#include "experiments/cli/run_progress.hpp"
#include "experiments/output/atomic_file.hpp"
#include "experiments/output/broadcast.hpp"
#include "experiments/output/output_folder.hpp"
#include "experiments/output/run_files.hpp"
#include "experiments/output/run_summary.hpp"
#include "experiments/run_error.hpp"
#include "simulation/run_metrics.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace kairos::experiments {
namespace {

/// Warns of frame times that are allowed and hardly meant.
void warn_of_frames(const Scene& scene, const RunChoice& choice) {
  const double frame = mean_frame_duration(choice.frames.value_or(scene.frames));
  const double duration = choice.duration.value_or(scene.duration);
  if (frame > duration) {
    warn(
        fmt::format("a frame is {} s, longer than the run, {} s; a number without a unit is in "
                    "seconds: --frame 16ms, --frame 1/60",
                    frame, duration));
  }
}

struct RunCommand {
  SceneOptions scene;
  RunOptions method;
  std::optional<std::string> out;
  std::string save;
  double save_interval = 10.0;  ///< s
  std::string resume;
  bool force = false;  ///< whatever --out holds is replaced

  void run() const;
  [[nodiscard]] CheckpointFile checkpoint(const Model& model, const RunIdentity& identity) const;
  [[nodiscard]] RunResult go(const Model& model, const RunChoice& choice, Recorder& recorder,
                             FileKeeper& keeper, std::string_view begun) const;
};

/// The checkpoint that --resume names, if it is of this run.
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

/// Where the files of a run grow: in the folder that will hold them, or, where only a checkpoint
/// wants them, without a name beside it.
class RunOutput {
 public:
  RunOutput(const std::optional<std::string>& out, const std::string& save, bool force) {
    if (out) {
      folder_.emplace(*out, run_output(force));
      folder_->claim("summary.json");
    }
    for (const std::string_view name : RunFiles::names) {
      if (folder_) {
        files_.push_back(&folder_->file(name));
      } else if (!save.empty()) {
        unnamed_.push_back(std::make_unique<AtomicFile>(fmt::format("{}.{}", save, name)));
        files_.push_back(unnamed_.back().get());
      }
    }
  }

  /// The three files, or none if they are not wanted.
  [[nodiscard]] const std::vector<AtomicFile*>& files() const { return files_; }
  void publish(const std::string& summary) {
    if (folder_) {
      folder_->file("summary.json").write(summary);
      folder_->publish();
    }
  }

 private:
  std::optional<OutputFolder> folder_;
  std::vector<std::unique_ptr<AtomicFile>> unnamed_;
  std::vector<AtomicFile*> files_;
};

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
  warn_of_frames(model.scene(), choice);

  MetricsRecorder metrics;
  std::vector<Recorder*> listeners{&metrics};
  RunOutput output(out, save, force);
  std::optional<RunFiles> files;
  if (!output.files().empty()) {
    files.emplace(*output.files()[0], *output.files()[1], *output.files()[2]);
    files->go_on_from(begun.files);
    listeners.push_back(&*files);
  }
  std::optional<RunProgress> progress;
  if (::isatty(STDERR_FILENO) == 1) {
    listeners.push_back(&progress.emplace(choice.duration.value_or(model.scene().duration)));
  }
  Broadcast recorder(listeners);
  FileKeeper keeper(save, identity, output.files(), save_interval);
  const RunResult result = go(model, choice, recorder, keeper, begun.world);
  progress.reset();

  const FinishedRun finished{model, choice, result, metrics.metrics()};
  output.publish(out ? summary_json(finished) : std::string());
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

void add_run_command(Command& app) {
  const auto command = std::make_shared<RunCommand>();
  Command run = app.add_subcommand("run", "Simulate a scene by a method");
  command->scene.add_to(run);
  command->method.add_to(run);
  run.add_option("--out", command->out,
                 "folder for trajectory.csv, events.csv, energy.csv and summary.json")
      .type_name("DIR")
      .check(some_path());
  run.add_flag("--force", command->force,
               "replace what --out holds, even if no earlier run has written it");
  run.add_option("--save", command->save,
                 "keep a checkpoint of the run in this file: now and then, and at the end")
      .type_name("FILE")
      .check(some_path());
  run.add_option("--save-interval", command->save_interval,
                 "seconds of real time between checkpoints; 0: after every frame")
      .check(finite_number(0.0, 1e9))
      .capture_default_str();
  run.add_option("--resume", command->resume,
                 "go on from a checkpoint of the same scene and method, to the end or beyond; "
                 "gives the bytes of a run that was never interrupted")
      .type_name("FILE")
      .check(some_path());
  run.callback([command] { command->run(); });
}

}  // namespace kairos::experiments
