#include "experiments/thesis/thesis_figure.hpp"
#include "simulation/registry.hpp"

#include <cmath>

namespace kairos::experiments::thesis {
namespace {

constexpr double radius_a = 1.0;  // m
constexpr double radius_b = 0.7;  // m

/// Two spheres whose centres are this far apart, and what the library says of them.
void add_pair(Table& table, const ContactDetector& detector, const std::string& name,
              double distance) {
  const Pose a;
  const Pose b{.position = distance * Vector3(std::cos(0.45), std::sin(0.45), 0.0)};
  const Overlap answer = detector.overlap(Sphere{radius_a}, a, Sphere{radius_b}, b);
  table.rows.push_back({name, radius_a, radius_b, b.position.x(), b.position.y(), distance,
                        std::int64_t{answer.overlapping}, answer.gap, answer.normal.x(),
                        answer.normal.y(), answer.point.x(), answer.point.y()});
}

void measure(FigureData& data) {
  const auto detector = find_detector("sat");
  Table& pairs =
      data.table("pairs", {{"case", "", "how the pair was placed"},
                           {"ra", "m", "radius of A, which is at the origin"},
                           {"rb", "m", "radius of B"},
                           {"bx", "m", "centre of B"},
                           {"by", "m", "centre of B"},
                           {"distance", "m", "between the centres"},
                           {"overlapping", "", "the library's answer"},
                           {"gap", "m", "signed: minus the penetration depth where they overlap"},
                           {"nx", "", "normal, from A to B"},
                           {"ny", "", "normal, from A to B"},
                           {"px", "m", "middle of the contact"},
                           {"py", "m", "middle of the contact"}});
  add_pair(pairs, *detector, "apart", radius_a + radius_b + 0.35);
  add_pair(pairs, *detector, "touching", radius_a + radius_b);
  add_pair(pairs, *detector, "overlapping", radius_a + radius_b - 0.4);

  // Where exactly the answer changes, in units in the last place of the sum of the radii.
  Table& edge = data.table("edge", {{"ulp", "", "distance minus the sum of the radii, in ulp"},
                                    {"overlapping", "", "the library's answer"}});
  const double ulp = std::nextafter(radius_a + radius_b, 2.0) - (radius_a + radius_b);
  std::int64_t last = -1000;
  for (std::int64_t k = -6; k <= 6; ++k) {
    const Pose b{.position = {radius_a + radius_b + static_cast<double>(k) * ulp, 0.0, 0.0}};
    const bool overlapping = detector->overlaps(Sphere{radius_a}, {}, Sphere{radius_b}, b);
    edge.rows.push_back({k, std::int64_t{overlapping}});
    last = overlapping ? k : last;
  }
  data.count("last", last, "largest distance that still counts as an overlap, in ulp of the sum");
  data.value("ulp", ulp, "m", "one ulp of the sum of the radii", 2);
}

}  // namespace

ThesisFigure two_spheres() {
  return {.name = "fig01",
          .chapter = "2",
          .title = "Figure 1: two spheres",
          .shows =
              "Two spheres intersect if the distance of their centres is less than the sum of "
              "their radii (2.1.1).",
          .how =
              "Three pairs are put to the library; it answers with yes or no, the signed gap, "
              "the normal, and the middle of the contact. Then the distance is moved across the "
              "sum of the radii one unit in the last place at a time.",
          .caption =
              "Three pairs of spheres with the library's answers: the gap along the line of "
              "centres, and the middle of the contact (cross).",
          .finding =
              "The answer changes where the thesis says, at the sum of the radii, which itself "
              "counts as touching as in 3.4 (2.1.1 has it apart): the largest distance that counts "
              "as an "
              "overlap is the sum of the radii plus {last} ulp (of {ulp}).",
          .script = "thesis.fig01",
          .measure = measure};
}

}  // namespace kairos::experiments::thesis
