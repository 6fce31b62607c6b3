#include "experiments/thesis/thesis_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace kairos::experiments {
namespace thesis {

// A new figure is one file, one declaration here and one line in the list below.
ThesisFigure two_spheres();
ThesisFigure aabbs_overlapping();
ThesisFigure aabbs_on_one_axis();
ThesisFigure oriented_box();
ThesisFigure ball_in_box();
ThesisFigure bat_in_bounds();
ThesisFigure separating_axis();
ThesisFigure flow_of_events();
ThesisFigure get_and_give();
ThesisFigure hierarchy();
ThesisFigure class_diagram();
ThesisFigure table_tennis();
ThesisFigure table_tennis_scene();
ThesisFigure bat_and_ball();
ThesisFigure physworld();
ThesisFigure table_tennis_in_the_flesh();
ThesisFigure sinking_ball();
ThesisFigure swept_box_of_geometric();
ThesisFigure improved_flow_of_events();
ThesisFigure gaining_energy();
ThesisFigure errata_table();
ThesisFigure toi_accuracy();

}  // namespace thesis

std::span<const ThesisFigure> thesis_figures() {
  static const ThesisFigure figures[] = {
      thesis::two_spheres(),
      thesis::aabbs_overlapping(),
      thesis::aabbs_on_one_axis(),
      thesis::oriented_box(),
      thesis::ball_in_box(),
      thesis::bat_in_bounds(),
      thesis::separating_axis(),
      thesis::flow_of_events(),
      thesis::get_and_give(),
      thesis::hierarchy(),
      thesis::class_diagram(),
      thesis::table_tennis_scene(),
      thesis::bat_and_ball(),
      thesis::table_tennis(),
      thesis::physworld(),
      thesis::table_tennis_in_the_flesh(),
      thesis::sinking_ball(),
      thesis::swept_box_of_geometric(),
      thesis::improved_flow_of_events(),
      thesis::gaining_energy(),
      thesis::errata_table(),
      thesis::toi_accuracy(),
  };
  return figures;
}

std::span<const ThesisChapter> thesis_chapters() {
  static constexpr ThesisChapter chapters[] = {
      {"2", "Bounding volumes"},
      {"3", "Collision detection"},
      {"4", "Motion"},
      {"5", "A taxonomy of entities"},
      {"7", "Virtual table tennis"},
      {"8", "The systems in action"},
      {"9", "Problems and extensibility"},
  };
  return chapters;
}

const ThesisFigure* find_thesis_figure(std::string_view name) {
  std::string wanted(name);
  std::transform(wanted.begin(), wanted.end(), wanted.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const std::string number = wanted.starts_with("fig") ? wanted.substr(3) : wanted;
  if (!number.empty() && number.size() <= 2 &&
      std::all_of(number.begin(), number.end(), [](unsigned char c) { return std::isdigit(c); })) {
    wanted = fmt::format("fig{:0>2}", number);
  }
  for (const ThesisFigure& figure : thesis_figures()) {
    if (figure.name == wanted) {
      return &figure;
    }
  }
  return nullptr;
}

}  // namespace kairos::experiments
