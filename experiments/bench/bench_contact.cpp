#include "core/joint.hpp"
#include "core/scene.hpp"
#include "experiments/bench/bench.hpp"
#include "experiments/bench/contact_peers.hpp"
#include "simulation/scene_builder.hpp"
#include "simulation/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace kairos::experiments {
namespace {

constexpr double g = 9.8;  // m/s^2

std::string name_of(int i) { return fmt::format("b{:03}", i); }

Scene scene_of(const ContactTask& task) {
  const bool stack = task.kind == ContactTask::Kind::stack;
  SceneBuilder scene("bench-contact");
  scene.set("duration", task.frame * static_cast<double>(task.steps));
  scene.set("frame", task.frame);
  scene.set("G", g);
  scene.set("friction", stack ? 0.5 : 0.0);
  if (stack) {
    scene.body("floor", {{"entity", "wall"}, {"shape", "half-space"}});
  }
  for (int i = 0; i < task.bodies; ++i) {
    scene.body(name_of(i), {{"entity", "body"},
                            {"half_extents", task.half()},
                            {"mass", 1},
                            {"restitution", 0},
                            {"position", task.place(i)}});
  }
  for (int i = 0; !stack && i < task.bodies; ++i) {
    const std::vector<std::string> bodies =
        i == 0 ? std::vector<std::string>{name_of(0)}
               : std::vector<std::string>{name_of(i - 1), name_of(i)};
    scene.add("joint", {{"kind", "ball"},
                        {"bodies", bodies},
                        {"anchor", Vector3(task.place(i) - Vector3(task.half().x(), 0.0, 0.0))}});
  }
  return scene.scene();
}

ContactPeer kairos_with(const std::string& scheme) {
  return {"kairos, " + scheme, [scheme](const ContactTask& task) {
            RunChoice choice;
            choice.method.scheme = scheme;
            Recorder nobody;
            const Model model(scene_of(task));
            const RunResult result = simulate(model, choice, nobody);
            std::vector<BodyState> bodies;
            if (result.status == RunStatus::completed) {
              for (BodyIndex i = 0; i < model.size(); ++i) {
                if (model.is_free(i)) {
                  bodies.push_back(result.state[i]);
                }
              }
            }
            return bodies;
          }};
}

/// How far off a task ended.
struct Faults {
  double sinking = 0.0;  ///< m, of the highest box of a stack; of a chain the widest joint
  double drift = 0.0;    ///< m, the farthest sideways, of a stack
  double energy = 0.0;   ///< relative: of a chain, to m g times its length
};

Faults faults_of(const ContactTask& task, const std::vector<BodyState>& bodies) {
  Faults faults;
  if (task.kind == ContactTask::Kind::stack) {
    faults.sinking = task.place(task.bodies - 1).y() - bodies.back().pose.position.y();
    for (const BodyState& body : bodies) {
      faults.drift =
          std::max(faults.drift, std::hypot(body.pose.position.x(), body.pose.position.z()));
    }
    return faults;
  }
  const Vector3 half = task.half();
  const Vector3 end(half.x(), 0.0, 0.0);
  const Vector3 moments = solid_inertia(Box{half}, 1.0);
  Vector3 hung = Vector3::Zero();
  double energy = 0.0;
  for (const BodyState& body : bodies) {
    faults.sinking = std::max(faults.sinking, (body.pose.to_world(-end) - hung).norm());
    hung = body.pose.to_world(end);
    const Vector3 w = body.pose.orientation.conjugate() * body.twist.angular;
    energy += g * body.pose.position.y() + 0.5 * body.twist.linear.squaredNorm() +
              0.5 * w.dot(moments.cwiseProduct(w));
  }
  faults.energy = energy / (g * task.bodies * task.bodies * 2.0 * half.x());
  return faults;
}

void bench_task(const ContactTask& task, const std::vector<ContactPeer>& peers, int rounds) {
  std::vector<std::vector<BodyState>> ends(peers.size());
  std::vector<Contender> contenders;
  for (std::size_t k = 0; k < peers.size(); ++k) {
    contenders.push_back({peers[k].name, [&, k] {
                            ends[k] = peers[k].run(task);
                            return task.steps;
                          }});
  }
  const std::vector<Timing> timings = race(contenders, rounds);
  const bool stack = task.kind == ContactTask::Kind::stack;
  fmt::print(
      "{} of {}, {:.3g} s at {:.0f} frames a second; the least of {} rounds in turn\n  "
      "{:<28}{:>14}{:>16}{:>16}\n",
      stack ? "Stack" : "Chain", task.bodies, task.frame * static_cast<double>(task.steps),
      1.0 / task.frame, rounds, "", "us a frame", stack ? "sinks, mm" : "widest gap, mm",
      stack ? "drifts, mm" : "energy error");
  for (std::size_t k = 0; k < peers.size(); ++k) {
    fmt::print("  {:<28}{:>14.3g}", timings[k].name, 1e-3 * timings[k].nanoseconds);
    if (ends[k].empty()) {
      fmt::print("{:>16}\n", "stopped");
      continue;
    }
    const Faults faults = faults_of(task, ends[k]);
    fmt::print("{:>16.3g}{:>16.3g}{}\n", 1e3 * faults.sinking,
               stack ? 1e3 * faults.drift : faults.energy,
               stack && faults.sinking > task.half().y() ? "  has fallen" : "");
  }
}

}  // namespace

void bench_contact(int rounds) {
  std::vector<ContactPeer> peers;
  for (const auto& found : {bullet_contact_peers(), ode_contact_peers(), box2d_contact_peers()}) {
    peers.insert(peers.end(), found.begin(), found.end());
  }
  const auto with = [&](std::vector<ContactPeer> own) {
    own.insert(own.end(), peers.begin(), peers.end());
    return own;
  };
  bench_task({.kind = ContactTask::Kind::stack, .bodies = 10},
             with({kairos_with("event-driven"), kairos_with("pgs"), kairos_with("xpbd")}), rounds);
  bench_task({.kind = ContactTask::Kind::stack, .bodies = 100}, with({kairos_with("event-driven")}),
             rounds);
  bench_task({.kind = ContactTask::Kind::chain, .bodies = 2, .steps = 120},
             with({kairos_with("event-driven")}), rounds);
  bench_task({.kind = ContactTask::Kind::chain, .bodies = 10, .steps = 120},
             with({kairos_with("event-driven")}), rounds);
}

}  // namespace kairos::experiments
