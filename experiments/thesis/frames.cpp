#include "experiments/thesis/frames.hpp"

#include "experiments/figures/draw_figures.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace kairos::experiments::thesis {
namespace {

std::string labelled(const char* method, const std::string& note) {
  return note.empty() ? std::string(method) : fmt::format("{}, {}", method, note);
}

}  // namespace

void tell_frames(const Storyboard& board, FigureData& data) {
  Table& table = data.table("frames", {{"frame", "", "number"},
                                       {"caption", "", "what the thesis says of it"},
                                       {"t_original", "s", "drawn time of `original`"},
                                       {"t_event_driven", "s", "drawn time of `event-driven`"},
                                       {"original", "", "told in the picture"},
                                       {"event_driven", "", "told in the picture"}});
  std::int64_t number = 0;
  for (const StoryFrame& frame : board.frames) {
    const auto drawn = [](const Footage& footage, double t) {
      return footage.pictures[footage.at(t)].time;
    };
    table.rows.push_back({++number, frame.caption, drawn(board.original, frame.original),
                          drawn(board.event_driven, frame.event_driven), frame.original_note,
                          frame.event_driven_note});
  }
}

std::string draw_frames(const Storyboard& board, const std::string& folder) {
  if (const std::string reason = why_no_povray(); !reason.empty()) {
    return "no frames: " + reason;
  }
  int number = 0;
  for (const StoryFrame& frame : board.frames) {
    RenderOptions options = board.options;
    options.label = labelled("original", frame.original_note);
    options.beside_label = labelled("event-driven", frame.event_driven_note);
    render_picture({&board.original, frame.original}, {&board.event_driven, frame.event_driven},
                   options, std::filesystem::path(folder) / fmt::format("frame-{}.png", ++number));
  }
  return draw_figures("thesis.frames", folder);
}

}  // namespace kairos::experiments::thesis
