#include "experiments/checkpoint/run_identity.hpp"

#include "core/archive.hpp"
#include "core/reading/scene_reader.hpp"
#include "experiments/output/fingerprint.hpp"
#include "experiments/output/text_or_nothing.hpp"
#include "simulation/option.hpp"
#include "simulation/version.hpp"

#include <fmt/format.h>

namespace kairos::experiments {
namespace {

/// Fingerprint of where a drive takes its body: a recording may change and keep its name.
std::string drive_fingerprint(const Drive& drive, double duration) {
  constexpr int samples = 256;
  Archive archive;
  for (int k = 0; k < samples; ++k) {
    Motion motion = drive.motion(Instant{} + duration * k / samples, duration);
    archive(motion);
  }
  return fingerprint(archive.bytes());
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
  add("scene text", fingerprint(text_or_nothing(scene.path)));
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
  resolved.duration.reset();  // a resumed run may end later
  for (auto& [key, value] : identity_of(resolved)) {
    add(key, value);
  }
  for (const auto& [name, version] : versions()) {
    add("version of " + name, version);
  }
  return identity;
}

}  // namespace kairos::experiments
