#pragma once

#include "ccd/relative_boxes.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace kairos::ccd {

/// Many pairs of boxes, component by component, so that as many beside each other are looked at at
/// once as the processor's registers hold: eight, four or two. Their numbers are finite.
class BoxBatch {
 public:
  /// half_a, half_b, d_A and the columns of axes_A of `RelativeBoxes`.
  static constexpr std::size_t components = 18;

  /// Room for so many pairs, so that `push_back` does not allocate.
  void reserve(std::size_t pairs);
  /// No pair is left; the room is.
  void clear();
  /// Appends a pair.
  void push_back(const RelativeBoxes& boxes);
  /// How many pairs there are.
  [[nodiscard]] std::size_t size() const { return values_[0].size(); }
  /// Pair i < size().
  [[nodiscard]] RelativeBoxes at(std::size_t i) const;
  /// One component of the pair i and of those that follow it.
  [[nodiscard]] const double* component(std::size_t which, std::size_t i) const {
    return values_[which].data() + i;
  }

 private:
  std::array<std::vector<double>, components> values_;
};

/// `classify` of each pair, the same verdicts. Throws `std::invalid_argument` unless `verdicts` has
/// the size of the batch.
void classify_batch(const BoxBatch& pairs, std::span<Verdict> verdicts);
/// `greatest_separation` of each pair, the same bits, and what bounds their rounding (as
/// `RelativeBoxes::error`, summed in another order), m, where `errors` is not empty. Throws
/// `std::invalid_argument` where a size is not that of the batch.
void greatest_separation_batch(const BoxBatch& pairs, std::span<AxisSeparation> separations,
                               std::span<double> errors);

}  // namespace kairos::ccd
