#include "experiments/sweeps/sweep_shards.hpp"

#include "core/archive.hpp"
#include "core/error.hpp"
#include "core/reading/document.hpp"
#include "experiments/output/output_folder.hpp"
#include "experiments/output/record_journal.hpp"
#include "experiments/output/table.hpp"
#include "experiments/output/text_or_nothing.hpp"
#include "experiments/run_error.hpp"
#include "experiments/sweeps/sweep_journal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <system_error>

namespace kairos::experiments {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_shards = 1000000;
constexpr const char* seal = "shard.csv";

/// What is told of a shard in its `shard.csv`, by key, in this order.
using Facts = std::vector<std::pair<std::string, std::string>>;

std::string text_of(const Shard& shard) { return fmt::format("{}/{}", shard.index, shard.count); }

/// What must be alike in all shards of a sweep, each with what it is called in a message. The scene
/// of each sweep counts by its text, the program by its bytes: paths may differ between machines.
Facts common_facts(const ExperimentSpec& spec, Size size) {
  Facts facts{{"size", std::string(to_string(size))},
              {"spec", fingerprint(text_or_nothing(spec.path))},
              {"program", program_fingerprint()}};
  std::string scenes;
  for (const SweepSpec& sweep : spec.sweeps) {
    scenes += text_or_nothing(scene_path(sweep)) + "\n";
  }
  facts.emplace_back("scene", fingerprint(scenes));
  return facts;
}

std::string table_of(const Facts& facts) {
  Table table{{"key", "value"}, {}};
  for (const auto& [key, value] : facts) {
    table.rows.push_back({key, value});
  }
  return table.csv();
}

/// The key of the rows of a shard: they are of this sweep, this shard, and all that they depend on.
std::string rows_key(const std::string& sweep, const Facts& common, const std::string& shard) {
  std::string key = fmt::format("kairos shard 1 {} {}", shard, sweep);
  for (const auto& [name, value] : common) {
    key += fmt::format(" {}={}", name, value);
  }
  return key;
}

/// A shard as it lies in a folder.
struct FoundShard {
  fs::path folder;
  Shard shard;
  std::string spec_path;
  Facts common;

  [[nodiscard]] std::string told() const {
    return fmt::format("shard {} in {}", text_of(shard), folder.string());
  }
};

FoundShard read_shard(const fs::path& folder) {
  FoundShard found{.folder = folder, .shard = {}, .spec_path = {}, .common = {}};
  const std::string path = (folder / seal).string();
  for (const auto& row : read_csv(path).rows) {
    const std::string key = to_text(row[0]);
    const std::string value = to_text(row[1]);
    if (key == "shard") {
      found.shard = parse_shard(value);
    } else if (key == "path") {
      found.spec_path = value;
    } else {
      found.common.emplace_back(key, value);
    }
  }
  return found;
}

bool holds_rows(const fs::path& folder) {
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (entry.path().extension() == ".rows") {
      return true;
    }
  }
  return false;
}

/// Adds the shards of a folder: itself, or the folders in it.
void look_for_shards(const fs::path& folder, int depth, std::vector<FoundShard>& found) {
  std::error_code none;
  if (fs::is_regular_file(folder / seal, none)) {
    found.push_back(read_shard(folder));
    return;
  }
  if (holds_rows(folder)) {
    throw InputError(folder.string(), 0, "",
                     "holds a shard that is not finished; run it again, it goes on where it was");
  }
  if (depth == 0) {
    return;
  }
  std::vector<fs::path> inside;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (entry.is_directory(none)) {
      inside.push_back(entry.path());
    }
  }
  std::sort(inside.begin(), inside.end());
  for (const fs::path& path : inside) {
    look_for_shards(path, depth - 1, found);
  }
}

/// Refuses shards that are foreign, duplicate or missing; otherwise sorts them.
void check_shards(std::vector<FoundShard>& found) {
  const FoundShard& first = found.front();
  std::map<std::size_t, const FoundShard*> by_index;
  for (const FoundShard& other : found) {
    for (std::size_t i = 0; i < std::min(first.common.size(), other.common.size()); ++i) {
      if (other.common[i] != first.common[i]) {
        throw InputError(
            "", 0, other.told(),
            fmt::format("is of another {} than {}", first.common[i].first, first.told()));
      }
    }
    if (other.shard.count != first.shard.count) {
      throw InputError("", 0, other.told(),
                       fmt::format("does not go with {}: a sweep is divided once", first.told()));
    }
    const auto [place, is_new] = by_index.emplace(other.shard.index, &other);
    if (!is_new) {
      throw InputError("", 0, other.told(),
                       fmt::format("is there twice: {}", place->second->folder.string()));
    }
  }
  std::string missing;
  for (std::size_t k = 1; k <= first.shard.count; ++k) {
    if (!by_index.contains(k)) {
      missing += fmt::format("{}{}", missing.empty() ? "" : ", ", k);
    }
  }
  if (!missing.empty()) {
    throw InputError("", 0, "--merge",
                     fmt::format("of {} shards these are missing: {}", first.shard.count, missing));
  }
  std::sort(found.begin(), found.end(),
            [](const FoundShard& a, const FoundShard& b) { return a.shard.index < b.shard.index; });
}

/// The rows of one sweep, from the files of all shards: eight bytes a run in memory.
class MergedRows {
 public:
  MergedRows(const SweepSpec& spec, const SweepPlan& plan, const std::vector<FoundShard>& shards)
      : per_method_(plan.size() / spec.methods.size()), places_(plan.size(), SweepJournal::none) {
    for (const FoundShard& found : shards) {
      add(spec.name, found);
    }
  }

  [[nodiscard]] RunRecord operator()(std::size_t run) const {
    std::size_t index = 0;
    return read_row(files_[shard_of(run)]->at(places_[run]), index);
  }

 private:
  [[nodiscard]] std::size_t shard_of(std::size_t run) const {
    const auto after =
        std::partition_point(shards_.begin(), shards_.end(), [&](const Shard& shard) {
          return shard.begin(shard.index, per_method_) <= run % per_method_;
        });
    return static_cast<std::size_t>(after - shards_.begin());
  }

  void add(const std::string& sweep, const FoundShard& found) {
    const std::string path = (found.folder / (sweep + ".rows")).string();
    files_.push_back(std::make_unique<RecordFile>(path));
    shards_.push_back(found.shard);
    if (files_.back()->key() != rows_key(sweep, found.common, text_of(found.shard))) {
      throw InputError(path, 0, "", fmt::format("is not of {}", found.told()));
    }
    files_.back()->scan([&](std::size_t place, std::string_view record) {
      std::size_t index = 0;
      (void)read_row(record, index);
      if (index < places_.size() && found.shard.holds(index % per_method_, per_method_)) {
        places_[index] = place;
      }
    });
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (places_[i] == SweepJournal::none && found.shard.holds(i % per_method_, per_method_)) {
        throw InputError(
            path, 0, "",
            fmt::format("has no row of run {}: the file of {} is damaged; run it again", i,
                        found.told()));
      }
    }
  }

  std::size_t per_method_;
  std::vector<std::size_t> places_;  ///< of rows, in the file of their shard
  std::vector<std::unique_ptr<RecordFile>> files_;
  std::vector<Shard> shards_;
};

}  // namespace

Shard parse_shard(const std::string& text) {
  Shard shard;
  const char* end = text.data() + text.size();
  const auto [slash, bad_index] = std::from_chars(text.data(), end, shard.index);
  const char* after = slash == end ? end : slash + 1;
  const auto [stop, bad_count] = std::from_chars(after, end, shard.count);
  if (bad_index != std::errc() || bad_count != std::errc() || slash == end || *slash != '/' ||
      stop != end || shard.index < 1 || shard.index > shard.count || shard.count > most_shards) {
    throw InputError("", 0, "--shard",
                     fmt::format("'{}' is not allowed; allowed: I/N, I from 1 to N, N up to {}",
                                 text, most_shards));
  }
  return shard;
}

ExperimentOutcome run_shard(const ExperimentSpec& spec, const ExperimentOptions& options,
                            const Shard& shard, const std::string& folder) {
  if (!spec.program.empty()) {
    throw InputError(spec.path, spec.program_line, "program",
                     "is no sweep; shards are of sweeps alone");
  }
  const auto start = std::chrono::steady_clock::now();
  const Facts common = common_facts(spec, options.size);
  Facts facts{{"shard", text_of(shard)}, {"path", spec.path}};
  facts.insert(facts.end(), common.begin(), common.end());
  OutputFolder out(folder, {.seal = seal, .begins = "key,value\nshard,", .replace = options.force});
  out.file("spec.toml").write(text_or_nothing(spec.path));
  out.file(seal).write(table_of(facts));
  ExperimentOutcome outcome;
  for (const SweepSpec& sweep : spec.sweeps) {
    outcome.runs +=
        run_rows(sweep, options.threads, (fs::path(folder) / (sweep.name + ".rows")).string(),
                 rows_key(sweep.name, common, text_of(shard)), shard);
  }
  out.publish();
  outcome.run_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return outcome;
}

ExperimentOutcome merge_shards(const std::vector<std::string>& folders, bool force,
                               const std::string& out) {
  std::vector<FoundShard> found;
  for (const std::string& folder : folders) {
    const std::size_t before = found.size();
    look_for_shards(folder, 2, found);
    if (found.size() == before) {
      throw InputError(folder, 0, "--merge", "holds no shard of a sweep");
    }
  }
  check_shards(found);
  const FoundShard& first = found.front();
  const std::string text = read_text_file((first.folder / "spec.toml").string());
  const Size size = first.common.front().second == to_string(Size::full) ? Size::full : Size::quick;
  const ExperimentSpec spec = parse_experiment(text, first.spec_path, size);
  const std::string command =
      fmt::format("kairos sweep {} --{} --out DIR", first.spec_path, to_string(size));
  return publish_sweeps(
      spec, {size, 0, command, force}, text,
      [&found](const SweepSpec& sweep, const SweepSinks& sinks) {
        const SweepPlan plan(sweep);
        const MergedRows rows(sweep, plan, found);
        return write_sweep_tables(sweep, plan, std::cref(rows), sinks);
      },
      out);
}

}  // namespace kairos::experiments
