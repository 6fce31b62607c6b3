// Contract of BroadPhase, run over every plug-in by name: what it returns is exactly who could be
// near (all pairs: everybody), in ascending order, whatever the history of updates.
#include "ccd/all_pairs.hpp"
#include "ccd/dynamic_tree.hpp"
#include "ccd/sweep_and_prune.hpp"
#include "experiments/accuracy/reference.hpp"
#include "tests/catch.hpp"

#include <algorithm>

using namespace kairos;

namespace {

using Maker = std::unique_ptr<BroadPhase> (*)(std::size_t);
constexpr Maker makers[] = {ccd::make_all_pairs, ccd::make_sweep_and_prune, ccd::make_dynamic_tree};

Aabb random_box(reference::Random& random, double world) {
  const Vector3 centre = random.vector(world);
  const Vector3 half(random.uniform(0.0, 1.0), random.uniform(0.0, 1.0), random.uniform(0.0, 3.0));
  return {centre - half, centre + half};
}

}  // namespace

TEST_CASE("broad phases find every overlapping box and are in order", "[ccd][broad-phase]") {
  for (const Maker make : makers) {
    constexpr std::size_t bodies = 120;
    const auto phase = make(bodies);
    CAPTURE(std::string(phase->name()));
    reference::Random random(11);
    std::vector<Aabb> boxes(bodies);
    std::vector<bool> known(bodies, false);
    std::vector<BodyIndex> found;
    int wrong = 0;
    for (int update = 0; update < 4000; ++update) {
      const auto body = static_cast<BodyIndex>(random.below(bodies));
      boxes[body] = random_box(random, 6.0);
      if (random.below(40) == 0) {  // a half-space
        boxes[body].lower.setConstant(-std::numeric_limits<double>::infinity());
        boxes[body].upper.x() = boxes[body].upper.z() = std::numeric_limits<double>::infinity();
      }
      known[body] = true;
      phase->update(body, boxes[body]);
      const auto asked = static_cast<BodyIndex>(random.below(bodies));
      if (!known[asked]) {
        continue;
      }
      found.clear();
      phase->candidates(asked, found);
      wrong += std::is_sorted(found.begin(), found.end()) ? 0 : 1;
      for (BodyIndex other = 0; other < bodies; ++other) {
        const bool listed = std::binary_search(found.begin(), found.end(), other);
        const bool near = other != asked && known[other] && boxes[other].overlaps(boxes[asked]);
        const bool exact = phase->name() != "all-pairs";
        wrong += near && !listed ? 1 : 0;
        wrong += exact && listed && !near ? 1 : 0;
      }
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("broad phases append, and know nothing of bodies never registered",
          "[ccd][broad-phase]") {
  for (const Maker make : makers) {
    const auto phase = make(3);
    CAPTURE(std::string(phase->name()));
    phase->update(0, {Vector3::Zero(), Vector3::Ones()});
    phase->update(2, {Vector3::Constant(1.0), Vector3::Constant(2.0)});  // touches body 0
    std::vector<BodyIndex> found{7};
    phase->candidates(0, found);
    CHECK(found == std::vector<BodyIndex>{7, 2});
  }
}
