#pragma once

#include "experiments/random/scene_trial.hpp"

#include <cstdint>
#include <map>
#include <string>

namespace kairos::experiments {

/// Scenes that stopped for one reason.
struct Stops {
  std::uint64_t scenes = 0;
  std::uint64_t first = 0;  ///< the least of their numbers

  void add(const Stops& other);
  void persist(Archive& archive);
};

/// What many trials came to. Sums: the order in which trials are added does not matter.
struct Tally {
  std::map<Fate, std::uint64_t> fates;
  std::map<std::string, Stops> stops;       ///< by reason, without names and numbers
  std::map<std::uint64_t, Trial> failures;  ///< by number of the scene
  std::uint64_t scenes = 0;
  std::int64_t impacts = 0;
  double seconds = 0.0;  ///< of processor time

  void add(std::uint64_t number, const Trial& trial);
  void add(const Tally& other);
  [[nodiscard]] std::uint64_t of(Fate fate) const;
  void persist(Archive& archive);
};

}  // namespace kairos::experiments
