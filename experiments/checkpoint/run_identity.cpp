#include "experiments/checkpoint/run_identity.hpp"

#include "core/archive.hpp"
#include "experiments/version.hpp"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

namespace kairos::experiments {
namespace {

std::string text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return std::move(text).str();
}

/// Where a drive takes its body, at many moments: a recording may have changed under its name.
std::string drive_fingerprint(const Drive& drive, double duration) {
  constexpr int samples = 256;
  Archive archive;
  for (int k = 0; k < samples; ++k) {
    Motion motion = drive.motion(Instant{} + duration * k / samples, duration);
    archive(motion);
  }
  return fingerprint(archive.bytes());
}

std::string frames_text(const FrameTimes& frames) {
  struct Writer {
    std::string operator()(const FixedFrames& f) const { return fmt::format("{} s", f.duration); }
    std::string operator()(const ListedFrames& f) const {
      return fmt::format("{} listed, {}", f.durations.size(),
                         fingerprint(fmt::format("{}", fmt::join(f.durations, " "))));
    }
    std::string operator()(const JitteredFrames& f) const {
      return fmt::format("{} s, jitter {}, spikes {} x {}, seed {}", f.mean, f.jitter,
                         f.spike_probability, f.spike_factor, f.seed);
    }
  };
  return std::visit(Writer{}, frames);
}

}  // namespace

RunIdentity method_identity(const RunChoice& choice) {
  return {{"scheme", choice.method.scheme},
          {"integrator", choice.method.integrator},
          {"detector", choice.method.detector},
          {"impact", choice.method.impact},
          {"frame", choice.frames ? frames_text(*choice.frames) : "the scene's"},
          {"step", fmt::format("{}", choice.step.value_or(0.0))},
          {"threshold", fmt::format("{}", choice.threshold)},
          {"equal-substeps", fmt::format("{}", choice.equal_substeps)},
          {"max-substeps", fmt::format("{}", choice.max_substeps)},
          {"tolerance", fmt::format("{}", choice.toi_tolerance)},
          {"relative-tolerance", fmt::format("{}", choice.stepper.relative_tolerance)},
          {"absolute-tolerance", fmt::format("{}", choice.stepper.absolute_tolerance)},
          {"roundoff", fmt::format("{}", choice.roundoff)}};
}

RunIdentity run_identity(const Model& model, const std::vector<Override>& overrides,
                         const RunChoice& choice) {
  RunIdentity identity;
  const auto add = [&identity](std::string key, std::string value) {
    identity.emplace_back(std::move(key), std::move(value));
  };
  const Scene& scene = model.scene();
  add("scene", scene.name);
  add("bodies", fmt::format("{}", scene.bodies.size()));
  add("scene text", fingerprint(text_of(scene.path)));
  for (const Override& o : overrides) {
    add("--set " + o.key, o.value);
  }
  for (const Body& body : scene.bodies) {
    if (body.drive) {
      add("drive of " + body.name, drive_fingerprint(*body.drive, scene.duration));
    }
  }
  RunChoice resolved = choice;
  resolved.frames = choice.frames.value_or(scene.frames);
  for (auto& [key, value] : method_identity(resolved)) {
    add(key, value);
  }
  for (const auto& [name, version] : versions()) {
    add("version of " + name, version);
  }
  return identity;
}

}  // namespace kairos::experiments
