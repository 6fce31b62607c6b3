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
  add("scheme", choice.method.scheme);
  add("integrator", choice.method.integrator);
  add("detector", choice.method.detector);
  add("impact", choice.method.impact);
  add("frame", frames_text(choice.frames.value_or(scene.frames)));
  add("step", fmt::format("{}", choice.step.value_or(0.0)));
  add("threshold", fmt::format("{}", choice.threshold));
  add("equal-substeps", fmt::format("{}", choice.equal_substeps));
  add("max-substeps", fmt::format("{}", choice.max_substeps));
  add("tolerance", fmt::format("{}", choice.toi_tolerance));
  add("relative-tolerance", fmt::format("{}", choice.stepper.relative_tolerance));
  add("absolute-tolerance", fmt::format("{}", choice.stepper.absolute_tolerance));
  add("roundoff", fmt::format("{}", choice.roundoff));
  for (const auto& [name, version] : versions()) {
    add("version of " + name, version);
  }
  return identity;
}

}  // namespace kairos::experiments
