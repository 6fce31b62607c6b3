#pragma once

#include "experiments/render/footage.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace kairos::experiments {

/// Where one looks from; world frame, m.
struct Camera {
  Vector3 position = Vector3::Zero();
  Vector3 target = Vector3::Zero();
  double angle = 40.0;  ///< degrees, across the picture
};

/// `px,py,pz,tx,ty,tz` with an angle in degrees as a seventh number, or not. Throws `InputError`.
[[nodiscard]] Camera parse_camera(std::string_view text);
/// The pictures [first, last] of a run.
struct Shot {
  const Footage* footage = nullptr;
  std::size_t first = 0;
  std::size_t last = 0;
};
/// Sees all that moves in these, and what stands still unless it is far larger or has no end.
/// `aspect`: width over height of a picture.
[[nodiscard]] Camera camera_for(std::span<const Shot> shots, double aspect);

/// Two solids of a picture that are inside each other.
struct Overlapping {
  std::size_t a = 0;
  std::size_t b = 0;
  double depth = 0.0;  ///< m
};
/// All of them, as they collide; a field is no solid, and a hand holds what is inside it.
[[nodiscard]] std::vector<Overlapping> overlapping(const Footage& footage, std::size_t picture);

struct PictureOptions {
  Camera camera;
  int width = 480;
  int height = 360;
  std::string label;  ///< after the time; empty: the time alone
  bool boxes = true;  ///< the box of what collides as one, and of bats, as wire
};

/// A picture as a POV-Ray 3.7 scene: balls; boxes as wire with pale faces; bats as rackets in the
/// wire of the box that they collide as; hands and fields translucent; what two solids have in
/// common glows; the time in the lower left corner. No text of the footage gets out of the string
/// it is put in.
[[nodiscard]] std::string pov_scene(const Footage& footage, std::size_t picture,
                                    const PictureOptions& options);

}  // namespace kairos::experiments
