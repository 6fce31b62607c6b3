#include "core/reading/scene_reader.hpp"

#include "core/error.hpp"
#include "core/exact_solution.hpp"
#include "core/nearest_name.hpp"
#include "core/reading/body_reader.hpp"
#include "core/reading/def_reader.hpp"
#include "core/reading/document.hpp"
#include "core/reading/force_reader.hpp"
#include "core/reading/frame_reader.hpp"
#include "core/reading/joint_reader.hpp"
#include "core/reading/many_reader.hpp"
#include "core/reading/overrides.hpp"
#include "core/reading/scene_keys.hpp"
#include "core/reading/scene_limits.hpp"
#include "core/reading/scene_name.hpp"
#include "core/reading/table_reader.hpp"
#include "core/scene.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

constexpr std::string_view gravity_names[] = {"acceleration", "force"};

FrameTimes read_frame_table(const TableReader& table, const std::string& directory) {
  table.refuse_unknown(scene_keys_of("frame"));
  if (const auto csv = table.find("csv")) {
    for (const std::string_view key : scene_keys_of("frame")) {
      if (key != "csv" && table.has(key)) {
        table.fail(key, "csv is given too; allowed: either csv or mean");
      }
    }
    return read_frame_csv(csv->readable_file(directory));
  }
  const auto number = [&table](std::string_view key, const Range& range, double fallback) {
    const auto item = table.find(key);
    return item ? item->number(range) : fallback;
  };
  JitteredFrames frames;
  frames.mean = table.need("mean", "csv, or mean, a duration").duration();
  // Below 1, so that no frame has length 0.
  frames.jitter = number("jitter", {.lowest = 0.0, .highest = 0.999}, frames.jitter);
  frames.spike_probability =
      number("spike_probability", {.lowest = 0.0, .highest = 1.0}, frames.spike_probability);
  frames.spike_factor =
      number("spike_factor", {.lowest = 1.0, .highest = 1e6}, frames.spike_factor);
  if (const auto seed = table.find("seed")) {
    frames.seed =
        static_cast<std::uint64_t>(seed->whole_number(0, std::numeric_limits<std::int64_t>::max()));
  }
  return frames;
}

FrameTimes read_frames(const Item& item, const std::string& directory) {
  if (item.value().table() != nullptr) {
    return read_frame_table(TableReader(item), directory);
  }
  return FixedFrames{item.duration()};
}

ExactSolution read_exact(const Item& item) {
  const TableReader table(item);
  table.refuse_unknown(scene_keys_of("exact"));
  std::vector<std::string_view> names;
  for (const ExactSolutionType& type : exact_solution_catalogue()) {
    names.push_back(type.name);
  }
  const Item solution = table.need("solution", "one of " + std::string("the exact solutions"));
  return {std::string(names[solution.choice(names)]), {}};
}

void read_bodies(const Item& item, const BodyDefaults& defaults, Scene& scene) {
  const Array& array = item.array();
  UniqueNames names;
  for (std::size_t i = 0; i < array.size(); ++i) {
    const Item element(array[i], element_path("body", array[i], i));
    scene.bodies.push_back(read_body(element, defaults));
    names.add(*TableReader(element).find("name"), "body", array[i].line);
  }
  if (scene.bodies.empty()) {
    item.fail("is empty; needed: at least one [[body]]");
  }
}

void read_manies(const Item& item, const BodyDefaults& defaults, Scene& scene) {
  const Array& array = item.array();
  UniqueNames names;
  for (std::size_t i = 0; i < array.size(); ++i) {
    const Item element(array[i], element_path("many", array[i], i));
    read_many(element, defaults, scene.bodies);
    names.add(*TableReader(element).find("name"), "many", array[i].line);
  }
}

void read_forces(const Item& item, double G, Scene& scene) {
  const Array& array = item.array();
  UniqueNames names;
  for (std::size_t i = 0; i < array.size(); ++i) {
    const Item element(array[i], element_path("force", array[i], i));
    read_force(element, G, scene);
    if (const auto name = TableReader(element).find("name")) {
      (void)read_name(*name);
      names.add(*name, "force", array[i].line);
    }
  }
}

void read_joints(const Item& item, Scene& scene) {
  const Array& array = item.array();
  UniqueNames names;
  for (std::size_t i = 0; i < array.size(); ++i) {
    const Item element(array[i], element_path("joint", array[i], i));
    read_joint(element, scene);
    if (const auto name = TableReader(element).find("name")) {
      (void)read_name(*name);
      names.add(*name, "joint", array[i].line);
    }
  }
}

PeriodicBox read_periodic(const Item& item) {
  const TableReader table(item);
  table.refuse_unknown(scene_keys_of("periodic"));
  PeriodicBox box;
  const Item high = table.need("max", "an array of 3 numbers (m)");
  box.lowest = table.need("min", "an array of 3 numbers (m)").vector(limits::position);
  box.highest = high.vector(limits::position);
  box.along = {true, true, true};
  if (const auto axes = table.find("axes")) {
    constexpr std::string_view names[] = {"x", "y", "z"};
    box.along = {};
    const Array& listed = axes->array();
    for (std::size_t i = 0; i < listed.size(); ++i) {
      const Item axis(listed[i], fmt::format("{}[{}]", axes->path(), i));
      bool& along = box.along[axis.choice(names)];
      if (along) {
        axis.fail("is there twice; allowed: each name once");
      }
      along = true;
    }
    if (listed.empty()) {
      axes->fail("is empty; allowed: one or more of x, y, z");
    }
  }
  for (int k = 0; k < 3; ++k) {
    if (box.along[static_cast<std::size_t>(k)] && !(box.highest[k] > box.lowest[k])) {
      high.fail(
          "is not above min along every axis that repeats; allowed: numbers above those of "
          "min (m)");
    }
  }
  return box;
}

Scene read(const TableReader& table, const std::string& path) {
  table.refuse_unknown(scene_keys_of(""));
  const std::filesystem::path file(path);
  Scene scene;
  scene.path = path;
  const auto name = table.find("name");
  scene.name = name ? name->text() : file.stem().string();
  if (const auto summary = table.find("summary")) {
    scene.summary = summary->text();
  }
  if (const auto duration = table.find("duration")) {
    scene.duration = duration->duration();
  }
  BodyDefaults defaults;
  defaults.directory = file.parent_path().string();
  if (const auto frame = table.find("frame")) {
    scene.frames = read_frames(*frame, defaults.directory);
  }
  if (const auto gravity = table.find("gravity")) {
    if (std::holds_alternative<double>(gravity->value().data) ||
        std::holds_alternative<std::int64_t>(gravity->value().data)) {
      gravity->fail(
          fmt::format("is {}; it says how gravity acts, allowed: {}; how strong it is, "
                      "says G = 9.81, which points down, against y",
                      gravity->value().type_name(), listed(gravity_names)));
    }
    scene.gravity = static_cast<GravityMode>(gravity->choice(gravity_names));
  }
  if (const auto G = table.find("G")) {
    defaults.G = G->number(limits::G);
  }
  if (const auto bounds = table.find("bounds")) {
    defaults.bounds = static_cast<Bounds>(bounds->choice(bounds_names));
  }
  if (const auto friction = table.find("friction")) {
    defaults.friction = read_friction(*friction);
  }
  const auto combination = [&table](std::string_view key, Combine fallback) {
    const auto item = table.find(key);
    return item ? static_cast<Combine>(item->choice(combine_names)) : fallback;
  };
  scene.friction_combine = combination("friction_combine", scene.friction_combine);
  scene.restitution_combine = combination("restitution_combine", scene.restitution_combine);
  if (const auto periodic = table.find("periodic")) {
    scene.periodic = read_periodic(*periodic);
  }
  const auto many = table.find("many");
  if (!many || table.has("body")) {
    read_bodies(table.need("body", "at least one [[body]]"), defaults, scene);
  }
  if (many) {
    read_manies(*many, defaults, scene);
  }
  if (const auto force = table.find("force")) {
    read_forces(*force, defaults.G, scene);
  }
  if (const auto joint = table.find("joint")) {
    read_joints(*joint, scene);
  }
  if (const auto exact = table.find("exact")) {
    scene.exact = read_exact(*exact);
  }
  return scene;
}

}  // namespace

Scene parse_scene(std::string_view text, const std::string& path,
                  const std::vector<Override>& overrides) {
  return read_scene_document(is_def_file(path) ? parse_def(text, path) : parse_document(text, path),
                             path, overrides);
}

Scene read_scene_document(Value root, const std::string& path,
                          const std::vector<Override>& overrides) {
  apply_overrides(root, overrides);
  // The root is the whole file: what is missing there has no line.
  root.line = 0;
  return read(TableReader(Item(root, "")), path);
}

Scene read_scene(const std::string& path, const std::vector<Override>& overrides) {
  return parse_scene(read_text_file(path), path, overrides);
}

}  // namespace core
}  // namespace kairos
