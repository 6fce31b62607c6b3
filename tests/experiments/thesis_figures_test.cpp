// The figures of the thesis, made again: their data, their names, their bytes.

#include "core/entity.hpp"
#include "experiments/data_folders.hpp"
#include "experiments/output/table.hpp"
#include "experiments/thesis/entity_survey.hpp"
#include "experiments/thesis/thesis_figure.hpp"
#include "simulation/scene_library.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"

#include <cxxabi.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <typeinfo>
#include <vector>

using namespace kairos::experiments;
using kairos::tests::kairos_program;
using kairos::tests::read_all;
using kairos::tests::TemporaryFolder;

namespace {

/// The last part of a class's full name.
std::string class_name(const std::type_info& type) {
  int status = 0;
  const std::unique_ptr<char, void (*)(void*)> full(
      abi::__cxa_demangle(type.name(), nullptr, nullptr, &status), std::free);
  const std::string name = status == 0 ? full.get() : type.name();
  return name.substr(name.rfind(':') + 1);
}

/// Base classes, nearest first, as the C++ ABI of GCC and Clang tells them (Itanium C++
/// ABI, 2.9.5).
std::vector<std::string> base_classes(const std::type_info& type) {
  std::vector<std::string> names;
  const auto* derived = dynamic_cast<const abi::__si_class_type_info*>(&type);
  while (derived != nullptr) {
    names.push_back(class_name(*derived->__base_type));
    derived = dynamic_cast<const abi::__si_class_type_info*>(derived->__base_type);
  }
  return names;
}

/// The data of a figure, without its drawing.
Table table_of(const std::string& figure, const std::string& table) {
  const TemporaryFolder folder;
  ThesisFigure found = *find_thesis_figure(figure);
  found.script = "";
  found.draw = nullptr;
  (void)make_figure(found, Size::quick, folder.path("out"));
  return read_csv(folder.path("out/" + table + ".csv"));
}

double number(const Table& table, std::size_t row, const std::string& column) {
  return std::stod(to_text(table.rows.at(row).at(table.column(column))));
}

}  // namespace

TEST_CASE("figures: each has a name of its own, found however it is written", "[figures]") {
  std::set<std::string_view> names;
  for (const ThesisFigure& figure : thesis_figures()) {
    CAPTURE(figure.name);
    CHECK(names.insert(figure.name).second);
    CHECK(find_thesis_figure(figure.name) == &figure);
    CHECK(figure.measure != nullptr);
  }
  CHECK(find_thesis_figure("fig13") != nullptr);
  CHECK(find_thesis_figure("13") == find_thesis_figure("fig13"));
  CHECK(find_thesis_figure("Fig13") == find_thesis_figure("fig13"));
  CHECK(find_thesis_figure("fig99") == nullptr);
  CHECK(find_thesis_figure("") == nullptr);
}

TEST_CASE("3.2: the larger its bounds, the more often a bat hits where it is not", "[figures]") {
  const Table bats = table_of("3.2", "bats");  // the scene's box, then its box, its hull, itself
  REQUIRE(bats.rows.size() == 4);
  for (std::size_t row = 0; row < 4; ++row) {
    CAPTURE(row);
    CHECK(number(bats, row, "completed") == 20);
    CHECK(number(bats, row, "hits") > 400);
    CHECK(number(bats, row, "passed") == 0);
    CHECK(number(bats, row, "inside") == 0);
  }
  for (std::size_t row = 1; row < 3; ++row) {
    CHECK(number(bats, row, "volume") > number(bats, row + 1, "volume"));
    CHECK(number(bats, row, "early") > number(bats, row + 1, "early"));
  }
  CHECK(number(bats, 3, "early") == 0);
  CHECK(number(bats, 3, "most_gap") < 1e-9);  // it touches what players see
}

TEST_CASE("figures: texts quote values, and only values that exist", "[figures]") {
  FigureData data("", Size::quick);
  data.value("depth", 0.0123456, "m", "");
  data.count("runs", 3, "");
  data.text("who", "a ball", "");
  CHECK(data.filled("{who}: {depth} in {runs}") == "a ball: 0.01235 m in 3");
  CHECK(data.filled("nothing") == "nothing");
  CHECK_THROWS_AS(data.filled("{width}"), std::out_of_range);
}

TEST_CASE("figure 13: position 2 touches, position 3 is inside, and the times are in order",
          "[figures]") {
  const Table positions = table_of("fig13", "positions");
  REQUIRE(positions.rows.size() == 3);
  CHECK(number(positions, 0, "gap") > 0.1);
  // Physical: the detector's tolerance, 1e-9 of the ball, and never inside.
  CHECK(number(positions, 1, "gap") >= 0.0);
  CHECK(number(positions, 1, "gap") <= 1e-9);
  CHECK(number(positions, 2, "gap") < -0.01);
  CHECK(number(positions, 0, "t") < number(positions, 1, "t"));
  CHECK(number(positions, 1, "t") < number(positions, 2, "t"));
  // On the way: the ball of the thesis moves on a straight line within a frame.
  const double part = (number(positions, 1, "t") - number(positions, 0, "t")) /
                      (number(positions, 2, "t") - number(positions, 0, "t"));
  for (const char* axis : {"x", "y"}) {
    const double expected =
        (1 - part) * number(positions, 0, axis) + part * number(positions, 2, axis);
    CHECK(std::abs(number(positions, 1, axis) - expected) <= 1e-12);  // roundoff of metres
  }
}

TEST_CASE("reproduce --only makes one figure, the same bytes each time", "[figures]") {
  const TemporaryFolder folder;
  for (const char* out : {"one", "two"}) {
    const auto outcome =
        kairos_program({"reproduce", "--only", "fig15", "--out", folder.path(out)});
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.out.find("fig15: data in") != std::string::npos);
  }
  const std::vector<std::string> files = folder.entries("one");
  CHECK(files.size() >= 8);  // without Python no pictures
  CHECK(files == folder.entries("two"));
  for (const std::string& file : files) {
    CAPTURE(file);
    if (file.find('.') != std::string::npos) {
      CHECK(read_all(folder.path("one/" + file)) == read_all(folder.path("two/" + file)));
    }
  }
  const auto unknown = kairos_program({"reproduce", "--only", "fig31", "--out", folder.path("no")});
  CHECK(unknown.exit_code == 2);
  CHECK(unknown.err.find("fig31") != std::string::npos);
  CHECK_THROWS(folder.entries("no"));  // not even the folder
}

TEST_CASE("figure 1: spheres overlap up to the sum of their radii, to the last bit", "[figures]") {
  const Table pairs = table_of("fig01", "pairs");
  REQUIRE(pairs.rows.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const double gap =
        number(pairs, i, "distance") - number(pairs, i, "ra") - number(pairs, i, "rb");
    CHECK(std::abs(number(pairs, i, "gap") - gap) <= 4 * 0x1p-52 * 2.0);  // roundoff of metres
    CHECK(number(pairs, i, "overlapping") == (i == 0 ? 0.0 : 1.0));
  }
  const Table edge = table_of("fig01", "edge");
  for (std::size_t i = 0; i < edge.rows.size(); ++i) {
    CHECK(number(edge, i, "overlapping") == (number(edge, i, "ulp") <= 0.0 ? 1.0 : 0.0));
  }
}

TEST_CASE("figures 2 and 3: corners miss overlaps, the printed test invents them", "[figures]") {
  const Table rates = table_of("fig02", "rates");
  const auto rate = [&](const std::string& test, const std::string& column) {
    for (std::size_t i = 0; i < rates.rows.size(); ++i) {
      if (to_text(rates.rows[i][0]) == test) {
        return number(rates, i, column);
      }
    }
    return -1.0;
  };
  CHECK(rate("library", "missed") == 0.0);
  CHECK(rate("library", "invented") == 0.0);
  CHECK(rate("corner", "missed") > rate("corners", "missed"));
  CHECK(rate("corners", "missed") > rate("both", "missed"));
  CHECK(rate("both", "missed") > 0.0);
  CHECK(rate("both", "invented") == 0.0);
  CHECK(rate("printed", "invented") > 0.0);

  // Fig. 3's own boxes: disjoint, and overlapping for the printed test alone.
  const Table one_axis = table_of("fig03", "pairs");
  for (std::size_t i = 0; i < one_axis.rows.size(); ++i) {
    const std::string test = to_text(one_axis.rows[i][one_axis.column("test")]);
    CAPTURE(test);
    CHECK(number(one_axis, i, "overlap") == (test == "printed" ? 1.0 : 0.0));
  }
}

TEST_CASE("figure 5: a box fits a ball better than a ball fits a box", "[figures]") {
  const Table fits = table_of("fig05", "fits");
  const double pi = 3.141592653589793;
  const double expected[] = {4 / pi, pi / 2, 6 / pi, pi * std::sqrt(3.0) / 2};
  REQUIRE(fits.rows.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(std::abs(number(fits, i, "ratio") / expected[i] - 1.0) <= 16 * 0x1p-52);  // roundoff
    // Statistical: four standard deviations of about 1e5 points.
    CHECK(std::abs(number(fits, i, "sampled") / expected[i] - 1.0) <= 0.015);
  }
}

TEST_CASE("figure 6: the axis that sat returns separates the intervals by its gap", "[figures]") {
  const Table intervals = table_of("fig06", "projections");
  const Table axes = table_of("fig06", "axes");
  REQUIRE(intervals.rows.size() == 2);
  REQUIRE(axes.rows.size() == 15);
  const double apart = number(intervals, 1, "lower") - number(intervals, 0, "upper");
  CHECK(apart > 0.1);
  double largest = -1.0;
  for (std::size_t i = 0; i < axes.rows.size(); ++i) {
    if (to_text(axes.rows[i][axes.column("gap")]).empty()) {
      continue;  // parallel edges
    }
    largest = std::max(largest, number(axes, i, "gap"));
    if (number(axes, i, "returned") == 1.0) {
      CHECK(std::abs(number(axes, i, "gap") - apart) <= 1e-15);  // roundoff of metres
    }
  }
  CHECK(std::abs(largest - apart) <= 1e-15);
}

TEST_CASE("figures 7 and 15: stages in the order of the thesis, fractions up to a frame",
          "[figures]") {
  const auto stages = [](const Table& frame) {
    std::string text;
    for (const auto& row : frame.rows) {
      text += to_text(row[1]) + " ";
    }
    return text;
  };
  CHECK(stages(table_of("fig07", "frame")) == "draw detect handle calculate-positions ");
  const Table frame = table_of("fig15", "frame");
  CHECK(stages(frame).starts_with(
      "draw calculate-positions restrict-movement advance detect calculate-positions"));
  double done = 0.0;
  for (std::size_t i = 0; i < frame.rows.size(); ++i) {
    if (to_text(frame.rows[i][1]) == "advance") {
      CHECK(number(frame, i, "fraction") > done);
      done = number(frame, i, "fraction");
    }
  }
  CHECK(done == 1.0);
}

TEST_CASE("figures 8 to 10: every registered entity, with the class it inherits", "[figures]") {
  const std::vector<thesis::SurveyedEntity> survey = thesis::survey_entities();
  REQUIRE(survey.size() == kairos::entity_catalogue().size());
  for (std::size_t i = 0; i < survey.size(); ++i) {
    const kairos::EntityType& type = kairos::entity_catalogue()[i];
    std::vector<double> values;
    for (const kairos::EntityKey& key : type.keys) {
      values.push_back(key.default_value);
    }
    const auto entity = type.make(values);
    const kairos::Entity& made = *entity;
    CAPTURE(type.kind);
    CHECK(survey[i].class_name == class_name(typeid(made)));
    CHECK(survey[i].parents == base_classes(typeid(made)));
  }
  CHECK(table_of("fig09", "classes").rows.size() == survey.size());
}

TEST_CASE("figure 14: the swept box is as long as the movement and the ball", "[figures]") {
  const Table boxes = table_of("fig14", "boxes");
  const auto side = [&](std::size_t a, std::size_t b) {
    return std::hypot(number(boxes, a, "x") - number(boxes, b, "x"),
                      number(boxes, a, "y") - number(boxes, b, "y"));
  };
  const Table positions = table_of("fig14", "positions");
  const double moved = std::hypot(number(positions, 2, "x") - number(positions, 0, "x"),
                                  number(positions, 2, "y") - number(positions, 0, "y"));
  const double diameter = 0.3;
  const double longest = std::max(side(0, 1), side(1, 2));
  const double shortest = std::min(side(0, 1), side(1, 2));
  // Outward rounding, which makes the box a proof: never smaller, 1e-12 larger at most.
  CHECK(longest >= moved + diameter - 1e-15);
  CHECK(longest <= moved + diameter + 1e-12);
  CHECK(shortest >= diameter - 1e-15);
  CHECK(shortest <= diameter + 1e-12);
}

TEST_CASE("names of shipped scenes and experiments mean the same in every folder", "[figures]") {
  const TemporaryFolder folder;
  (void)folder.file("bounce", "not a scene");
  (void)folder.file("overview", "not a spec");
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path(""));
  CHECK(kairos::find_scene("bounce").ends_with("/bounce.toml"));
  CHECK(find_experiment("overview").ends_with("/overview.toml"));
  CHECK(kairos::find_scene("./bounce") == "./bounce");
  std::filesystem::current_path(before);
}

TEST_CASE("figure 4: a box fitted to a mesh that is not aligned is larger", "[figures]") {
  const Table axes = table_of("fig04", "axes");
  REQUIRE(axes.rows.size() == 3);
  CHECK(number(axes, 0, "radius") > number(axes, 1, "radius"));
  const Table corners = table_of("fig04", "corners");
  const double long_side = std::hypot(number(corners, 1, "x") - number(corners, 0, "x"),
                                      number(corners, 1, "y") - number(corners, 0, "y"));
  CHECK(std::abs(long_side - 2.0 * number(axes, 0, "radius")) <= 1e-14);  // roundoff of metres
  const Table tilts = table_of("fig04", "tilts");
  REQUIRE(tilts.rows.size() == 31);
  CHECK(number(tilts, 0, "volume") == 1.0);
  CHECK(number(tilts, 15, "angle") == 45.0);
  CHECK(number(tilts, 15, "volume") > 1.15);
}
