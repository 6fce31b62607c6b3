#pragma once

#include "experiments/render/render.hpp"
#include "experiments/thesis/figure_data.hpp"

#include <string>
#include <vector>

namespace kairos::experiments::thesis {

/// A frame of the thesis, made again by two methods; times in s.
struct StoryFrame {
  std::string caption;
  double original = 0.0;
  double event_driven = 0.0;
  std::string original_note = {};  ///< in the picture, after the time
  std::string event_driven_note = {};
};

/// What a figure of rendered frames consists of.
struct Storyboard {
  Footage original;
  Footage event_driven;
  std::vector<StoryFrame> frames;
  RenderOptions options;
};

/// The table `frames`: number, caption, times, notes.
void tell_frames(const Storyboard& board, FigureData& data);
/// Renders each frame, `original` left and `event-driven` right, and lays them out on one sheet.
/// Returns why not, or nothing.
[[nodiscard]] std::string draw_frames(const Storyboard& board, const std::string& folder);

}  // namespace kairos::experiments::thesis
