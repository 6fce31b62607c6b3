#include "core/model.hpp"
#include "core/reading/scene_reader.hpp"
#include "core/rotation_between.hpp"
#include "experiments/thesis/errata.hpp"
#include "experiments/thesis/errata_runs.hpp"
#include "experiments/thesis/thesis_figure.hpp"
#include "simulation/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

// Errata about boxes and counting: predictions 9 to 11, and the claims of 2.1.2 and 7.2.

namespace kairos::experiments::thesis {

ThesisFigure ball_in_box();
ThesisFigure aabbs_overlapping();

namespace {

/// The numbers of a figure, without its drawing.
class FigureNumbers {
 public:
  FigureNumbers(const ThesisFigure& figure, Size size) : data_("", size) { figure.measure(data_); }
  [[nodiscard]] double operator()(const std::string& name) const { return data_.number(name); }

 private:
  FigureData data_;
};

/// How far from a plane (normal along the diagonal) the centre of a shape is when it touches.
double reach_along_diagonal(const Shape& shape) {
  const auto detector = find_detector("sat");
  const Vector3 normal = Vector3::Ones().normalized();
  const Pose plane{.position = Vector3::Zero(),
                   .orientation = rotation_between(Vector3::UnitY(), normal)};
  double inside = 0.0;
  double outside = 10.0;
  for (int halvings = 0; halvings < 60; ++halvings) {
    const double middle = 0.5 * (inside + outside);
    const bool touching =
        detector->overlaps(shape, {.position = middle * normal}, HalfSpace{}, plane);
    (touching ? inside : outside) = middle;
  }
  return outside;
}

}  // namespace

std::vector<Check> box_of_a_ball(Size) {
  const double r = 0.5;
  const Shape ball = Sphere{r};
  const double early = reach_along_diagonal(bounding_box(ball)) - reach_along_diagonal(ball);
  return {{"how early the box of a ball touches a plane at its corner, in radii", "r",
           std::sqrt(3.0) - 1.0, early / r, Agreement::equal, 1e-14, "roundoff of metres"}};
}

std::vector<Check> box_or_sphere(Size size) {
  const FigureNumbers fits(ball_in_box(), size);
  constexpr double pi = std::numbers::pi;
  const auto check = [&](const char* quantity, double predicted, const char* name) {
    return Check{quantity,         "",
                 predicted,        fits(name),
                 Agreement::equal, 16.0 * epsilon * predicted,
                 "roundoff",       Evidence::arithmetic};
  };
  return {check("square around a circle, area", 4.0 / pi, "ball2"),
          check("circle around a square, area", pi / 2.0, "box2"),
          check("cube around a ball, volume", 6.0 / pi, "ball3"),
          check("ball around a cube, volume", pi * std::sqrt(3.0) / 2.0, "box3")};
}

std::vector<Check> kinds_of_pairs(Size) {
  const auto pairs = [](int n) {
    std::set<std::pair<int, int>> kinds;
    for (int a = 0; a < n; ++a) {
      for (int b = 0; b < n; ++b) {
        kinds.emplace(std::min(a, b), std::max(a, b));
      }
    }
    return static_cast<double>(kinds.size());
  };
  // The thesis' four kinds, two of each: which kinds of pairs can do anything to each other?
  std::string text = "name = \"kinds\"\nsummary = \"\"\nduration = 1\nframe = 0.1\n";
  const char* kinds[] = {"ball", "wall", "conveyor", "anti-gravity-pad"};
  int at = 0;
  for (const char* kind : kinds) {
    for (int copy = 0; copy < 2; ++copy, ++at) {
      text += fmt::format("[[body]]\nname = \"{}{}\"\nentity = \"{}\"\nposition = [{}, 0, 0]\n",
                          kind, copy, kind, 3 * at);
      text += std::string(kind) == "ball" ? "radius = 0.5\nmass = 1.0\n"
                                          : "half_extents = [0.5, 0.5, 0.5]\n";
    }
  }
  const Model model(parse_scene(text, "kinds.toml"));
  std::set<std::pair<std::string_view, std::string_view>> met;
  for (const auto& [a, b] : model.pairs()) {
    const std::string_view kind_a = model.entity(a).kind();
    const std::string_view kind_b = model.entity(b).kind();
    met.insert(std::minmax(kind_a, kind_b));
  }
  return {{"kinds of pairs of 3 kinds of objects (3! = 6)", "", 6.0, pairs(3), Agreement::equal,
           0.0, "exact", Evidence::arithmetic},
          {"kinds of pairs of 4 (4! = 24)", "", 10.0, pairs(4), Agreement::equal, 0.0, "exact",
           Evidence::arithmetic},
          {"of the thesis' four kinds, those that can collide", "", 4.0,
           static_cast<double>(met.size()), Agreement::equal, 0.0, "exact"}};
}

std::vector<Check> corner_tests(Size size) {
  const FigureNumbers rates(aabbs_overlapping(), size);
  return {{"overlaps invented by the test as printed", "%", 0.0, rates("printed_invented"),
           Agreement::more_than, 0.0, "", Evidence::observation},
          {"overlaps missed by the four corners of C", "%", 0.0, rates("corners_missed"),
           Agreement::more_than, 0.0, "", Evidence::observation},
          {"overlaps missed by the corners of both", "%", 0.0, rates("both_missed"),
           Agreement::more_than, 0.0, "", Evidence::observation},
          {"missed or invented by the library", "%", 0.0,
           rates("library_missed") + rates("library_invented"), Agreement::equal, 0.0, "exact"}};
}

std::vector<Check> velocity_from_positions(Size) {
  const EntityType* type = find_entity("bat");
  std::vector<double> defaults;
  for (const EntityKey& key : type->keys) {
    defaults.push_back(key.default_value);
  }
  const auto bat = type->make(defaults);
  TrackerMemory memory;
  double sum = 0.0;
  int renewals = 0;
  for (int n = 0; n < 6000; ++n) {
    BodyState state;
    state.pose.position.x() = 0.1 * n * frame;
    const TrackerMemory before = memory;
    const Vector3 velocity = bat->tracked_velocity(memory, state, frame);
    if (before.primed && memory.accepted_position != before.accepted_position) {
      sum += velocity.x();
      ++renewals;
    }
  }
  // Six or seven frames of 1/600 m make the threshold of 0.01 m: 0.6 or 0.7, as roundoff has it.
  return {{"a true speed of 0.1 m/s at 60 Hz reads, on average", "m/s", 0.65, sum / renewals,
           Agreement::equal, 0.05, "one frame more or less"}};
}

}  // namespace kairos::experiments::thesis
