#include "experiments/random/scene_trial.hpp"

#include "core/archive.hpp"
#include "core/error.hpp"
#include "core/impact_check.hpp"
#include "core/reading/scene_reader.hpp"
#include "experiments/random/plain_overlap.hpp"
#include "simulation/simulate.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace kairos::experiments {
namespace {

/// More events in a frame than any of these scenes has: they last for a few crossings of the room.
/// A run that takes more must stop by itself.
constexpr std::int64_t most_in_frame = 20'000;
/// And in all frames, of which there are 64 and one.
constexpr std::int64_t most_events = 66 * most_in_frame;

struct BrokenPromise {
  Fate fate;
  std::string what;
  double time;
};

/// Ends the run at the first promise that is broken.
class Watch : public Recorder {
 public:
  void begin(const Model& model) override { model_ = &model; }
  void frame(const Frame& frame) override {
    check_overlap(frame.bodies, frame.time);
    const double allowed = 8.0 * std::numeric_limits<double>::epsilon() * frame.ledger.flow();
    if (std::abs(frame.ledger.unexplained()) > allowed) {
      throw BrokenPromise{
          Fate::ledger,
          fmt::format("{} J unexplained, allowed {}", frame.ledger.unexplained(), allowed),
          frame.time.seconds};
    }
    if (frame.index > most_events) {
      throw BrokenPromise{Fate::hang, "frames without end", frame.time.seconds};
    }
  }
  void event(const Event& event) override {
    if (event.kind == EventKind::impact) {
      check_pair(event.a, event.before_a, event.b, event.before_b, event.time);
    }
    if (++events_ > most_events) {
      throw BrokenPromise{Fate::hang, fmt::format("{} events", events_), event.time.seconds};
    }
    if (event.kind == EventKind::impact) {
      check_impact(event);
    }
  }

 private:
  void check_impact(const Event& event) {
    if (event.contact.friction > 0.0) {
      return;  // restitution is then one of work, not of velocities
    }
    const double e = model_->restitution(event.a, event.b);
    if (const std::string broken = broken_restitution(event, e); !broken.empty()) {
      throw BrokenPromise{Fate::law,
                          fmt::format("'{}' and '{}': {}", model_->body(event.a).name,
                                      model_->body(event.b).name, broken),
                          event.time.seconds};
    }
  }

  void check_overlap(std::span<const BodyState> bodies, Instant t) {
    for (const auto& [a, b] : model_->pairs()) {
      if (model_->is_field(a) || model_->is_field(b) ||
          !(model_->is_free(a) || model_->is_free(b))) {
        continue;
      }
      check_pair(a, bodies[a], b, bodies[b], t);
    }
  }

  /// By geometry of its own, which no detector shares.
  void check_pair(BodyIndex a, const BodyState& state_a, BodyIndex b, const BodyState& state_b,
                  Instant t) const {
    const double depth =
        plain_depth(model_->shape(a), state_a.pose, model_->shape(b), state_b.pose);
    double scale = state_a.pose.position.norm() + state_b.pose.position.norm();
    for (const BodyIndex i : {a, b}) {
      const double radius = bounding_radius(model_->shape(i));
      scale += std::isfinite(radius) ? radius : 0.0;
    }
    // Bodies in touch may stay so to 16 times the bound of a gap's rounding, 12 eps of what it is a
    // sum of (ccd/README.md, a start in touch); less is no overlap that could be told from none.
    constexpr double hidden = 16.0 * 12.0 * std::numeric_limits<double>::epsilon();
    if (depth > hidden * scale) {
      throw BrokenPromise{Fate::overlap,
                          fmt::format("'{}' is {:.3g} m inside '{}'", model_->body(b).name, depth,
                                      model_->body(a).name),
                          t.seconds};
    }
  }

  const Model* model_ = nullptr;
  std::int64_t events_ = 0;
};

Trial trial_of(const RunResult& result) {
  Trial trial{Fate::right, result.reason, result.end.seconds, result.cost.impacts};
  if (result.status == RunStatus::stopped) {
    trial.fate = result.reason.starts_with("not finite") ? Fate::not_finite : Fate::stopped;
  }
  return trial;
}

double rounded(double x, int digits) { return std::stod(fmt::format("{:.{}g}", x, digits)); }

Vector3 rounded(const Vector3& v, int digits) {
  return {rounded(v[0], digits), rounded(v[1], digits), rounded(v[2], digits)};
}

void simplify_numbers(RandomBody& b, int digits) {
  for (double* x : {&b.radius, &b.mass, &b.restitution, &b.frequency, &b.phase, &b.length,
                    &b.rounding, &b.unit, &b.spacing, &b.gyration}) {
    *x = rounded(*x, digits);
  }
  for (Vector3* v : {&b.half_extents, &b.position, &b.velocity, &b.turned, &b.spin, &b.swing}) {
    *v = rounded(*v, digits);
  }
  for (Vector3& x : b.points) {
    x = rounded(x, digits);
  }
  for (double& x : b.heights) {
    x = rounded(x, digits);
  }
  for (RandomBody& part : b.parts) {
    simplify_numbers(part, digits);
  }
}

void simplify_numbers(RandomScene& scene, int digits) {
  scene.duration = rounded(scene.duration, digits);
  scene.frame = rounded(scene.frame, digits);
  scene.G = rounded(scene.G, digits);
  for (RandomBody& b : scene.bodies) {
    simplify_numbers(b, digits);
  }
}

/// Tries smaller scenes and keeps those that still fail.
class Shrinker {
 public:
  Shrinker(RandomScene scene, Fate fate) : scene_(std::move(scene)), fate_(fate) {}

  RandomScene smallest() {
    for (bool smaller = true; smaller && tries_ < most_tries;) {
      smaller = fewer_bodies();
      smaller = shorter() || smaller;
      smaller = stiller() || smaller;
    }
    for (const int digits : {2, 3, 5, 8}) {
      RandomScene rough = scene_;
      simplify_numbers(rough, digits);
      if (keep(rough)) {
        break;
      }
    }
    return std::move(scene_);
  }

 private:
  static constexpr int most_tries = 400;

  bool keep(const RandomScene& smaller) {
    ++tries_;
    if (try_scene(smaller).fate != fate_) {
      return false;
    }
    scene_ = smaller;
    return true;
  }

  bool fewer_bodies() {
    bool any = false;
    for (std::size_t i = scene_.bodies.size(); i-- > 0;) {
      RandomScene smaller = scene_;
      smaller.bodies.erase(smaller.bodies.begin() + static_cast<std::ptrdiff_t>(i));
      any = (!smaller.bodies.empty() && keep(smaller)) || any;
    }
    return any;
  }

  bool shorter() {
    const double end = try_scene(scene_).time;
    RandomScene smaller = scene_;
    smaller.duration = 1.1 * end;
    return end > 0.0 && smaller.duration < 0.9 * scene_.duration && keep(smaller);
  }

  bool stiller() {
    bool any = false;
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      for (const auto member :
           {&RandomBody::spin, &RandomBody::turned, &RandomBody::swing, &RandomBody::velocity}) {
        RandomScene smaller = scene_;
        Vector3& v = smaller.bodies[i].*member;
        if (!v.isZero(0.0)) {
          v.setZero();
          any = keep(smaller) || any;
        }
      }
    }
    if (scene_.G != 0.0) {
      RandomScene smaller = scene_;
      smaller.G = 0.0;
      any = keep(smaller) || any;
    }
    return any;
  }

  RandomScene scene_;
  Fate fate_;
  int tries_ = 0;
};

Trial try_model(const Model& model, bool roundoff) {
  Watch watch;
  try {
    return trial_of(simulate(model, {.max_events = most_in_frame, .roundoff = roundoff}, watch));
  } catch (const BrokenPromise& broken) {
    return {broken.fate, broken.what, broken.time, 0};
  }
}

}  // namespace

std::string_view to_string(Fate fate) {
  switch (fate) {
    case Fate::right:
      return "right";
    case Fate::stopped:
      return "stopped";
    case Fate::not_finite:
      return "not finite";
    case Fate::overlap:
      return "overlap";
    case Fate::ledger:
      return "energy unexplained";
    case Fate::hang:
      return "hang";
    case Fate::invalid:
      return "invalid";
    case Fate::law:
      return "law broken";
  }
  return "";
}

void Trial::persist(Archive& archive) { archive(fate, reason, time, impacts); }

Trial try_scene(const RandomScene& scene) {
  try {
    const Model model(parse_scene(scene.toml(), scene.name + ".toml"));
    const Trial trial = try_model(model, false);
    // What steps and impacts lose to roundoff is replayed only where it shows.
    return trial.fate == Fate::ledger ? try_model(model, true) : trial;
  } catch (const InputError& error) {
    return {Fate::invalid, error.what(), 0.0, 0};
  }
}

RandomScene shrink(const RandomScene& scene, Fate fate) { return Shrinker(scene, fate).smallest(); }

}  // namespace kairos::experiments
