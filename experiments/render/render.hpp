#pragma once

#include "experiments/render/pov_scene.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace kairos::experiments {

/// Which pictures of a run, and how.
struct RenderOptions {
  std::optional<double> from = {};   ///< s; the first picture
  std::optional<double> to = {};     ///< s; the last picture
  std::optional<double> every = {};  ///< s between pictures; each that was drawn
  std::optional<Camera> camera = {};
  int width = 480;
  int height = 360;
  bool smooth = true;  ///< anti-aliased
  bool boxes = true;
  std::string label = {};         ///< in the picture, after the time
  std::string beside_label = {};  ///< in the one beside it
};

/// Empty, or why POV-Ray cannot be run.
[[nodiscard]] std::string why_no_povray();

/// Times of the pictures that the options ask for; never empty. Throws `InputError`.
[[nodiscard]] std::vector<double> picture_times(const Footage& footage,
                                                const RenderOptions& options);

/// A moment of a run; no footage: nothing.
struct Moment {
  const Footage* footage = nullptr;
  double time = 0.0;
};

/// One PNG of a moment, or of two side by side. The file appears whole or not at all. Throws
/// `RunError` where POV-Ray fails.
void render_picture(const Moment& moment, const Moment& beside, const RenderOptions& options,
                    const std::filesystem::path& png);

/// `frame-00000.png` and so on into a folder. Returns how many.
std::size_t render_run(const Footage& footage, const Footage* beside, const RenderOptions& options,
                       const std::filesystem::path& folder);

/// `film.mp4` from these frames; false where ffmpeg is not found.
bool make_film(const std::filesystem::path& folder, double frames_per_second);

}  // namespace kairos::experiments
