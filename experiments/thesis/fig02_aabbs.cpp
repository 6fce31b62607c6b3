#include "core/random.hpp"
#include "experiments/rally/interval.hpp"
#include "experiments/thesis/corner_test.hpp"
#include "experiments/thesis/thesis_figure.hpp"

#include <fmt/format.h>

namespace kairos::experiments::thesis {
namespace {

constexpr std::uint64_t seed = 212;

struct Example {
  const char* name;
  FlatBox c, d;
};

void add_examples(FigureData& data, std::span<const Example> examples) {
  Table& pairs = data.table("pairs", {{"example", "", "what it shows"},
                                      {"cx", "m", "bottom left corner of C"},
                                      {"cy", "m", "bottom left corner of C"},
                                      {"cdx", "m", "lengths of C"},
                                      {"cdy", "m", "lengths of C"},
                                      {"dx", "m", "bottom left corner of D"},
                                      {"dy", "m", "bottom left corner of D"},
                                      {"ddx", "m", "lengths of D"},
                                      {"ddy", "m", "lengths of D"},
                                      {"test", "", "which test"},
                                      {"overlap", "", "its answer"}});
  for (const Example& e : examples) {
    for (const FlatTest& test : flat_tests()) {
      pairs.rows.push_back({std::string(e.name), e.c.x, e.c.y, e.c.dx, e.c.dy, e.d.x, e.d.y, e.d.dx,
                            e.d.dy, std::string(test.name), std::int64_t{test.overlap(e.c, e.d)}});
    }
  }
}

FlatBox random_box(Random& random) {
  return {random.uniform(0.0, 2.0), random.uniform(0.0, 2.0), random.uniform(0.1, 1.5),
          random.uniform(0.1, 1.5)};
}

void tell_interval(FigureData& data, const std::string& name, std::int64_t count, std::int64_t of) {
  const Interval share = share_interval(count, of);
  data.text(name, fmt::format("{:.1f} to {:.1f} %", 100.0 * share.low, 100.0 * share.high),
            "95 % interval");
}

/// How often each test errs on random pairs, against the full test. Also checks that the full test
/// and the library agree.
void add_rates(FigureData& data) {
  const int n = data.size() == Size::full ? 1000000 : 100000;
  const auto& tests = flat_tests();
  std::array<std::int64_t, 6> missed{};
  std::array<std::int64_t, 6> invented{};
  std::int64_t overlapping = 0;
  Random random(seed);
  for (int k = 0; k < n; ++k) {
    const FlatBox c = random_box(random);
    const FlatBox d = random_box(random);
    const bool truth = tests[4].overlap(c, d);
    overlapping += truth ? 1 : 0;
    for (std::size_t i = 0; i < tests.size(); ++i) {
      const bool answer = tests[i].overlap(c, d);
      missed[i] += truth && !answer ? 1 : 0;
      invented[i] += !truth && answer ? 1 : 0;
    }
  }
  Table& rates = data.table(
      "rates", {{"test", "", "which test"},
                {"meaning", "", "what it asks"},
                {"missed", "", "fraction of the overlapping pairs that it calls disjoint"},
                {"invented", "", "fraction of the disjoint pairs that it calls overlapping"}});
  const auto part = [](std::int64_t count, std::int64_t of) {
    return static_cast<double>(count) / static_cast<double>(of);
  };
  for (std::size_t i = 0; i < tests.size(); ++i) {
    const double of_overlapping = part(missed[i], overlapping);
    const double of_disjoint = part(invented[i], n - overlapping);
    rates.rows.push_back(
        {std::string(tests[i].name), std::string(tests[i].meaning), of_overlapping, of_disjoint});
    const std::string name(tests[i].name);
    data.value(name + "_missed", 100.0 * of_overlapping, "%", "overlaps it misses", 3);
    data.value(name + "_invented", 100.0 * of_disjoint, "%", "overlaps it invents", 3);
    tell_interval(data, name + "_missed_interval", missed[i], overlapping);
    tell_interval(data, name + "_invented_interval", invented[i], n - overlapping);
  }
  data.count("pairs", n, "random pairs");
  data.count("seed", static_cast<std::int64_t>(seed), "of the draws");
}

void measure_both_axes(FigureData& data) {
  add_examples(data,
               std::to_array<Example>({{"both axes", {1.2, 0.9, 1.6, 1.2}, {0.3, 0.2, 1.5, 1.3}},
                                       {"cross", {0.2, 0.8, 2.4, 0.5}, {1.0, 0.1, 0.6, 1.9}},
                                       {"inside", {0.2, 0.1, 2.4, 1.9}, {0.9, 0.7, 0.9, 0.6}}}));
  add_rates(data);
}

void measure_one_axis(FigureData& data) {
  add_examples(data,
               std::to_array<Example>({{"one axis", {1.0, 1.6, 1.5, 0.8}, {0.3, 0.2, 1.5, 1.0}}}));
  add_rates(data);
}

}  // namespace

ThesisFigure aabbs_overlapping() {
  return {
      .name = "fig02",
      .chapter = "2",
      .title = "Figure 2: two AABBs must overlap along both axes to intersect",
      .shows =
          "The code of 2.1.2 asks whether the bottom left corner of C is inside D; "
          "“similar segments would be needed to test all four corners”.",
      .how =
          "The printed code, the corner test that must have been meant, all four corners of C, "
          "and the corners of both boxes, beside the full test (overlap along both axes) and "
          "the library's separating axes; on the pair of the figure, on two pairs that defeat "
          "corners, and on {pairs} random pairs (seed {seed}).",
      .caption =
          "The pair of the figure, and two overlapping pairs of which no corner "
          "of C lies in D; of the cross, no corner of D lies in C either. Last: overlaps "
          "that each test misses among random pairs.",
      .finding =
          "Testing corners is not enough, however many: the four corners of C miss "
          "{corners_missed} of the overlaps ({corners_missed_interval}), those of both boxes still "
          "{both_missed} ({both_missed_interval}; crosses). The full test and the library agree on "
          "all pairs ({library_missed} "
          "missed, {library_invented} invented).",
      .script = "thesis.fig02",
      .measure = measure_both_axes};
}

ThesisFigure aabbs_on_one_axis() {
  return {.name = "fig03",
          .chapter = "2",
          .title = "Figure 3: two AABBs which overlap along only one axis do not intersect",
          .shows =
              "Two boxes overlap along the X-direction but not the Y-direction; hence they are "
              "disjoint.",
          .how =
              "The same tests as for figure 2, on the pair of the figure and on {pairs} random "
              "pairs (seed {seed}).",
          .caption =
              "Left: overlap along x only. Right: pairs that each test calls overlapping "
              "though they are disjoint, among random pairs.",
          .finding =
              "The figure is right and the printed code is not: its last comparison reads "
              "yd < yd + dy where yc was meant, so that it calls these two boxes colliding, "
              "and {printed_invented} of all disjoint random pairs. The other tests invent "
              "nothing.",
          .script = "thesis.fig03",
          .measure = measure_one_axis};
}

}  // namespace kairos::experiments::thesis
