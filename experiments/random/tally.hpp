#pragma once

#include "experiments/random/scene_trial.hpp"

#include <cstdint>
#include <map>
#include <string>

namespace kairos::experiments {

/// What many trials came to. Sums: the order in which trials are added does not matter.
struct Tally {
  std::map<Fate, std::uint64_t> fates;
  std::map<std::string, std::uint64_t> stops;  ///< by the word before the colon of their reason
  std::map<std::uint64_t, Trial> failures;     ///< by number of the scene
  std::uint64_t scenes = 0;
  std::int64_t impacts = 0;
  double seconds = 0.0;  ///< of processor time

  void add(std::uint64_t number, const Trial& trial);
  void add(const Tally& other);
  [[nodiscard]] std::uint64_t of(Fate fate) const;
  void persist(Archive& archive);
};

}  // namespace kairos::experiments
