#include "experiments/render/footage.hpp"

#include "core/error.hpp"
#include "core/mesh_body.hpp"
#include "core/reading/csv.hpp"
#include "core/reading/document.hpp"
#include "core/reading/point_list.hpp"
#include "experiments/output/output_folder.hpp"
#include "experiments/output/table_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <system_error>

namespace kairos::experiments {
namespace {

namespace fs = std::filesystem;

/// The bodies of a `summary.json`, which holds one member a line, as `JsonWriter` writes it.
class Summary {
 public:
  Summary(const std::string& path, std::string_view text) : path_(path) {
    std::string_view rest = text;
    std::vector<std::string> open;
    for (int line = 1; !rest.empty(); ++line) {
      const std::size_t end = rest.find('\n');
      read_line(trimmed(rest.substr(0, end)), line, open);
      rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    }
    if (bodies_.empty()) {
      throw InputError(path, 0, "bodies", "is missing; is this what `kairos run` wrote?");
    }
  }

  [[nodiscard]] std::vector<Actor> actors() const {
    std::vector<Actor> actors;
    for (const Fields& body : bodies_) {
      actors.push_back(actor(body));
    }
    return actors;
  }

 private:
  struct Fields {
    std::string name;
    int line = 0;
    std::map<std::string, std::string> values{};
  };

  static std::string unquoted(std::string_view text) {
    const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
    return std::string(quoted ? text.substr(1, text.size() - 2) : text);
  }

  void read_line(std::string_view line, int number, std::vector<std::string>& open) {
    if (line.starts_with('}')) {
      if (!open.empty()) {
        open.pop_back();
      }
      return;
    }
    const std::size_t colon = line.find("\": ");
    if (colon == std::string_view::npos) {
      return;
    }
    const std::string key = unquoted(line.substr(0, colon + 1));
    std::string_view value = trimmed(line.substr(colon + 3));
    if (value == "{") {
      open.push_back(key);
      if (open.size() == 2 && open.front() == "bodies") {
        bodies_.push_back({key, number});
      }
      return;
    }
    if (value.ends_with(',')) {
      value.remove_suffix(1);
    }
    if (open.size() == 2 && open.front() == "bodies") {
      bodies_.back().values[key] = unquoted(value);
    }
  }

  [[noreturn]] void fail(const Fields& body, const std::string& key,
                         const std::string& reason) const {
    throw InputError(path_, body.line, fmt::format("bodies.{}.{}", body.name, key), reason);
  }
  [[nodiscard]] const std::string& field(const Fields& body, const std::string& key) const {
    const auto found = body.values.find(key);
    if (found == body.values.end()) {
      fail(body, key, "is missing (is the file truncated?)");
    }
    return found->second;
  }
  [[nodiscard]] double extent(const Fields& body, const std::string& key) const {
    const auto x = parse_number(field(body, key));
    if (!x || !(*x > 0.0)) {
      fail(body, key, fmt::format("is {}; allowed: a number > 0 (m)", field(body, key)));
    }
    return *x;
  }

  [[nodiscard]] HalfSpace half_space(const Fields& body) const {
    Vector3 normal;
    for (int k = 0; k < 3; ++k) {
      const std::string key = std::string("n") + "xyz"[k];
      const auto x = parse_number(field(body, key));
      if (!x) {
        fail(body, key, fmt::format("is {}; allowed: a number", field(body, key)));
      }
      normal[k] = *x;
    }
    if (!(std::abs(normal.norm() - 1.0) < 1e-6)) {  // printed digits
      fail(body, "nx", "is not of a unit normal");
    }
    return {normal};
  }

  /// Three numbers each, of the vertices or triangles of a body.
  [[nodiscard]] std::vector<Vector3> triples(const Fields& body, const std::string& key) const {
    const auto found = read_point_list(field(body, key), [&](std::string_view word) {
      const auto x = parse_number(word);
      if (!x) {
        fail(body, key, fmt::format("holds {}; allowed: numbers", word));
      }
      return *x;
    });
    if (!found) {
      fail(body, key, "holds no whole number of rows; allowed: three numbers each");
    }
    return *found;
  }

  [[nodiscard]] Hull hull(const Fields& body) const {
    const std::vector<Vector3> points = triples(body, "vertices");
    const auto rounding = parse_number(field(body, "rounding"));
    try {
      return {convex_hull(points).polytope, rounding.value_or(0.0)};
    } catch (const std::exception& error) {
      fail(body, "vertices", error.what());
    }
  }

  [[nodiscard]] Mesh mesh(const Fields& body) const {
    MeshData data{triples(body, "vertices"), {}};
    for (const Vector3& t : triples(body, "triangles")) {
      if (!((t.array() >= 0.0).all() && (t.array() < 4e9).all())) {
        fail(body, "triangles", "holds a corner that does not exist");
      }
      data.triangles.push_back({static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]),
                                static_cast<std::uint32_t>(t[2])});
    }
    try {
      return {mesh_in_place(std::move(data), CollisionMesh::Kind::surface)};
    } catch (const std::exception& error) {
      fail(body, "triangles", error.what());
    }
  }

  [[nodiscard]] Actor actor(const Fields& body) const {
    Actor actor;
    actor.name = body.name;
    actor.entity = field(body, "entity");
    const std::string& shape = field(body, "shape");
    if (shape == "sphere") {
      actor.shape = Sphere{extent(body, "hx")};
    } else if (shape == "mesh" && body.values.contains("triangles")) {
      actor.shape = mesh(body);
    } else if (shape == "box" || shape == "mesh" || shape == "compound") {  // as their box
      actor.shape = Box{{extent(body, "hx"), extent(body, "hy"), extent(body, "hz")}};
    } else if (shape == "half-space") {
      actor.shape = half_space(body);
    } else if (shape == "capsule") {
      const double radius = extent(body, "hx");
      actor.shape = Capsule{radius, 2.0 * (extent(body, "hy") - radius)};
    } else if (shape == "cylinder") {
      actor.shape = Cylinder{extent(body, "hx"), 2.0 * extent(body, "hy")};
    } else if (shape == "cone") {
      actor.shape = Cone{extent(body, "hx"), extent(body, "hy") / 0.75};
    } else if (shape == "hull") {
      actor.shape = hull(body);
    } else {
      fail(
          body, "shape",
          fmt::format("is \"{}\"; allowed: sphere, box, half-space, capsule, cylinder, cone, hull, "
                      "mesh, compound",
                      shape));
    }
    const bool as_box = field(body, "bounds") == "obb" && shape != "half-space";
    actor.collides_as = as_box ? Shape(bounding_box(actor.shape)) : actor.shape;
    actor.is_free = field(body, "moves") == "free";
    actor.moves = field(body, "moves") != "fixed";
    actor.is_field = field(body, "field") == "true";
    return actor;
  }

  std::string path_;
  std::vector<Fields> bodies_;
};

void read_pictures(const TableRows& rows, Footage& footage) {
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < footage.actors.size(); ++i) {
    index[footage.actors[i].name] = i;
  }
  std::vector<Pose> poses(footage.actors.size());
  std::size_t seen = 0;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const auto body = index.find(rows.text(row, "body"));
    if (body == index.end()) {
      rows.fail(row, "body", fmt::format("\"{}\" is not in summary.json", rows.text(row, "body")));
    }
    Pose& pose = poses[body->second];
    pose.position = rows.vector(row, "px", "py", "pz");
    pose.orientation = Quaternion(rows.number(row, "qw"), rows.number(row, "qx"),
                                  rows.number(row, "qy"), rows.number(row, "qz"));
    if (!(std::abs(pose.orientation.norm() - 1.0) < 1e-6)) {  // printed digits
      rows.fail(row, "qw", "is no unit quaternion");
    }
    if (++seen == poses.size()) {
      footage.pictures.push_back({rows.number(row, "t"), poses});
      seen = 0;
    }
  }
}

}  // namespace

std::size_t Footage::at(double time) const {
  // An event that rounding puts before a frame's time belongs to that frame.
  const double slack = 1e-9 * (1.0 + std::abs(time));
  const auto after =
      std::upper_bound(pictures.begin(), pictures.end(), time + slack,
                       [](double t, const Picture& picture) { return t < picture.time; });
  return after == pictures.begin() ? 0 : static_cast<std::size_t>(after - pictures.begin()) - 1;
}

void FootageRecorder::begin(const Model& model) {
  footage_ = {};
  footage_.title = model.scene().name;
  footage_.actors = actors_of(model);
  footage_.joints = model.scene().joints;
}

void FootageRecorder::frame(const Frame& frame) {
  Footage::Picture& picture = footage_.pictures.emplace_back();
  picture.time = frame.time.seconds;
  for (const BodyState& body : frame.bodies) {
    picture.poses.push_back(body.pose);
  }
}

Footage read_footage(const std::string& path) {
  std::error_code error;
  const fs::path trajectory =
      fs::is_directory(path, error) ? fs::path(path) / "trajectory.csv" : fs::path(path);
  const fs::path summary = trajectory.parent_path() / "summary.json";
  for (const fs::path& file : {trajectory, summary}) {
    if (!fs::is_regular_file(file, error)) {
      throw InputError(file.string(), 0, "",
                       "is not there; needed: the folder that `kairos run SCENE --out DIR` wrote");
    }
  }
  Footage footage;
  const fs::path absolute = fs::absolute(trajectory, error);
  footage.title = absolute.parent_path().filename().string();
  const std::string before = read_text_file(summary.string());
  footage.actors = Summary(summary.string(), before).actors();
  read_pictures(TableRows(trajectory.string()), footage);
  if (incomplete(summary.parent_path()) || read_text_file(summary.string()) != before) {
    throw InputError(summary.string(), 0, "",
                     "belongs to other files than lie beside it: a run was writing them, or was "
                     "killed as it did; run it again");
  }
  if (footage.pictures.empty()) {
    throw InputError(trajectory.string(), 0, "", "holds no frame");
  }
  return footage;
}

}  // namespace kairos::experiments
