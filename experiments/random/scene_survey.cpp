#include "experiments/random/scene_survey.hpp"

#include "core/archive.hpp"
#include "experiments/output/record_journal.hpp"
#include "experiments/parallel_for.hpp"
#include "simulation/output/json_writer.hpp"
#include "simulation/version.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <mutex>
#include <optional>
#include <set>

namespace kairos::experiments {
namespace {

/// Scenes of a block: some tenths of a second.
constexpr std::uint64_t block_size = 100;

double thread_seconds() {
  std::timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Tally run_block(const SceneSurvey& survey, std::uint64_t first, std::uint64_t count) {
  Tally tally;
  const double start = thread_seconds();
  for (std::uint64_t i = first; i < first + count; ++i) {
    const RandomScene scene = scene_of(survey, i);
    tally.add(i, survey.kind == SceneKind::balls ? try_by_two_searches(scene) : try_scene(scene));
  }
  tally.seconds = thread_seconds() - start;
  return tally;
}

std::string survey_key(const SceneSurvey& survey) {
  const std::string_view kind = to_string(survey.kind);
  return fmt::format("kairos random-scenes 1{}{} seed {} first {} program {}",
                     kind.empty() ? "" : " ", kind, survey.seed, survey.first, program_identity());
}

}  // namespace

std::string_view to_string(SceneKind kind) {
  switch (kind) {
    case SceneKind::any:
      return "";
    case SceneKind::touching:
      return "touching";
    case SceneKind::rough:
      return "friction";
    case SceneKind::jointed:
      return "joints";
    case SceneKind::shapes:
      return "shapes";
    case SceneKind::balls:
      return "balls";
  }
  return "";
}

RandomScene scene_of(const SceneSurvey& survey, std::uint64_t number) {
  switch (survey.kind) {
    case SceneKind::any:
      break;
    case SceneKind::touching:
      return touching_scene(survey.seed, number);
    case SceneKind::rough:
      return rough_scene(survey.seed, number);
    case SceneKind::jointed:
      return jointed_scene(survey.seed, number);
    case SceneKind::shapes:
      return shapes_scene(survey.seed, number);
    case SceneKind::balls:
      return balls_scene(survey.seed, number);
  }
  return random_scene(survey.seed, number);
}

Tally run_survey(const SceneSurvey& survey, const std::string& journal,
                 const std::function<void(const Tally&)>& progress) {
  std::optional<RecordJournal> finished;
  std::set<std::uint64_t> done;
  Tally total;
  const std::uint64_t blocks = (survey.count + block_size - 1) / block_size;
  if (!journal.empty()) {
    finished.emplace(journal, survey_key(survey), [&](std::size_t, std::string_view record) {
      Archive archive(record);
      std::uint64_t block = 0;
      Tally tally;
      archive(block, tally);
      // Only whole blocks are kept, so that a longer survey can use them.
      if ((block + 1) * block_size <= survey.count && done.insert(block).second) {
        total.add(tally);
      }
    });
    progress(total);
  }
  std::mutex mutex;
  parallel_for(blocks, survey.threads, [&](std::size_t index) {
    std::uint64_t block = index;
    if (done.contains(block)) {
      return;
    }
    const std::uint64_t begin = block * block_size;
    const std::uint64_t size = std::min(block_size, survey.count - begin);
    Tally tally = run_block(survey, survey.first + begin, size);
    if (finished && size == block_size) {
      Archive archive;
      archive(block, tally);
      finished->add(archive.bytes());
    }
    const std::lock_guard lock(mutex);
    total.add(tally);
    progress(total);
  });
  return total;
}

std::string survey_summary(const SceneSurvey& survey, const Tally& tally) {
  const auto count = [](std::uint64_t n) { return static_cast<std::int64_t>(n); };
  JsonWriter json;
  json.text("version", version());
  json.count("seed", count(survey.seed));
  json.count("first", count(survey.first));
  json.count("wanted", count(survey.count));
  json.count("scenes", count(tally.scenes));
  json.count("impacts", tally.impacts);
  json.number("processor_seconds", tally.seconds);
  json.open("fates");
  for (const Fate fate : all_fates) {
    json.count(to_string(fate), count(tally.of(fate)));
  }
  json.close();
  json.open("stops");
  for (const auto& [reason, stops] : tally.stops) {
    json.count(reason, count(stops.scenes));
  }
  json.close();
  json.open("failures");
  for (const auto& [number, trial] : tally.failures) {
    json.text(std::to_string(number),
              fmt::format("{} at {} s: {}", to_string(trial.fate), trial.time, trial.reason));
  }
  json.close();
  return json.finish();
}

}  // namespace kairos::experiments
