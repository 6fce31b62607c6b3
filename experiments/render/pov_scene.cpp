#include "experiments/render/pov_scene.hpp"

#include "core/error.hpp"
#include "core/mesh_body.hpp"
#include "core/reading/csv.hpp"
#include "core/rotation_between.hpp"
#include "simulation/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace kairos::experiments {
namespace {

struct Colour {
  std::string_view name;
  double red, green, blue;
};
/// For balls without a colour in their name, in turn; those first that differ most in lightness.
constexpr std::array<Colour, 6> palette{{{"red", 0.85, 0.15, 0.12},
                                         {"blue", 0.12, 0.25, 0.75},
                                         {"green", 0.15, 0.6, 0.2},
                                         {"yellow", 0.95, 0.8, 0.15},
                                         {"violet", 0.55, 0.2, 0.65},
                                         {"orange", 0.95, 0.5, 0.1}}};

std::string vec(const Vector3& v) {
  return fmt::format("<{:.9g},{:.9g},{:.9g}>", v.x(), v.y(), v.z());
}

/// Unit vectors become the columns of m, the origin becomes p: a linear map as POV-Ray writes it.
std::string matrix(const Matrix3& m, const Vector3& p) {
  return fmt::format(
      "matrix <{:.9g},{:.9g},{:.9g}, {:.9g},{:.9g},{:.9g}, {:.9g},{:.9g},{:.9g}, "
      "{:.9g},{:.9g},{:.9g}>",
      m(0, 0), m(1, 0), m(2, 0), m(0, 1), m(1, 1), m(2, 1), m(0, 2), m(1, 2), m(2, 2), p.x(), p.y(),
      p.z());
}

/// Body axes to the world.
std::string matrix(const Pose& pose) {
  return matrix(pose.orientation.toRotationMatrix(), pose.position);
}

std::string pigment(const Colour& c, double transmit) {
  return fmt::format("pigment {{ color rgb <{},{},{}> transmit {} }}", c.red, c.green, c.blue,
                     transmit);
}

/// The colour by the name or the kind of an actor, or the next of the palette.
Colour colour_of(const Actor& actor, std::size_t free_index) {
  for (const Colour& colour : palette) {
    if (actor.name.find(colour.name) != std::string::npos) {
      return colour;
    }
  }
  if (actor.is_free) {
    return palette[(free_index + 5) % palette.size()];
  }
  if (actor.is_field) {
    return {"", 0.35, 0.8, 0.9};
  }
  if (actor.entity == "bat") {
    return {"", 0.75, 0.2, 0.2};
  }
  if (actor.entity == "hand") {
    return {"", 0.9, 0.7, 0.55};
  }
  return actor.entity == "conveyor" ? Colour{"", 0.45, 0.42, 0.5} : Colour{"", 0.25, 0.45, 0.4};
}

/// The solid below the planes of all faces; rounded edges are drawn sharp.
std::string planes(const Hull& hull) {
  const Polytope& polytope = *hull.core;
  std::string text = "intersection { ";
  for (std::size_t f = 0; f < polytope.normals.size(); ++f) {
    const Vector3& n = polytope.normals[f];
    const double offset = n.dot(polytope.vertices[polytope.faces[f][0]]) + hull.rounding;
    text += fmt::format("plane {{ {}, {:.9g} }} ", vec(n), offset);
  }
  return text;
}

/// A mesh of triangles, with what they enclose as its inside.
std::string triangles(const CollisionMesh& mesh) {
  std::string text = fmt::format("mesh2 {{ vertex_vectors {{ {}", mesh.vertices().size());
  for (const Vector3& x : mesh.vertices()) {
    text += ", " + vec(x);
  }
  text += fmt::format(" }} face_indices {{ {}", mesh.triangles().size());
  for (const Triangle& t : mesh.triangles()) {
    text += fmt::format(", <{},{},{}>", t[0], t[1], t[2]);
  }
  return text + " } inside_vector <0.31, 0.83, 0.46> ";
}

/// Geometry alone, in body axes, so that it can be cut with another.
std::string solid(const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    return fmt::format("sphere {{ 0, {:.9g} ", sphere->radius);
  }
  if (const auto* box = std::get_if<Box>(&shape)) {
    return fmt::format("box {{ {}, {} ", vec(-box->half_extents), vec(box->half_extents));
  }
  if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    const Vector3 end(0.0, 0.5 * capsule->length, 0.0);
    const double r = capsule->radius;
    return fmt::format(
        "merge {{ cylinder {{ {0}, {1}, {2:.9g} }} sphere {{ {0}, {2:.9g} }} sphere {{ {1}, "
        "{2:.9g} "
        "}} ",
        vec(-end), vec(end), r);
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    const Vector3 end(0.0, 0.5 * cylinder->length, 0.0);
    return fmt::format("cylinder {{ {}, {}, {:.9g} ", vec(-end), vec(end), cylinder->radius);
  }
  if (const auto* cone = std::get_if<Cone>(&shape)) {
    return fmt::format("cone {{ {}, {:.9g}, {}, 0 ", vec({0.0, -0.25 * cone->height, 0.0}),
                       cone->radius, vec({0.0, 0.75 * cone->height, 0.0}));
  }
  if (const auto* hull = std::get_if<Hull>(&shape)) {
    return planes(*hull);
  }
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    return triangles(mesh->body->mesh);
  }
  if (const auto* compound = std::get_if<Compound>(&shape)) {
    return solid(bounding_box(*compound));
  }
  return "plane { y, 0 ";
}

/// A blade and its handle, as large as the box that they collide as: thin along its shortest edge,
/// the handle towards the negative end of its longest.
std::string racket(const Box& box) {
  const Vector3& h = box.half_extents;
  int thin = 0;
  int along = 0;
  h.minCoeff(&thin);
  h.maxCoeff(&along);
  const int wide = 3 - thin - along;
  Vector3 radii = h;
  radii[along] *= 0.72;
  Vector3 centre = Vector3::Zero();
  centre[along] = 0.28 * h[along];
  Vector3 least = -h;
  least[wide] *= 0.2;
  Vector3 most = h;
  most[wide] *= 0.2;
  most[along] = -0.3 * h[along];
  const Vector3 axis = Vector3::Unit(thin);
  return fmt::format("union {{ cylinder {{ {}, {}, 1 scale {} translate {} }} box {{ {}, {} }} ",
                     vec(-axis), vec(axis), vec(radii), vec(centre), vec(least), vec(most));
}

/// The twelve edges of a box.
std::string wire(const Box& box, const Pose& pose, double thickness, const Colour& colour) {
  const Vector3& h = box.half_extents;
  std::string text = "union {\n";
  for (int axis = 0; axis < 3; ++axis) {
    for (const double u : {-1.0, 1.0}) {
      for (const double v : {-1.0, 1.0}) {
        Vector3 from;
        from[axis] = -h[axis];
        from[(axis + 1) % 3] = u * h[(axis + 1) % 3];
        from[(axis + 2) % 3] = v * h[(axis + 2) % 3];
        Vector3 to = from;
        to[axis] = h[axis];
        text += fmt::format("cylinder {{ {}, {}, {:.9g} }}\n", vec(from), vec(to), thickness);
      }
    }
  }
  return text + fmt::format("{} finish {{ emission 0.25 }} no_shadow {} }}\n", pigment(colour, 0.0),
                            matrix(pose));
}

class Painter {
 public:
  Painter(const Footage& footage, std::size_t picture, const PictureOptions& options)
      : footage_(footage),
        picture_(footage.pictures[picture]),
        options_(options),
        common_(overlapping(footage, picture)),
        thickness_(0.0016 * (options.camera.position - options.camera.target).norm()) {}

  std::string paint() {
    std::string text = head();
    std::size_t free_index = 0;
    for (std::size_t i = 0; i < footage_.actors.size(); ++i) {
      const Actor& actor = footage_.actors[i];
      const Colour colour = colour_of(actor, free_index);
      free_index += actor.is_free ? 1 : 0;
      text += body(i, colour);
    }
    for (const Overlapping& pair : common_) {
      text += in_common(pair);
    }
    return text + label();
  }

 private:
  std::string head() const {
    const Camera& camera = options_.camera;
    const Vector3 sun =
        camera.position + Vector3(-0.4, 1.2, 0.2) * (camera.position - camera.target).norm();
    // The minus sign makes POV-Ray's left-handed frame right-handed.
    return fmt::format(
        "#version 3.7;\nglobal_settings {{ assumed_gamma 1.0 }}\n"
        "background {{ color rgb <0.93,0.94,0.96> }}\n"
        "camera {{ perspective location {} right <-{:.9g},0,0> up <0,1,0> angle {:.9g} look_at {} "
        "}}\n"
        "light_source {{ {}, color rgb 0.85 }}\n"
        "light_source {{ {}, color rgb 0.35 shadowless }}\n"
        "#default {{ finish {{ ambient 0 diffuse 0.85 emission 0.12 }} }}\n",
        vec(camera.position), static_cast<double>(options_.width) / options_.height, camera.angle,
        vec(camera.target), vec(sun), vec(camera.position));
  }

  [[nodiscard]] bool overlaps(std::size_t i) const {
    return std::any_of(common_.begin(), common_.end(),
                       [i](const Overlapping& pair) { return pair.a == i || pair.b == i; });
  }

  std::string body(std::size_t i, const Colour& colour) const {
    const Actor& actor = footage_.actors[i];
    const Pose& pose = picture_.poses[i];
    if (const auto* half_space = std::get_if<HalfSpace>(&actor.shape)) {
      return plane(*half_space, pose);
    }
    const auto* box = std::get_if<Box>(&actor.shape);
    const bool is_bat = box != nullptr && actor.entity == "bat";
    double transmit = actor.is_free ? 0.0 : 0.25;
    if (actor.is_field) {
      transmit = 0.72;
    } else if (actor.entity == "hand") {
      transmit = 0.5;  // what it holds shows through
    } else if (overlaps(i)) {
      transmit = 0.55;  // what is common shows through
    }
    std::string text =
        fmt::format("{} {} {} {} }}\n", is_bat ? racket(*box) : solid(actor.shape),
                    pigment(colour, transmit), actor.is_field ? "no_shadow" : "", matrix(pose));
    const Colour dark{"", 0.5 * colour.red, 0.5 * colour.green, 0.5 * colour.blue};
    if (box != nullptr) {
      text += wire(*box, pose, is_bat ? 0.6 * thickness_ : thickness_, dark);
    } else if (const auto* bounds = std::get_if<Box>(&actor.collides_as);
               bounds != nullptr && options_.boxes) {
      text += wire(*bounds, pose, 0.6 * thickness_, dark);
    }
    return text;
  }

  /// A wall without an end: left out where it would stand between the eye and all else, pale where
  /// something is behind it.
  [[nodiscard]] std::string plane(const HalfSpace& half_space, const Pose& pose) const {
    const Vector3 normal = half_space_normal(half_space, pose);
    const auto behind = [&](const Vector3& p) { return normal.dot(p - pose.position) < 0.0; };
    if (behind(options_.camera.position)) {
      return {};
    }
    // The pattern lies in the plane: y is turned to the normal.
    const Quaternion up = rotation_between(Vector3::UnitY(), half_space.normal_B);
    bool hides = false;
    for (std::size_t i = 0; i < footage_.actors.size(); ++i) {
      hides = hides || (footage_.actors[i].is_free && behind(picture_.poses[i].position));
    }
    const double transmit = hides ? 0.5 : 0.0;
    return fmt::format(
        "plane {{ y, 0 pigment {{ checker color rgb 0.82 transmit {} color rgb 0.74 transmit {} "
        "scale {:.9g} }} {} }}\n",
        transmit, transmit, 25.0 * thickness_, matrix({pose.position, pose.orientation * up}));
  }

  std::string in_common(const Overlapping& pair) const {
    std::string text = "intersection {\n";
    for (const std::size_t i : {pair.a, pair.b}) {
      text += solid(footage_.actors[i].collides_as) + matrix(picture_.poses[i]) + " }\n";
    }
    return text + "pigment { color rgb <1,0,0.8> } finish { emission 1 } no_shadow }\n";
  }

  /// As POV-Ray reads a string: the name of a folder is no part of the script.
  static std::string quoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
      if (c == '"' || c == '\\') {
        out += '\\';
      }
      out += c >= ' ' && c <= '~' ? c : '?';
    }
    return out + '"';
  }

  /// Close before the eye, on a light strip along the lower edge, so that it can be read on
  /// anything.
  std::string label() const {
    const Camera& camera = options_.camera;
    const Vector3 ahead = (camera.target - camera.position).normalized();
    const Vector3 right = ahead.cross(Vector3::UnitY()).normalized();
    const Vector3 up = right.cross(ahead);
    const double half_width = std::tan(camera.angle * std::numbers::pi / 360.0);
    const double half_height = half_width * options_.height / options_.width;
    const double size = 0.13 * half_height;
    // Distance of the label, so small that nothing is in front of it.
    const double near = 0.02 * (camera.target - camera.position).norm();
    const Vector3 corner =
        camera.position + near * (ahead - 0.96 * half_width * right - 0.94 * half_height * up);
    const std::string text = fmt::format("{:.3f} s{}{}", picture_.time,
                                         options_.label.empty() ? "" : "  ", options_.label);
    Matrix3 letters;
    letters << near * size * right, near * size * up, 1e-3 * near * size * ahead;
    // Behind it, from beyond the lower left corner: the whole width, a tenth of the height.
    const double far = 1.01 * near;
    const Vector3 edge =
        camera.position + far * (ahead - 1.01 * half_width * right - 1.01 * half_height * up);
    Matrix3 strip;
    strip << 2.02 * far * half_width * right, 0.22 * far * half_height * up, far * ahead;
    return fmt::format(
        "polygon {{ 5, <0,0>,<1,0>,<1,1>,<0,1>,<0,0> pigment {{ color rgbt <0.93,0.94,0.96,0.3> }} "
        "finish {{ emission 1 diffuse 0 }} no_shadow {} }}\n"
        "text {{ internal 1 {}, 1, 0 pigment {{ color rgb 0.02 }} finish {{ emission 0.02 "
        "diffuse 0 }} no_shadow {} }}\n",
        matrix(strip, edge), quoted(text), matrix(letters, corner));
  }

  const Footage& footage_;
  const Footage::Picture& picture_;
  const PictureOptions& options_;
  std::vector<Overlapping> common_;
  double thickness_;  ///< of wires, m
};

}  // namespace

Camera parse_camera(std::string_view text) {
  std::vector<double> numbers;
  for (std::string_view rest = text;;) {
    const std::size_t comma = rest.find(',');
    const auto x = parse_number(trimmed(rest.substr(0, comma)));
    if (!x) {
      break;
    }
    numbers.push_back(*x);
    if (comma == std::string_view::npos) {
      break;
    }
    rest.remove_prefix(comma + 1);
  }
  const auto commas = static_cast<std::size_t>(std::count(text.begin(), text.end(), ','));
  if (numbers.size() != commas + 1 || (numbers.size() != 6 && numbers.size() != 7)) {
    throw InputError(
        "", 0, "--camera",
        fmt::format("'{}' is no camera; allowed: px,py,pz,tx,ty,tz (where it is, where "
                    "it looks, m), and an angle in degrees after them",
                    text));
  }
  Camera camera{{numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]}};
  camera.angle = numbers.size() == 7 ? numbers[6] : camera.angle;
  const Vector3 ahead = camera.target - camera.position;
  if (!(ahead.cross(Vector3::UnitY()).norm() > 1e-9 * ahead.norm()) || !(camera.angle > 0.0) ||
      !(camera.angle < 180.0)) {
    throw InputError("", 0, "--camera",
                     "looks straight up or down, nowhere, or with an angle that is not between 0 "
                     "and 180 degrees");
  }
  return camera;
}

namespace {

/// The box around what is looked at.
struct Extent {
  Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity());
  Vector3 high = -low;

  void add(const Vector3& centre, double radius) {
    low = low.cwiseMin(centre - Vector3::Constant(radius));
    high = high.cwiseMax(centre + Vector3::Constant(radius));
  }
  [[nodiscard]] bool empty() const { return !(low.x() <= high.x()); }
  [[nodiscard]] double radius() const { return 0.5 * (high - low).norm(); }
};

}  // namespace

Camera camera_for(std::span<const Shot> shots, double aspect) {
  Extent seen;
  for (const bool moving : {true, false}) {
    // Bodies at rest are shown whole, unless they are this many times as large as what moves.
    constexpr double dwarfs = 3.0;
    const double most =
        moving || seen.empty() ? std::numeric_limits<double>::infinity() : dwarfs * seen.radius();
    for (const auto& [footage, first, last] : shots) {
      for (std::size_t i = 0; i < footage->actors.size(); ++i) {
        const Actor& actor = footage->actors[i];
        const double radius = bounding_radius(actor.shape);
        if (actor.moves != moving || !std::isfinite(radius) || radius > most) {
          continue;
        }
        for (std::size_t k = first; k <= last; ++k) {
          seen.add(footage->pictures[k].poses[i].position, radius);
        }
      }
    }
  }
  if (seen.empty()) {
    seen.add(Vector3::Zero(), 1.0);  // nothing but planes
  }
  Camera camera;
  camera.target = 0.5 * (seen.low + seen.high);
  // The angle is across the picture; the narrower side must hold it all.
  const double half = std::tan(0.5 * camera.angle * std::numbers::pi / 180.0);
  const double narrow = std::atan(std::min(half, half / aspect));
  const double distance = 1.05 * seen.radius() / std::sin(narrow);
  camera.position = camera.target + distance * Vector3(0.3, 0.3, 1.0).normalized();
  return camera;
}

std::vector<Overlapping> overlapping(const Footage& footage, std::size_t picture) {
  const auto detector = find_detector("certified");
  const std::vector<Pose>& poses = footage.pictures[picture].poses;
  std::vector<Overlapping> found;
  const auto solid = [](const Actor& actor) { return !actor.is_field && actor.entity != "hand"; };
  for (std::size_t a = 0; a < poses.size(); ++a) {
    for (std::size_t b = a + 1; b < poses.size(); ++b) {
      const Actor& first = footage.actors[a];
      const Actor& second = footage.actors[b];
      if (!solid(first) || !solid(second) || !(first.is_free || second.is_free)) {
        continue;
      }
      const double gap =
          detector->overlap(first.collides_as, poses[a], second.collides_as, poses[b]).gap;
      const double scale = poses[a].position.norm() + poses[b].position.norm() +
                           smallest_extent(first.is_free ? first.shape : second.shape);
      // Less is roundoff, or too thin to be seen.
      if (gap < -1e-9 * scale) {
        found.push_back({a, b, -gap});
      }
    }
  }
  return found;
}

std::string pov_scene(const Footage& footage, std::size_t picture, const PictureOptions& options) {
  return Painter(footage, picture, options).paint();
}

}  // namespace kairos::experiments
