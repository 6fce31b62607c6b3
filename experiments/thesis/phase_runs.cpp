#include "experiments/thesis/phase_runs.hpp"

#include "core/impact_law.hpp"
#include "core/random.hpp"
#include "experiments/thesis/errata_runs.hpp"
#include "simulation/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kairos::experiments::thesis {
namespace {

constexpr double drop_duration = 1.25;  // s: one bounce and the frames after it

class LossyReflection : public ImpactLaw {
 public:
  explicit LossyReflection(double e) : e_(e) {}
  [[nodiscard]] LawInfo info() const override { return {"lossy-reflection", false, ""}; }
  ImpactEnergy apply(const Contact& /*contact*/, ImpactBody a, ImpactBody b) const override {
    (a.inertia.mass > 0.0 ? a : b).state.twist.linear.y() *= -e_;
    return {};
  }

 private:
  double e_;
};

}  // namespace

Scene drop_at_phase(int k, int n) {
  const double height = 0.5 + G * frame * frame * 58.0 * (57.0 / 2.0 + (k + 0.5) / n);
  return shipped("bounce", {{"body.ball.position", fmt::format("[0, {}, 0]", height)}});
}

double turned_fraction(double jitter, int n) {
  RunChoice choice = thesis_choice(frame, drop_duration);
  double turned = 0.0;
  for (int k = 0; k < n; ++k) {
    choice.frames = JitteredFrames{frame, jitter, 0.0, 10.0, seed + static_cast<std::uint64_t>(k)};
    const Measured run = measured_run(drop_at_phase(k, n), choice, "separating_impacts");
    turned += std::min(1.0, run.value);
  }
  return turned / n;
}

double turned_fraction_lossy(double e, int n) {
  double turned = 0.0;
  for (int k = 0; k < n; ++k) {
    const Model model(drop_at_phase(k, n));
    const Method method{.stepper = find_integrator("thesis-euler"),
                        .detector = find_detector("sat"),
                        .law = std::make_shared<LossyReflection>(e),
                        .broad_phase = find_broad_phase(model.broad_phase()),
                        .swept_bounds = swept_bounds()};
    MetricRecorder recorder({{"separating_impacts"}, ""});
    SchemeOptions options;
    options.frames = FixedFrames{frame};
    options.duration = drop_duration;
    const RunResult result = find_scheme("original")->run(model, method, options, recorder);
    turned += std::min(1.0, recorder.value("separating_impacts", result).value());
  }
  return turned / n;
}

Scene bullet_at_phase(double speed, double phase) {
  return shipped("bullet", {{"body.bullet.velocity", fmt::format("[{}, 0, 0]", speed)},
                            {"body.bullet.position",
                             fmt::format("[{}, 0, 0]", -1.0 - phase * speed * frame)}});
}

RunChoice substep_choice(const std::string& scheme, bool equal_substeps) {
  RunChoice choice;
  choice.method = MethodChoice::thesis();
  choice.method.scheme = scheme;
  if (scheme == "bisected" || scheme == "geometric") {
    choice.method.detector = "bisection";
  }
  choice.equal_substeps = equal_substeps;
  choice.threshold = 0.5 * bullet_length;
  return choice;
}

double tunnelled_fraction(RunChoice choice, double speed, int n) {
  choice.frames = FixedFrames{frame};
  // A ball that is turned back in may need many frames to come out on the other side.
  choice.duration = 2.0 / speed + 20.0 * frame;
  const double shift = Random(seed, static_cast<std::uint64_t>(speed)).uniform();
  double count = 0.0;
  for (int k = 0; k < n; ++k) {
    count += measured_run(bullet_at_phase(speed, (k + shift) / n), choice, "tunnelled").value;
  }
  return count / n;
}

double literal_passes(double speed, double threshold) {
  const double move = speed * frame;
  const double whole = std::floor(move / threshold + 1e-9);  // a rest of roundoff is none
  const double rest = move - whole * threshold;
  return std::fmod(whole, 2.0) == 1.0 ? (threshold - rest) / move : 0.0;
}

double corridor_left(double speed, int n) {
  RunChoice choice = substep_choice("geometric");
  choice.frames = FixedFrames{frame};
  choice.duration = 1.0;
  double out = 0.0;
  for (int k = 0; k < n; ++k) {
    const Scene scene = shipped(
        "corridor",
        {{"body.ball.velocity", fmt::format("[{}, 0, 0]", speed)},
         {"body.ball.position", fmt::format("[{}, 0, 0]", 0.28 * (2.0 * (k + 0.5) / n - 1.0))}});
    out += std::min(1.0, measured_run(scene, choice, "crossings").value);
  }
  return out / n;
}

}  // namespace kairos::experiments::thesis
