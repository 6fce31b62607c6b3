#include "experiments/output/run_files.hpp"

#include "core/archive.hpp"

namespace kairos::experiments {

RunFiles::RunFiles(AtomicFile& trajectory, AtomicFile& events, AtomicFile& energy)
    : RunTables({[&trajectory](std::string_view line) { trajectory.write(line); },
                 [&events](std::string_view line) { events.write(line); },
                 [&energy](std::string_view line) { energy.write(line); }}),
      trajectory_(trajectory),
      events_(events),
      energy_(energy) {}

OutputSet run_output(bool replace) {
  return {.seal = "summary.json", .begins = "{\n  \"scene\": {", .replace = replace};
}

bool RunFiles::persist(Archive& archive) {
  if (archive.reading() && begun_.size() == names.size()) {
    trajectory_.restore(begun_[0]);
    events_.restore(begun_[1]);
    energy_.restore(begun_[2]);
  }
  return true;
}

}  // namespace kairos::experiments
