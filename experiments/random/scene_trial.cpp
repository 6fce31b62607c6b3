#include "experiments/random/scene_trial.hpp"

#include "core/archive.hpp"
#include "core/error.hpp"
#include "core/reading/scene_reader.hpp"
#include "experiments/random/plain_room.hpp"
#include "experiments/random/scene_watch.hpp"
#include "simulation/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace kairos::experiments {
namespace {

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
  for (double* x : {&b.radius, &b.mass, &b.restitution, &b.friction, &b.frequency, &b.phase,
                    &b.length, &b.rounding, &b.unit, &b.spacing, &b.gyration}) {
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
      smaller = fewer_joints() || smaller;
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
    const Trial trial = fate_ == Fate::differs ? try_by_two_searches(smaller) : try_scene(smaller);
    if (trial.fate != fate_) {
      return false;
    }
    scene_ = smaller;
    return true;
  }

  bool fewer_bodies() {
    bool any = false;
    for (std::size_t i = scene_.bodies.size(); i-- > 0;) {
      RandomScene smaller = scene_;
      std::erase_if(smaller.joints, [&](const RandomJoint& joint) {
        return std::find(joint.bodies.begin(), joint.bodies.end(), smaller.bodies[i].name) !=
               joint.bodies.end();
      });
      smaller.bodies.erase(smaller.bodies.begin() + static_cast<std::ptrdiff_t>(i));
      any = (!smaller.bodies.empty() && keep(smaller)) || any;
    }
    return any;
  }

  bool fewer_joints() {
    bool any = false;
    for (std::size_t i = scene_.joints.size(); i-- > 0;) {
      RandomScene smaller = scene_;
      smaller.joints.erase(smaller.joints.begin() + static_cast<std::ptrdiff_t>(i));
      any = keep(smaller) || any;
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

Trial try_model(const Model& model, bool roundoff, RunResult* end = nullptr) {
  SceneWatch watch;
  try {
    RunResult result =
        simulate(model, {.max_events = SceneWatch::most_in_frame, .roundoff = roundoff}, watch);
    const Trial trial = trial_of(result);
    if (end != nullptr) {
      *end = std::move(result);
    }
    return trial;
  } catch (const BrokenPromise& broken) {
    return {broken.fate, broken.what, broken.time, 0};
  }
}

/// A stop where nothing rigid goes on is right, too.
Trial judged(const RandomScene& scene, Trial trial) {
  if (trial.fate == Fate::stopped && leaves_no_room(scene, trial.time, trial.time + scene.frame)) {
    trial.fate = Fate::no_room;
  }
  return trial;
}

}  // namespace

std::string_view to_string(Fate fate) {
  switch (fate) {
    case Fate::right:
      return "right";
    case Fate::no_room:
      return "no room left";
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
    case Fate::apart:
      return "held apart";
    case Fate::differs:
      return "other bits";
    case Fate::joint:
      return "joint open";
    case Fate::friction:
      return "friction drives";
  }
  return "";
}

void Trial::persist(Archive& archive) { archive(fate, reason, time, impacts); }

Trial try_scene(const RandomScene& scene) {
  try {
    const Model model(parse_scene(scene.toml(), scene.name + ".toml"));
    const Trial trial = try_model(model, false);
    // Roundoff is replayed only for failures of the ledger.
    return judged(scene, trial.fate == Fate::ledger ? try_model(model, true) : trial);
  } catch (const InputError& error) {
    return {Fate::invalid, error.what(), 0.0, 0};
  }
}

Trial try_by_two_searches(const RandomScene& scene) {
  try {
    const std::string text = scene.toml();
    std::array<RunResult, 2> ends;
    std::array<Trial, 2> trials;
    for (std::size_t k = 0; k < 2; ++k) {
      ModelOptions options;
      options.broad_phase = k == 0 ? "cells" : "all-pairs";
      const Model model(parse_scene(text, scene.name + ".toml"), options);
      trials[k] = try_model(model, false, &ends[k]);
      if (trials[k].fate == Fate::ledger) {
        trials[k] = try_model(model, true, &ends[k]);
      }
    }
    if (trials[0].failed() || trials[1].failed()) {
      return trials[0].failed() ? trials[0] : trials[1];
    }
    const auto bytes = [](RunResult& end) {
      Archive archive;
      archive(end.end, end.state, end.ledger, end.reason);
      return archive.bytes();
    };
    if (trials[0].impacts != trials[1].impacts || bytes(ends[0]) != bytes(ends[1])) {
      return {Fate::differs,
              fmt::format("{} impacts by cells, {} with every pair asked", trials[0].impacts,
                          trials[1].impacts),
              trials[0].time, trials[0].impacts};
    }
    return trials[0];
  } catch (const InputError& error) {
    return {Fate::invalid, error.what(), 0.0, 0};
  }
}

RandomScene shrink(const RandomScene& scene, Fate fate) { return Shrinker(scene, fate).smallest(); }

}  // namespace kairos::experiments
