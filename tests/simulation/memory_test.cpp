#include "core/free_memory.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/simulate.hpp"
#include "tests/catch.hpp"
#include "tests/sanitizers.hpp"

#include <algorithm>

#if defined(__GLIBC__) && !defined(KAIROS_SANITIZED_MEMORY)
#if __GLIBC_PREREQ(2, 33)
#include <malloc.h>
#define KAIROS_COUNTS_MEMORY
#endif
#endif

using namespace kairos;

#ifdef KAIROS_COUNTS_MEMORY
namespace {

/// What the process has taken and not given back, bytes.
double taken() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

/// Looks while the run is there.
class Look : public Recorder {
 public:
  void frame(const Frame& /*frame*/) override { most = std::max(most, taken()); }
  double most = 0.0;
};

}  // namespace

// Who is told that memory has no room must be told so neither too late nor far too early.
TEST_CASE("a ball takes as much memory as is said, and not much less", "[memory]") {
  constexpr double balls = 20'000.0;
  const double before = taken();
  const Model model(
      parse_scene("duration = 0.01\nframe = 0.005\nG = 0\n"
                  "[[many]]\nname = \"ball\"\nentity = \"ball\"\ncount = 20000\n"
                  "radius = 0.01\nmass = 1\nvelocity_deviation = 1\n"
                  "region = {min = [0, 0, 0], max = [1, 1, 1]}\n",
                  "balls.toml"));
  const double of_model = taken() - before;
  Look look;
  const RunResult result = simulate(model, {}, look);
  REQUIRE(result.cost.impacts > 100);
  const double of_run = look.most - before - of_model;
  CAPTURE(of_model / balls, of_run / balls);
  CHECK(of_model <= bytes_in_model * balls);
  CHECK(of_model >= 0.5 * bytes_in_model * balls);
  CHECK(of_run <= bytes_in_run * balls);
  CHECK(of_run >= 0.5 * bytes_in_run * balls);
}
#endif
