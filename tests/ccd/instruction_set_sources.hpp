// Included once by each of the sources instruction_set_*.cpp, which say under which names and for
// which processor these three files are compiled once more. No once guard: the sources have one
// meaning each.
#define filter_balls KAIROS_NAMED(filter_balls)
#define boxes_overlap KAIROS_NAMED(boxes_overlap)
#define boxes_apart KAIROS_NAMED(boxes_apart)
#define greatest_separation KAIROS_NAMED(greatest_separation)
#define classify KAIROS_NAMED(classify)
#define all_separations_below KAIROS_NAMED(all_separations_below)
#define BoxBatch KAIROS_NAMED(BoxBatch)
#define classify_batch KAIROS_NAMED(classify_batch)
#define greatest_separation_batch KAIROS_NAMED(greatest_separation_batch)

#include "ccd/ball_filter.cpp"
#undef KAIROS_INLINE
#include "ccd/box_batch.cpp"
#undef KAIROS_INLINE
#include "ccd/box_separations.cpp"
#include "tests/ccd/instruction_set.hpp"

namespace kairos::ccd {
namespace {

AxisSeparation greatest(const RelativeBoxes& boxes) { return greatest_separation(boxes); }

int verdicts(const RelativeBoxes& boxes) {
  const Matrix3 unturned = Matrix3::Identity();
  return static_cast<int>(classify(boxes)) + (boxes_overlap(boxes) ? 10 : 0) +
         (boxes_apart(boxes) ? 100 : 0) +
         (all_separations_below(boxes.half_a, unturned, boxes.half_b, boxes.axes_A, boxes.d_A, 0.0)
              ? 1000
              : 0);
}

void batch(const std::vector<RelativeBoxes>& boxes, std::span<Verdict> verdicts,
           std::span<AxisSeparation> separations, std::span<double> errors) {
  BoxBatch pairs;
  pairs.reserve(boxes.size());
  for (const RelativeBoxes& each : boxes) {
    pairs.push_back(each);
  }
  classify_batch(pairs, verdicts);
  greatest_separation_batch(pairs, separations, errors);
}

}  // namespace
}  // namespace kairos::ccd
