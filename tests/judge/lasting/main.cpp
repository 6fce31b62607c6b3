// Judges what lasts in contact: runs scenes and looks at them at random times.

#include "core/error.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/scene_library.hpp"
#include "simulation/simulate.hpp"
#include "tests/judge/lasting/self_check.hpp"
#include "tests/judge/lasting/verdict.hpp"
#ifdef KAIROS_JUDGE_RANDOM
#include "experiments/random/random_scene.hpp"
#endif

#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <map>
#include <string>
#include <vector>

using namespace kairos;

namespace {

struct Arguments {
  std::vector<std::string> scenes;
  std::string random;
  std::uint64_t seed = 1;
  std::uint64_t first = 0;
  std::uint64_t count = 100;
  double duration = 0.0;
  bool told = false;
  judge::Look look;
};

void print_head() {
  fmt::print(
      "{:24} {:>7} {:>8} {:>8} {:>8} {:>6} {:>6} {:>6} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} "
      "{:>8}\n",
      "scene", "times", "groups", "sticks", "slides", "slow", "brief", "steps", "depth", "forces",
      "stepped", "creep", "strays", "jump", "gains");
}

/// Whether all is right; told another friction than there is, whether that was found out.
bool judge_scene(const std::string& name, const Scene& scene, const Arguments& args) {
  RunChoice choice;
  if (args.duration > 0.0) {
    choice.duration = args.duration;
  }
  const Model model(scene);
  Trajectory run;
  if (!why_refused(model, choice).empty()) {
    fmt::print("{:24} refused: {}\n", name, why_refused(model, choice));
    return true;
  }
  const RunResult result = simulate(model, choice, run);
  const judge::Verdict v = judge::judge(model, run, result.end, result.ledger, args.look);
  if (!v.refusal.empty()) {
    fmt::print("{:24} not judged: {}\n", name, v.refusal);
    return true;
  }
  fmt::print(
      "{:24} {:7} {:8} {:8} {:8} {:6} {:6} {:6} {:8.1e} {:8.1e} {:8.1e} {:8.1e} {:8.1e} {:8.1e} "
      "{:8.1e}{}\n",
      name, v.instants, v.groups, v.sticking, v.sliding, v.slow, v.brief, v.stepped,
      static_cast<double>(v.depth), static_cast<double>(v.forces), static_cast<double>(v.in_steps),
      static_cast<double>(v.creep), static_cast<double>(v.strays), static_cast<double>(v.jump),
      static_cast<double>(v.gains), result.status == RunStatus::completed ? "" : " stopped");
  std::map<judge::Fault, int> counts;
  for (const judge::Finding& f : v.findings) {
    if (counts[f.fault]++ < (args.told ? 1000 : 3)) {
      fmt::print("  {} at {:.17g} s: {:.3g}, {}\n", to_string(f.fault), static_cast<double>(f.time),
                 static_cast<double>(f.size), f.who);
    }
  }
  for (const auto& [fault, n] : counts) {
    fmt::print("  {}: {}\n", to_string(fault), n);
  }
  std::fflush(stdout);
  if (args.look.friction != 1.0L) {
    return counts.contains(judge::Fault::forces);  // the judge was told what is not so
  }
  return v.right();
}

constexpr const char* usage =
    "usage: judge_contact SCENE... [--times N] [--duration S] [--seed N] [--at S] [--friction F] "
    "[--without-forces] [--told]\n"
    "       judge_contact --random rough|touching --seed N [--first N] [--count N] ...\n"
    "       judge_contact --self-check\n";

int judge_all(int argc, char** argv) {
  Arguments args;
  for (int k = 1; k < argc; ++k) {
    const std::string key = argv[k];
    const auto value = [&] { return std::string(k + 1 < argc ? argv[++k] : ""); };
    if (key == "--times") {
      args.look.times = std::stoi(value());
    } else if (key == "--seed") {
      args.seed = std::stoull(value());
    } else if (key == "--first") {
      args.first = std::stoull(value());
    } else if (key == "--count") {
      args.count = std::stoull(value());
    } else if (key == "--duration") {
      args.duration = std::stod(value());
    } else if (key == "--friction") {
      args.look.friction = std::stod(value());
    } else if (key == "--random") {
      args.random = value();
    } else if (key == "--self-check") {
      return judge::self_check() == 0 ? 0 : 1;
    } else if (key == "--at") {
      args.look.only_at = std::stod(value());
    } else if (key == "--without-forces") {
      args.look.forces = false;
    } else if (key == "--told") {
      args.told = true;
    } else if (key == "--help") {
      fmt::print("{}", usage);
      return 0;
    } else {
      args.scenes.push_back(key);
    }
  }
  args.look.seed = args.seed;
  int wrong = 0;
  print_head();
  for (const std::string& name : args.scenes) {
    wrong += judge_scene(name, read_scene(find_scene(name)), args) ? 0 : 1;
  }
#ifdef KAIROS_JUDGE_RANDOM
  for (std::uint64_t k = args.first; !args.random.empty() && k < args.first + args.count; ++k) {
    const auto scene = args.random == "rough" ? experiments::rough_scene(args.seed, k)
                                              : experiments::touching_scene(args.seed, k);
    wrong += judge_scene(scene.name, parse_scene(scene.toml(), scene.name + ".toml"), args) ? 0 : 1;
  }
#endif
  return wrong == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return judge_all(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "judge_contact: {}\n{}", error.what(), usage);
    return 2;
  }
}
