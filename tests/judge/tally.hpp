#pragma once

#include "tests/judge/verdict.hpp"

#include <string>
#include <vector>

namespace kairos::judge {

/// Counts over the queries of one class.
class Tally {
 public:
  void add(const TimeOfImpact& answer, const Verdict& verdict, double seconds);
  void add(const Tally& other);
  /// A query that the library does not answer; `wrongly`: it should.
  void refuse(bool wrongly);

  /// Queries with a broken promise.
  [[nodiscard]] std::size_t broken() const { return broken_; }
  [[nodiscard]] static std::string header();
  [[nodiscard]] std::string row(const std::string& name) const;

 private:
  [[nodiscard]] std::string evaluations() const;

  std::array<std::size_t, 4> statuses_{};
  std::array<std::size_t, fault_count> faults_{};
  std::size_t broken_ = 0;
  std::size_t refused_ = 0;
  std::vector<int> evaluations_;
  double slowest_ = 0.0;  ///< s of processor time
};

}  // namespace kairos::judge
