#include "experiments/random/random_shape.hpp"

#include "experiments/random/scene_builder.hpp"
#include "simulation/scene_library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace kairos::experiments {
namespace {

/// A shipped mesh of a solid, and the radius of a ball around its centre that holds it, m.
struct SolidFile {
  const char* name;
  double reach;
};
constexpr SolidFile angle_iron{"angle.off", 0.6};
constexpr SolidFile ring{"torus.off", 0.41};

std::string path_of(const SolidFile& solid) {
  const std::filesystem::path scenes = std::filesystem::path(find_scene("meshes")).parent_path();
  return std::filesystem::absolute(scenes / "meshes" / solid.name).lexically_normal().string();
}

std::string vector(const Vector3& v) { return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]); }

class Draw {
 public:
  Draw(Random& random, double length, RandomBody& body)
      : random_(random), length_(length), body_(body) {}

  void convex(std::uint64_t kind) {
    const double a = size();
    const double b = size();
    switch (kind) {
      case 0:
        body_.shape = "sphere";
        body_.radius = a;
        break;
      case 1:
        body_.shape = "box";
        body_.half_extents = {a, b, size()};
        break;
      case 2:
        round("capsule", a, b);
        break;
      case 3:
        round("cylinder", a, b);
        break;
      case 4:
        round("cone", a, b);
        break;
      default:
        hull({a, b, size()});
    }
  }
  void compound() {
    body_.shape = "compound";
    for (std::uint64_t k = 2 + random_.below(3); k > 0; --k) {
      RandomBody part;
      Draw(random_, 0.5 * length_, part).convex(random_.below(convex_kinds));
      part.rounding = 0.0;  // parts have none
      const double away = size();
      part.position = random_.direction() * away;
      part.turned = random_vector(random_, 0.0, 3.0);
      body_.parts.push_back(std::move(part));
    }
  }
  void mesh() {
    const SolidFile& solid = random_.below(5) == 0 ? ring : angle_iron;
    body_.shape = "mesh";
    body_.file = path_of(solid);
    body_.unit = size() / solid.reach;
  }
  void height_field() {
    body_.shape = "height-field";
    body_.spacing = 0.7 * size();
    for (int k = 0; k < 9; ++k) {
      body_.heights.push_back(random_.uniform(-0.5, 0.5) * body_.spacing);
    }
    body_.gyration = body_.spacing * body_.spacing;
  }

  static constexpr std::uint64_t convex_kinds = 6;

 private:
  double size() { return length_ * random_.log_uniform(0.02, 0.5); }
  void round(const char* shape, double radius, double length) {
    body_.shape = shape;
    body_.radius = radius;
    body_.length = length;
  }
  /// Makes a hull of points on an ellipsoid.
  void hull(const Vector3& half) {
    body_.shape = "hull";
    for (std::uint64_t k = 4 + random_.below(9); k > 0; --k) {
      body_.points.emplace_back(random_.direction().cwiseProduct(half));
    }
    if (random_.below(4) == 0) {
      body_.rounding = 0.2 * half.minCoeff();
      body_.gyration = 0.2 * half.squaredNorm();
    }
  }

  Random& random_;
  double length_;
  RandomBody& body_;
};

}  // namespace

void draw_shape(Random& random, double length, RandomBody& body) {
  Draw draw(random, length, body);
  const std::uint64_t kind = random.below(Draw::convex_kinds + 3);
  if (kind < Draw::convex_kinds) {
    draw.convex(kind);
  } else if (kind == Draw::convex_kinds) {
    draw.compound();
  } else if (kind == Draw::convex_kinds + 1) {
    draw.mesh();
  } else {
    draw.height_field();
  }
}

double RandomBody::reach() const {
  double own = 0.0;
  if (shape == "sphere") {
    own = radius;
  } else if (shape == "capsule") {
    own = radius + 0.5 * length;
  } else if (shape == "cylinder") {
    own = std::hypot(radius, 0.5 * length);
  } else if (shape == "cone") {
    own = std::hypot(radius, length);
  } else if (shape == "mesh") {
    own = unit * (file.ends_with(ring.name) ? ring.reach : angle_iron.reach);
    own *= moves() ? 1.0 : 2.0;  // others stay about the origin of their file
  } else if (shape == "height-field") {
    own = 2.0 * spacing;
  } else {
    own = half_extents.norm();
  }
  if (shape == "hull") {  // about the centroid, which is within
    own = 0.0;
    for (const Vector3& x : points) {
      for (const Vector3& y : points) {
        own = std::max(own, (x - y).norm() + rounding);
      }
    }
  }
  if (shape == "compound") {  // its centre of mass is among its parts
    own = 0.0;
    for (const RandomBody& part : parts) {
      own = std::max(own, 2.0 * (part.position.norm() + part.reach()));
    }
  }
  return own + swing.norm();
}

std::string shape_toml(const RandomBody& b) {
  std::string out = fmt::format("shape = \"{}\"\n", b.shape);
  const auto line = [&out](std::string_view key, const std::string& value) {
    out += fmt::format("{} = {}\n", key, value);
  };
  const bool round = b.shape == "capsule" || b.shape == "cylinder" || b.shape == "cone";
  if (round || b.shape == "sphere") {
    line("radius", fmt::format("{}", b.radius));
  }
  if (round) {
    line(b.shape == "cone" ? "height" : "length", fmt::format("{}", b.length));
  }
  if (b.shape == "box") {
    line("half_extents", vector(b.half_extents));
  } else if (b.shape == "half-space") {
    line("normal", vector(b.normal));
  } else if (b.shape == "hull") {
    std::string points;
    for (const Vector3& x : b.points) {
      points += (points.empty() ? "" : ", ") + vector(x);
    }
    line("points", '[' + points + ']');
    if (b.rounding > 0.0) {
      line("rounding", fmt::format("{}", b.rounding));
    }
  } else if (b.shape == "mesh") {
    line("file", '"' + b.file + '"');
    line("unit", fmt::format("{}", b.unit));
    line("solid", "true");
  } else if (b.shape == "height-field") {
    const std::vector<double>& h = b.heights;
    line("heights", fmt::format("[[{}, {}, {}], [{}, {}, {}], [{}, {}, {}]]", h[0], h[1], h[2],
                                h[3], h[4], h[5], h[6], h[7], h[8]));
    line("spacing", fmt::format("[{0}, {0}]", b.spacing));
  }
  return out;
}

std::string parts_toml(const RandomBody& b) {
  std::string out;
  for (const RandomBody& part : b.parts) {
    out += "\n[[body.part]]\n" + shape_toml(part);
    out += fmt::format("position = {}\n", vector(part.position));
    if (const double angle = part.turned.norm(); angle > 0.0) {
      const Vector3 axis = part.turned / angle;
      out += fmt::format("axis_angle = [{}, {}, {}, {}]\n", axis[0], axis[1], axis[2], angle);
    }
  }
  return out;
}

}  // namespace kairos::experiments
