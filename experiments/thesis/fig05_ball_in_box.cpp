#include "core/random.hpp"
#include "experiments/thesis/thesis_figure.hpp"
#include "simulation/registry.hpp"

#include <cmath>
#include <numbers>

namespace kairos::experiments::thesis {
namespace {

constexpr std::uint64_t seed = 32;
constexpr double pi = std::numbers::pi;

/// Area (in the plane) or volume.
double content(const Shape& shape, int dimensions) {
  if (const auto* ball = std::get_if<Sphere>(&shape)) {
    const double r = ball->radius;
    return dimensions == 2 ? pi * r * r : 4.0 / 3.0 * pi * r * r * r;
  }
  const Vector3& half = std::get<Box>(shape).half_extents;
  return dimensions == 2 ? 4.0 * half.x() * half.y() : 8.0 * half.prod();
}

/// Fraction of the outer shape that the inner one fills, by asking the library about points.
double sampled(const Shape& inner, const Shape& outer, int dimensions, int n) {
  const auto detector = find_detector("sat");
  const double reach = bounding_radius(outer);
  Random random(seed, static_cast<std::uint64_t>(dimensions));
  std::int64_t in_outer = 0;
  std::int64_t in_inner = 0;
  for (int k = 0; k < n; ++k) {
    const double x = random.uniform(-reach, reach);
    const double y = random.uniform(-reach, reach);
    const double z = random.uniform(-reach, reach);
    const Pose point{.position = {x, y, dimensions == 2 ? 0.0 : z}};
    const Shape grain = Sphere{1e-12};
    if (detector->overlaps(grain, point, outer, {})) {
      ++in_outer;
      in_inner += detector->overlaps(grain, point, inner, {}) ? 1 : 0;
    }
  }
  return static_cast<double>(in_inner) / static_cast<double>(in_outer);
}

/// Half the side of the square or cube that has the content of the ball of this radius.
double half_side(double radius, int dimensions) {
  return 0.5 * std::pow(content(Sphere{radius}, dimensions), 1.0 / dimensions);
}

void measure(FigureData& data) {
  const int n = data.size() == Size::full ? 4000000 : 200000;
  Table& fits = data.table("fits", {{"dimensions", "", "2: areas, 3: volumes"},
                                    {"body", "", "what is enclosed; both have the same content"},
                                    {"bound", "", "what encloses it, fitted by the library"},
                                    {"content", "", "of the body, in units of r^2 or r^3"},
                                    {"bound_content", "", "of the bound, in the same units"},
                                    {"ratio", "", "bound to body"},
                                    {"sampled", "", "the same ratio by random points"},
                                    {"half_side", "", "half side of the square or cube, r"},
                                    {"radius", "", "of the ball, r"}});
  const Sphere ball{1.0};
  for (const int dimensions : {2, 3}) {
    const double half = half_side(ball.radius, dimensions);
    const Box box{{half, half, dimensions == 2 ? 0.0 : half}};
    const auto add = [&](const char* body_name, const Shape& body, const char* bound_name,
                         const Shape& bound, double side, double radius) {
      const double inner = content(body, dimensions);
      const double outer = content(bound, dimensions);
      // In the plane a thick box stands for the square, so that points are asked for x and y only.
      const auto thick = [](const Shape& shape) -> Shape {
        const auto* flat = std::get_if<Box>(&shape);
        return flat == nullptr || flat->half_extents.z() > 0.0
                   ? shape
                   : Box{{flat->half_extents.x(), flat->half_extents.y(), 1.0}};
      };
      fits.rows.push_back({std::int64_t{dimensions}, std::string(body_name),
                           std::string(bound_name), inner, outer, outer / inner,
                           1.0 / sampled(thick(body), thick(bound), dimensions, n), side, radius});
      data.value(std::string(body_name) + (dimensions == 2 ? "2" : "3"), outer / inner, "",
                 std::string(bound_name) + " around a " + body_name + ", content relative to it");
    };
    const Box around = bounding_box(ball);
    add("ball", ball, "box",
        dimensions == 2 ? Box{{around.half_extents.x(), around.half_extents.y(), 0.0}} : around,
        around.half_extents.x(), ball.radius);
    add("box", box, "ball", Sphere{bounding_radius(box)}, half, bounding_radius(box));
  }
  data.value("early", bounding_radius(bounding_box(ball)) - ball.radius, "r",
             "how far outside the ball a corner of its box reaches");
  data.count("points", n, "random points of each check");
  data.count("seed", static_cast<std::int64_t>(seed), "of the points");
}

}  // namespace

ThesisFigure ball_in_box() {
  return {.name = "fig05",
          .chapter = "3",
          .title = "Figure 5: a ball in a box, a box in a ball",
          .shows =
              "A box encloses a circle more tightly (4 r² against π r²) than a circle "
              "encloses a square of the same area (4.934 r²); “extrapolating to 3D” the thesis "
              "changes CoRgi's bounding volume from a sphere to a box (3.2).",
          .how =
              "The library fits the box around the ball and the ball around the cube; areas and "
              "volumes follow, and are checked by {points} random points (seed {seed}) put to the "
              "same overlap test that collisions use.",
          .caption =
              "Bodies of equal area (above) and volume (below), each in the other's bounding "
              "volume.",
          .finding =
              "Confirmed, and in 3-D more so: the box has {ball2} times the area and {ball3} "
              "times the volume of the ball, the ball {box2} and {box3} times those of the "
              "square and cube. The price: a corner of the ball's box reaches {early} beyond "
              "the ball.",
          .script = "thesis.fig05",
          .measure = measure};
}

}  // namespace kairos::experiments::thesis
