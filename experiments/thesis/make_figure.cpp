#include "experiments/figures/draw_figures.hpp"
#include "experiments/output/output_folder.hpp"
#include "experiments/sweeps/experiment.hpp"
#include "experiments/thesis/thesis_figure.hpp"
#include "simulation/version.hpp"

#include <fmt/format.h>

#include <chrono>

namespace kairos::experiments {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Table manifest_of(const ThesisFigure& figure, const FigureData& data) {
  Table table{{"key", "value"}, {}};
  const auto add = [&table](const std::string& key, std::string value) {
    table.rows.push_back({key, std::move(value)});
  };
  add("name", std::string(figure.name));
  add("chapter", std::string(figure.chapter));
  add("title", std::string(figure.title));
  add("asks", data.filled(figure.shows));
  add("how", data.filled(figure.how));
  add("caption", data.filled(figure.caption));
  add("finding", data.filled(figure.finding));
  add("command",
      fmt::format("kairos reproduce --only {} --{}", figure.name, to_string(data.size())));
  add("size", std::string(to_string(data.size())));
  for (const auto& [name, version] : versions()) {
    add("version:" + name, version);
  }
  return table;
}

}  // namespace

FigureOutcome make_figure(const ThesisFigure& figure, Size size, const std::string& folder) {
  FigureOutcome outcome;
  auto start = Clock::now();
  FigureData data(folder, size);
  figure.measure(data);
  OutputFolder out(folder, experiment_output(true));
  data.write(out);
  out.file("manifest.csv").write(manifest_of(figure, data).csv());
  out.publish();
  outcome.data_seconds = seconds_since(start);

  start = Clock::now();
  if (figure.draw != nullptr) {
    outcome.problem = figure.draw(folder);
  } else if (!figure.script.empty()) {
    outcome.problem = draw_figures(std::string(figure.script), folder);
  }
  outcome.drawing_seconds = seconds_since(start);
  return outcome;
}

}  // namespace kairos::experiments
