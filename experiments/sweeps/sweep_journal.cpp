#include "experiments/sweeps/sweep_journal.hpp"

#include "core/archive.hpp"
#include "core/reading/scene_reader.hpp"
#include "experiments/checkpoint/run_identity.hpp"
#include "experiments/output/fingerprint.hpp"
#include "experiments/output/text_or_nothing.hpp"
#include "simulation/option.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kairos::experiments {

// Found by the archive's argument-dependent lookup.
static void persist(Archive& archive, SeriesRecorder::Sample& sample) {
  archive(sample.time, sample.frame, sample.kinetic, sample.potential, sample.gain, sample.lines,
          sample.unexplained);
}
static void persist(Archive& archive, ApexWatch::Apex& apex) { archive(apex.time, apex.height); }

namespace {

void persist_row(Archive& archive, std::size_t& index, RunRecord& record) {
  archive(index, record.status, record.reason, record.metrics, record.samples, record.apexes,
          record.seconds);
}

}  // namespace

RunRecord read_row(std::string_view bytes, std::size_t& index) {
  Archive archive(bytes);
  RunRecord row;
  persist_row(archive, index, row);
  return row;
}

SweepJournal::SweepJournal(const std::string& path, const std::string& key, std::size_t runs)
    : places_(runs, none), journal_(path, key, [this](std::size_t place, std::string_view record) {
        std::size_t index = 0;
        (void)read_row(record, index);
        if (index < places_.size()) {  // else not written by us
          places_[index] = place;
        }
      }) {}

std::size_t SweepJournal::size() const {
  return places_.size() -
         static_cast<std::size_t>(std::count(places_.begin(), places_.end(), none));
}

void SweepJournal::add(std::size_t index, RunRecord& record) {
  Archive archive;
  persist_row(archive, index, record);
  places_[index] = journal_.add(archive.bytes());
}

std::string sweep_key(const SweepSpec& spec, const SweepPlan& plan, const std::string& scene) {
  std::string key = fmt::format("{} {} {} {} {} {}\n", spec.name, spec.subject, spec.series,
                                spec.samples, fmt::join(spec.metrics, " "), plan.size());
  key += program_identity() + "\n";
  key += text_or_nothing(scene);
  Fingerprint sum;  // of a plan that may be longer than there is memory
  sum.add(key);
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const PlannedRun run = plan[i];
    sum.add(fmt::format("{} {} {}\n", run.index, run.method, run.refused));
    for (const Override& o : run.overrides) {
      sum.add(fmt::format("{}={}\n", o.key, o.value));
    }
    for (const auto& [name, value] : identity_of(run.choice)) {
      sum.add(fmt::format("{}={}\n", name, value));
    }
  }
  return "kairos sweep 2 " + sum.text();
}

}  // namespace kairos::experiments
