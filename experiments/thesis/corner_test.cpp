#include "experiments/thesis/corner_test.hpp"

#include "simulation/registry.hpp"

namespace kairos::experiments::thesis {
namespace {

bool printed(const FlatBox& c, const FlatBox& d) {
  return d.x < c.x && c.x < d.x + d.dx && d.y < c.y && d.y < d.y + d.dy;
}

bool inside(double x, double y, const FlatBox& box) {
  return box.x < x && x < box.x + box.dx && box.y < y && y < box.y + box.dy;
}

bool corner(const FlatBox& c, const FlatBox& d) { return inside(c.x, c.y, d); }

bool corners(const FlatBox& c, const FlatBox& d) {
  return inside(c.x, c.y, d) || inside(c.x + c.dx, c.y, d) || inside(c.x, c.y + c.dy, d) ||
         inside(c.x + c.dx, c.y + c.dy, d);
}

bool both(const FlatBox& c, const FlatBox& d) { return corners(c, d) || corners(d, c); }

bool intervals(const FlatBox& c, const FlatBox& d) {
  return c.x < d.x + d.dx && d.x < c.x + c.dx && c.y < d.y + d.dy && d.y < c.y + c.dy;
}

Shape shape_of(const FlatBox& box) { return Box{{0.5 * box.dx, 0.5 * box.dy, 1.0}}; }

Pose pose_of(const FlatBox& box) {
  return {.position = {box.x + 0.5 * box.dx, box.y + 0.5 * box.dy, 0.0}};
}

bool library(const FlatBox& c, const FlatBox& d) {
  static const auto detector = find_detector("sat");
  return detector->overlaps(shape_of(c), pose_of(c), shape_of(d), pose_of(d));
}

}  // namespace

const std::array<FlatTest, 6>& flat_tests() {
  static constexpr std::array<FlatTest, 6> tests{
      {{"printed", "the code of 2.1.2 as printed", printed},
       {"corner", "bottom left corner of C in D", corner},
       {"corners", "one of the four corners of C in D", corners},
       {"both", "a corner of either box in the other", both},
       {"intervals", "overlap along both axes", intervals},
       {"library", "separating axes, by the library", library}}};
  return tests;
}

}  // namespace kairos::experiments::thesis
