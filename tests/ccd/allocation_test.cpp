// Queries do not allocate: every `new` of the process is counted.
#include "ccd/certified.hpp"
#include "ccd/conservative_advancement.hpp"
#include "experiments/accuracy/random_query.hpp"
#include "tests/allocations.hpp"
#include "tests/catch.hpp"

using namespace kairos;
using namespace kairos::reference;

TEST_CASE("queries do not allocate", "[ccd][allocation]") {
  const auto certified = ccd::make_certified();
  const auto advancement = ccd::make_conservative_advancement();
  std::vector<Query> queries;
  for (int d = 0; d < difficulties; ++d) {
    for (const ShapeKinds kinds : shape_kinds) {
      queries.push_back(random_query(static_cast<Difficulty>(d), kinds, 3));
    }
  }
  const std::size_t before = test::allocations();
  int answers = 0;
  for (const Query& q : queries) {
    answers += q.ask(*certified).evaluations + q.ask(*advancement).evaluations;
    answers += certified->overlaps(q.a, q.motion_a.pose(0), q.b, q.motion_b.pose(0)) ? 1 : 0;
    answers += certified->swept_overlap(q.moving_a(), q.moving_b(), q.window()) ? 1 : 0;
    const TimeOfImpact parting =
        certified->time_of_separation(q.moving_a(), q.moving_b(), q.window(), 0.0);
    answers += parting.evaluations;
  }
  const std::size_t after = test::allocations();
  CHECK(answers > 0);
  CHECK(after == before);
}
