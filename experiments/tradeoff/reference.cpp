#include "experiments/tradeoff/reference.hpp"

#include "core/error.hpp"
#include "core/exact_solution.hpp"
#include "experiments/output/broadcast.hpp"
#include "experiments/progress_bar.hpp"
#include "experiments/run_error.hpp"
#include "experiments/way_of_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace kairos::experiments {
namespace {

/// An impact sooner after the last than this part of the run belongs to an accumulation that no
/// method follows to its end.
constexpr double closest_impacts = 1e-4;

RunChoice tightest(double duration, double tolerance) {
  RunChoice choice;
  choice.duration = duration;
  choice.stepper = {tolerance, tolerance};
  return choice;
}

/// Frames of a run, for the growth of a difference.
class Places : public Recorder {
 public:
  void frame(const Frame& frame) override {
    times.push_back(frame.time.seconds);
    for (const BodyState& s : frame.bodies) {
      positions.push_back(s.pose.position);
    }
  }
  std::vector<double> times;
  std::vector<Vector3> positions;
};

Places places_of(const Model& model, double duration, ProgressBar& bar) {
  Places places;
  WayOfRun way(bar, duration);
  Broadcast recorder({&places, &way});
  RunChoice choice;
  choice.duration = duration;
  (void)simulate(model, choice, recorder);
  bar.advance();
  return places;
}

/// Frames of a run with one body a little beside where it begins.
struct Moved {
  Places places;
  double shift;  ///< m, of that body
};

/// Moves the first free body that has room on one of two sides; nullopt: none has, as in a scene
/// where all touch on both.
std::optional<Moved> moved_a_little(const Model& model, double duration, ProgressBar& bar) {
  for (BodyIndex i = 0; i < model.size(); ++i) {
    if (!model.is_free(i)) {
      continue;
    }
    const double shift = 1e-10 * smallest_extent(model.shape(i));
    for (const double side : {1.0, -1.0}) {
      Scene scene = model.scene();
      scene.bodies[i].initial.pose.position += side * shift * Vector3(0.48, 0.6, 0.64);
      try {
        return Moved{places_of(Model(scene), duration, bar), shift};
      } catch (const InputError&) {
        // It would begin inside another body: of a stack only the last can be moved, upwards.
      }
    }
  }
  return std::nullopt;
}

/// When a small displacement of one body has grown ten thousandfold, s; nullopt: it does not, or
/// none can be displaced. Growth by geometry alone (a ball flies on at another angle) is linear in
/// time and far less.
std::optional<double> time_of_growth(const Model& model, double duration, ProgressBar& bar) {
  constexpr double growth = 1e4;
  const Places plain = places_of(model, duration, bar);
  const auto moved = moved_a_little(model, duration, bar);
  const std::size_t n =
      moved ? std::min(plain.positions.size(), moved->places.positions.size()) : 0;
  for (std::size_t k = 0; k < n; ++k) {
    if ((plain.positions[k] - moved->places.positions[k]).norm() > growth * moved->shift) {
      return plain.times[k / model.size()];
    }
  }
  return std::nullopt;
}

double worst_difference(const std::vector<double>& x, const std::vector<double>& y) {
  double worst = 0.0;
  for (std::size_t k = 0; k < std::min(x.size(), y.size()); ++k) {
    worst = std::max(worst, std::abs(x[k] - y[k]));
  }
  return worst;
}

/// Replaces the answers of the run by those of the exact solution.
void make_exact(const ExactMotion& exact, const Model& model, Reference& reference) {
  reference.kind = "exact solution";
  double position = 0.0;
  for (BodyIndex i = 0; i < model.size(); ++i) {
    if (!reference.positions[i]) {
      continue;
    }
    const auto state = exact.state(i, Instant{} + reference.until);
    if (state) {
      position = std::max(position, (*reference.positions[i] - state->pose.position).norm());
      reference.positions[i] = state->pose.position;
    }
  }
  // The exact solution counts impacts, whoever they are between: it replaces them for one pair.
  if (reference.impacts.size() == 1) {
    std::vector<double>& times = reference.impacts.begin()->second;
    std::vector<double> known;
    for (std::int64_t k = 1; k <= static_cast<std::int64_t>(times.size()); ++k) {
      const auto t = exact.impact_time(k);
      if (!t || *t > reference.until) {
        break;
      }
      known.push_back(*t);
    }
    if (known.size() == times.size()) {
      times = known;
    }
  }
  reference.position_uncertainty = 0.0;
  reference.time_uncertainty = 0.0;
}

/// The kinds of two bodies: a method may be right for one kind of pair and wrong for another.
std::string kind_of(const Model& model, const BodyPair& pair) {
  std::string a(model.entity(pair.first).kind());
  std::string b(model.entity(pair.second).kind());
  return std::min(a, b) + " and " + std::max(a, b);
}

std::vector<std::string> unseen_kinds(const Model& model, const MeasuredRun& whole,
                                      const MeasuredRun& part) {
  std::set<std::string> seen, unseen;
  for (const auto& [pair, times] : part.impacts) {
    seen.insert(kind_of(model, pair));
  }
  for (const auto& [pair, times] : whole.impacts) {
    if (const std::string kind = kind_of(model, pair); seen.count(kind) == 0) {
      unseen.insert(kind);
    }
  }
  return {unseen.begin(), unseen.end()};
}

/// How far free bodies get from where they began, and the size of the largest, m.
double scale_of(const Model& model, double duration, ProgressBar& bar) {
  const Places places = places_of(model, duration, bar);
  const std::size_t n = model.size();
  double scale = 0.0;
  for (std::size_t k = 0; k < places.positions.size(); ++k) {
    if (model.is_free(k % n)) {
      scale = std::max(scale, (places.positions[k] - places.positions[k % n]).norm() +
                                  bounding_radius(model.shape(k % n)));
    }
  }
  return scale;
}

/// Removes the impacts from where they accumulate.
void cut_accumulations(Reference& reference) {
  for (auto& [pair, times] : reference.impacts) {
    for (std::size_t k = 1; k < times.size(); ++k) {
      if (times[k] - times[k - 1] < closest_impacts * reference.until) {
        times.resize(k);
      }
    }
  }
}

}  // namespace

Reference find_reference(const Model& model, double duration) {
  Reference reference;
  ProgressBar bar("reference", 6);  // runs
  RunChoice whole = tightest(duration, 1e-13);
  const MeasuredRun first = measure(model, whole, &bar);
  bar.advance();
  if (!first.completed() && !(first.reached > 0.0)) {
    throw RunError("no reference: event-driven " + first.status + ": " + first.reason);
  }
  const double frame = mean_frame_duration(model.scene().frames);
  reference.until = first.completed() ? duration : first.reached - std::fmod(first.reached, frame);
  if (!(reference.until > 0.0)) {
    throw RunError("no reference: event-driven stops at once: " + first.reason);
  }
  for (const auto& [pair, times] : first.impacts) {
    reference.whole_impacts += static_cast<std::int64_t>(times.size());
  }
  reference.sentence = fmt::format("compared at its end, {:g} s", reference.until);
  if (!first.completed()) {
    reference.sentence = fmt::format("compared up to {:g} s, where event-driven stops ({})",
                                     reference.until, first.reason);
  }
  std::unique_ptr<const ExactMotion> exact;
  try {
    exact = solve_exactly(model.scene());
  } catch (const InputError&) {
    exact = nullptr;  // a value was set that makes it another scene
  }
  if (const auto grown = exact ? std::nullopt : time_of_growth(model, reference.until, bar)) {
    reference.lyapunov = *grown / std::log(1e4);
    reference.until = std::max(frame, frame * std::floor(reference.lyapunov / frame));
    reference.sentence = fmt::format(
        "chaotic: compared up to {:.4g} s, before differences grow (Lyapunov time {:.3g} s); over "
        "the whole {:g} s by its number of impacts, {}",
        reference.until, reference.lyapunov, duration, reference.whole_impacts);
  }

  const MeasuredRun tight = measure(model, tightest(reference.until, 1e-13), &bar);
  bar.advance();
  const MeasuredRun looser = measure(model, tightest(reference.until, 1e-11), &bar);
  bar.advance();
  reference.whole = duration;
  reference.unseen = unseen_kinds(model, first, tight);
  reference.scale = scale_of(model, reference.until, bar);
  reference.kind = "event-driven, tightest";
  reference.impacts = tight.impacts;
  reference.positions.resize(model.size());
  for (BodyIndex i = 0; i < model.size(); ++i) {
    if (model.is_free(i)) {
      reference.positions[i] = tight.end[i].pose.position;
      reference.position_uncertainty =
          std::max(reference.position_uncertainty,
                   (tight.end[i].pose.position - looser.end[i].pose.position).norm());
    }
  }
  for (const auto& [pair, times] : tight.impacts) {
    const auto other = looser.impacts.find(pair);
    reference.time_uncertainty =
        std::max(reference.time_uncertainty,
                 other == looser.impacts.end() ? 0.0 : worst_difference(times, other->second));
  }
  if (exact) {
    make_exact(*exact, model, reference);
  }
  cut_accumulations(reference);
  return reference;
}

Errors errors_of(const MeasuredRun& run, const Reference& reference) {
  Errors errors;
  for (std::size_t i = 0; i < reference.positions.size() && i < run.end.size(); ++i) {
    if (reference.positions[i]) {
      errors.position =
          std::max(errors.position, (run.end[i].pose.position - *reference.positions[i]).norm());
    }
  }
  const auto of = [](const std::map<BodyPair, std::vector<double>>& all, const BodyPair& pair) {
    const auto found = all.find(pair);
    return found == all.end() ? std::vector<double>{} : found->second;
  };
  for (const auto& [pair, times] : reference.impacts) {
    const std::vector<double> ours = of(run.impacts, pair);
    const bool none = ours.empty() && !times.empty();
    errors.event_time = std::max(errors.event_time, none ? std::numeric_limits<double>::infinity()
                                                         : worst_difference(times, ours));
    errors.missed += static_cast<std::int64_t>(times.size()) -
                     static_cast<std::int64_t>(std::min(times.size(), ours.size()));
  }
  errors.penetration = run.metrics.in_frames.depth;
  errors.energy = run.metrics.relative(run.metrics.max_energy_error);
  return errors;
}

}  // namespace kairos::experiments
