// The figures of the thesis, made again: their data, their names, their bytes.

#include "experiments/sweeps/table.hpp"
#include "experiments/thesis/thesis_figure.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/program.hpp"

#include <cmath>
#include <set>
#include <string>

using namespace kairos::experiments;
using kairos::tests::kairos_program;
using kairos::tests::read_all;
using kairos::tests::TemporaryFolder;

namespace {

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
        kairos_program({"reproduce", "--only", "fig13", "--out", folder.path(out)});
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.out.find("fig13: data in") != std::string::npos);
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
