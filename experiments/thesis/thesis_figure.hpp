#pragma once

#include "experiments/thesis/figure_data.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments {

/// A figure of the thesis (or a section that tells without drawing), and how it is made again from
/// data of a run or from the library's own answers. Texts quote values of the data as `{name}`.
struct ThesisFigure {
  std::string_view name;     ///< "fig13", "ch8.1", "9.1.2": also the folder
  std::string_view chapter;  ///< of the thesis, "9"; empty: after the chapters
  std::string_view title;
  std::string_view shows;    ///< what the thesis draws or says there
  std::string_view how;      ///< what is run or asked here
  std::string_view caption;  ///< of the drawing
  std::string_view finding;  ///< what it shows now
  /// Module of `experiments/figures/` that draws it.
  std::string_view script;
  void (*measure)(FigureData& data) = nullptr;
  /// Instead of the script (the frames that a ray tracer makes): writes what is not a table into
  /// the folder of the data, pictures with `figures.csv` (figure, caption); returns nothing, or the
  /// reason why it could not.
  std::string (*draw)(const std::string& folder) = nullptr;
};

/// All of them, in the order of the thesis.
[[nodiscard]] std::span<const ThesisFigure> thesis_figures();
/// A chapter of the thesis that has figures, as its own table of contents names it.
struct ThesisChapter {
  std::string_view number;
  std::string_view title;
};
[[nodiscard]] std::span<const ThesisChapter> thesis_chapters();
/// By name; `fig1`, `1` and `fig01` are the same. nullptr if there is none.
[[nodiscard]] const ThesisFigure* find_thesis_figure(std::string_view name);

/// How the making went.
struct FigureOutcome {
  double data_seconds = 0.0;
  double drawing_seconds = 0.0;
  std::string problem;  ///< empty if it is drawn
};

/// Makes a figure: its tables, `values.csv`, `columns.csv` and `manifest.csv` into `folder`, then
/// the drawing (SVG and PNG) with its caption in `figures.csv`. The same bytes each time.
FigureOutcome make_figure(const ThesisFigure& figure, Size size, const std::string& folder);

}  // namespace kairos::experiments
