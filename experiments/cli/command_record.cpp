#include "core/error.hpp"
#include "experiments/cli/checks.hpp"
#include "experiments/cli/commands.hpp"
#include "experiments/output/output_folder.hpp"
#include "experiments/rally/recording.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

namespace kairos::experiments {
namespace {

struct RecordCommand {
  RallyOptions rally;
  std::string out;
  bool force = false;

  void run() const;
};

void RecordCommand::run() const {
  if (!(rally.slowest <= rally.fastest)) {
    throw InputError(
        "", 0, "--slowest",
        fmt::format("is {} m/s, above --fastest, {} m/s", rally.slowest, rally.fastest));
  }
  OutputFolder folder(out, {.seal = "strokes.csv",
                            .begins = strokes_csv({}).substr(0, strokes_csv({}).find('\n')),
                            .replace = force});
  for (const char* name : {"bat.csv", "hand.csv", "strokes.csv"}) {
    folder.claim(name);
  }
  const RallyRecording recording = make_rally(rally);
  folder.file("bat.csv").write(bat_csv(recording));
  folder.file("hand.csv").write(hand_csv(recording));
  folder.file("strokes.csv").write(strokes_csv(recording));
  folder.publish();
  fmt::print("{} strokes in {} s, seed {} -> {}\n", recording.strokes.size(), recording.duration(),
             rally.seed, out);
}

}  // namespace

void add_record_command(Command& app) {
  const auto command = std::make_shared<RecordCommand>();
  RallyOptions& rally = command->rally;
  Command record = app.add_subcommand(
      "record", "Write tracker recordings of a rally that nobody played: bat, hand, strokes");
  record.add_option("--out", command->out, "folder for bat.csv, hand.csv and strokes.csv")
      .required()
      .type_name("DIR")
      .check(some_path());
  record.add_flag("--force", command->force, "replace files that this command has not written");
  record.add_option("--seed", rally.seed, "the same seed, the same rally")
      .check(seed_number())
      .capture_default_str();
  record.add_option("--strokes", rally.strokes, "how many")
      .check(whole_number(1, 100000))
      .capture_default_str();
  record.add_option("--rate", rally.rate, "samples per second of each tracker")
      .check(finite_number(1.0, 1e6))
      .capture_default_str();
  record.add_option("--noise", rally.noise, "standard deviation of a coordinate, m")
      .check(finite_number(0.0, 1.0))
      .capture_default_str();
  record.add_option("--angle-noise", rally.angle_noise, "of a turn about each axis, degrees")
      .check(finite_number(0.0, 90.0))
      .capture_default_str();
  // Slower swings would last until after the next ball is served.
  record.add_option("--slowest", rally.slowest, "least of the strokes' greatest speeds, m/s")
      .check(finite_number(2.0, 100.0))
      .capture_default_str();
  record.add_option("--fastest", rally.fastest, "most of them, m/s")
      .check(finite_number(2.0, 100.0))
      .capture_default_str();
  record.callback([command] { command->run(); });
}

}  // namespace kairos::experiments
