#include "experiments/random/tally.hpp"

#include "core/archive.hpp"

namespace kairos::experiments {
namespace {

template <typename Key, typename Value>
void persist_map(Archive& archive, std::map<Key, Value>& map) {
  std::size_t n = map.size();
  archive.count(n);
  auto at = map.begin();
  for (std::size_t i = 0; i < n; ++i) {
    Key key = archive.reading() ? Key{} : at->first;
    Value value = archive.reading() ? Value{} : (at++)->second;
    archive(key, value);
    map[key] = value;
  }
}

}  // namespace

void Tally::add(std::uint64_t number, const Trial& trial) {
  ++scenes;
  ++fates[trial.fate];
  impacts += trial.impacts;
  if (trial.fate == Fate::stopped) {
    ++stops[trial.reason.substr(0, trial.reason.find(':'))];
  } else if (trial.failed()) {
    failures[number] = trial;
  }
}

void Tally::add(const Tally& other) {
  for (const auto& [fate, n] : other.fates) {
    fates[fate] += n;
  }
  for (const auto& [reason, n] : other.stops) {
    stops[reason] += n;
  }
  failures.insert(other.failures.begin(), other.failures.end());
  scenes += other.scenes;
  impacts += other.impacts;
  seconds += other.seconds;
}

std::uint64_t Tally::of(Fate fate) const {
  const auto found = fates.find(fate);
  return found == fates.end() ? 0 : found->second;
}

void Tally::persist(Archive& archive) {
  persist_map(archive, fates);
  persist_map(archive, stops);
  persist_map(archive, failures);
  archive(scenes, impacts, seconds);
}

}  // namespace kairos::experiments
