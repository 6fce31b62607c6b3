#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace kairos::experiments {

struct AccuracyOptions {
  std::size_t queries = 100'000;
  std::uint64_t seed = 1;
  std::vector<std::string> detectors{"certified", "conservative-advancement"};
  std::size_t judge_every = 1;  ///< of the answers only these are held against the reference
  std::size_t threads = 0;      ///< 0: one per core
  std::string out;              ///< folder for queries.csv and accuracy.csv; none if empty
  bool force = false;           ///< replaces whatever that holds
};

/// Draws queries over all classes of difficulty and pairs of shapes, answers them with each
/// detector, holds the answers against a reference in long double, and prints a table per class:
/// what was missed, late or undecided, how wide the brackets are, how early the answers. What
/// `certified` leaves undecided is listed and explained. Depends on the seed alone, not on the
/// threads. Returns how many answers of detectors that prove were missed, late or wrong.
std::size_t measure_accuracy(const AccuracyOptions& options);

}  // namespace kairos::experiments
