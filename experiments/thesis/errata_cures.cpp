#include "experiments/rally/interval.hpp"
#include "experiments/rally/rally_run.hpp"
#include "experiments/thesis/errata.hpp"
#include "experiments/thesis/errata_runs.hpp"
#include "experiments/thesis/phase_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

// Errata about the two cures of 9.1.1.2, and what 9.1.3 says of them.

namespace kairos::experiments::thesis {
namespace {

/// Fraction of n places of the ball at which the bat, swinging at f from a phase, passes through
/// it.
double bat_passes(double f, double phase, int n) {
  RunChoice choice = substep_choice("geometric");
  choice.frames = FixedFrames{frame};
  choice.duration = 1.0 / f;
  double passed = 0.0;
  for (int k = 0; k < n; ++k) {
    const Scene scene = shipped(
        "bat", {{"body.bat.drive.frequency", fmt::format("{}", f)},
                {"body.bat.drive.phase", fmt::format("{}", phase)},
                {"body.ball.position", fmt::format("[{}, 0, 0]", 0.05 + 0.3 * (k + 0.5) / n)}});
    passed += std::min(1.0, measured_run(scene, choice, "crossings").value);
  }
  return passed / n;
}

}  // namespace

std::vector<Check> one_contact_a_frame(Size size) {
  const int n = size == Size::full ? 200 : 50;
  std::vector<Check> checks;
  for (const double f : {2.0, 8.0}) {
    checks.push_back({fmt::format("bat at {:g} Hz from rest: fraction that passes", f), "", 0.0,
                      bat_passes(f, -0.5 * std::numbers::pi, n), Agreement::equal, 0.0, "exact"});
  }
  checks.push_back({"bat at 8 Hz, started in full swing: fraction that passes", "", 0.0,
                    bat_passes(8.0, 0.0, n), Agreement::more_than, 0.0, "", Evidence::observation});
  checks.push_back({"two walls 0.6 m apart, 0.5 m a frame: fraction that gets out in 1 s", "", 0.0,
                    corridor_left(30.0, n), Agreement::equal, 0.0, "exact"});
  checks.push_back({"two walls 0.6 m apart, 0.67 m a frame: fraction that gets out in 1 s", "", 0.0,
                    corridor_left(40.0, n), Agreement::more_than, 0.0, "", Evidence::observation});
  return checks;
}

std::vector<Check> literal_substeps(Size size) {
  const int n = size == Size::full ? 2000 : 250;
  const double threshold = 0.5 * bullet_length;
  std::vector<Check> checks;
  for (const double speed : {2.0, 2.5, 3.0, 4.0, 6.0, 8.0, 20.0, 25.0}) {
    checks.push_back(
        {fmt::format("fraction through the wall at {:g} m/s, fig. 15 literally, threshold 3 cm",
                     speed),
         "", literal_passes(speed, threshold),
         tunnelled_fraction(substep_choice("substepped"), speed, n), Agreement::equal, 1.0 / n,
         "one phase"});
  }
  checks.push_back({"the same at 2 m/s, original", "", 0.0,
                    tunnelled_fraction(substep_choice("original"), 2.0, n / 8), Agreement::equal,
                    0.0, "exact"});
  checks.push_back({"the same at 20 m/s, equal substeps", "", 0.0,
                    tunnelled_fraction(substep_choice("substepped", true), 20.0, n / 8),
                    Agreement::equal, 0.0, "exact"});
  checks.push_back({"the same at 20 m/s, bisected", "", 0.0,
                    tunnelled_fraction(substep_choice("bisected"), 20.0, n / 8), Agreement::equal,
                    0.0, "exact"});
  return checks;
}

std::vector<Check> cure_of_the_bat(Size size) {
  const int rallies = size == Size::full ? 100 : 10;
  const std::vector<RallyMethod> methods = rally_methods();
  std::vector<Check> checks;
  for (const auto& [name, quantity] :
       {std::pair{"original", "strokes that pass, original"},
        {"substepped, 0.0275 m", "the same, fig. 15 literally, threshold 2.75 cm"},
        {"original, boxes", "strokes that pass, original with the thesis' boxes"},
        {"substepped, 0.0275 m, boxes", "the same, fig. 15 literally, threshold 2.75 cm"}}) {
    const auto method = std::find_if(methods.begin(), methods.end(),
                                     [&](const RallyMethod& x) { return x.name == name; });
    std::vector<Cluster> passed;
    for (int r = 0; r < rallies; ++r) {
      passed.push_back(
          play(make_rally({.seed = 1999 + static_cast<std::uint64_t>(r)}), *method).passed());
    }
    const Interval share = share_interval(passed);
    checks.push_back({fmt::format("{} (95 %: {:.0f} to {:.0f})", quantity, 100.0 * share.low,
                                  100.0 * share.high),
                      "%", 0.0, 100.0 * share.estimate, Agreement::more_than, 0.0, "",
                      Evidence::observation});
  }
  return checks;
}

}  // namespace kairos::experiments::thesis
