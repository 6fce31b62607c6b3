#include "experiments/random/tally.hpp"

#include "core/archive.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

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

/// The reason up to what is advised, '*' for each name and # for each number.
std::string without_names(std::string_view reason) {
  std::string out;
  for (std::size_t i = 0; i < reason.size() && reason[i] != ';'; ++i) {
    if (reason[i] == '\'') {
      out += "'*'";
      i = std::min(reason.find('\'', i + 1), reason.size());
    } else if (std::isdigit(static_cast<unsigned char>(reason[i])) != 0) {
      out += '#';
      i = std::min(reason.find_first_not_of("0123456789.e+-", i), reason.size()) - 1;
    } else {
      out += reason[i];
    }
  }
  return out;
}

}  // namespace

void Stops::add(const Stops& other) {
  first = scenes == 0 ? other.first : std::min(first, other.first);
  scenes += other.scenes;
}

void Stops::persist(Archive& archive) { archive(scenes, first); }

void Tally::add(std::uint64_t number, const Trial& trial) {
  ++scenes;
  ++fates[trial.fate];
  impacts += trial.impacts;
  if (trial.fate == Fate::stopped) {
    stops[without_names(trial.reason)].add({1, number});
  } else if (trial.failed()) {
    failures[number] = trial;
  }
}

void Tally::add(const Tally& other) {
  for (const auto& [fate, n] : other.fates) {
    fates[fate] += n;
  }
  for (const auto& [reason, n] : other.stops) {
    stops[reason].add(n);
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
