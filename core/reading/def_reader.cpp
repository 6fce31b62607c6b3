#include "core/reading/def_reader.hpp"

#include "core/error.hpp"
#include "core/nearest_name.hpp"
#include "core/reading/csv.hpp"
#include "core/reading/off_file.hpp"
#include "core/reading/scene_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <system_error>

namespace kairos {
inline namespace core {
namespace {

constexpr std::string_view object_keys[] = {
    "Name", "Pos", "Normal", "Type", "COLLType", "Label", "Scale", "Orient", "Mass", "Vel", "G"};
constexpr std::string_view world_keys[] = {"Duration", "Frame", "Summary"};
constexpr std::string_view types[] = {"O_wall", "O_ball", "O_conveyor", "O_agpad"};
constexpr std::string_view entities[] = {"wall", "ball", "conveyor", "anti-gravity-pad"};
constexpr int most_objects = 100000;
/// A ball whose box is a cube is seen as a sphere. Sides may differ by this part, which is what the
/// digits of a model file lose.
constexpr double round_to = 1e-3;

/// A value as it was written, and where.
struct Entry {
  std::string text;
  int line = 0;
};
using Entries = std::map<std::string, Entry, std::less<>>;

class DefReader {
 public:
  explicit DefReader(const std::string& path)
      : path_(path), file_(std::make_shared<const std::string>(path)) {}

  Value read(std::string_view text) {
    int line = 0;
    while (!text.empty()) {
      const std::size_t end = text.find('\n');
      ++line;
      read_line(trimmed(text.substr(0, end)), line);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    return document();
  }

 private:
  [[noreturn]] void fail(int line, const std::string& key, const std::string& reason) const {
    throw InputError(path_, line, key, reason);
  }

  void read_line(std::string_view line, int number) {
    if (line.starts_with("\xEF\xBB\xBF")) {
      line.remove_prefix(3);  // byte order mark
    }
    if (line.empty() || line.front() == '#') {
      return;
    }
    const std::size_t colon = line.find(':');
    const std::size_t dash = line.substr(0, colon).find('-');
    if (colon == std::string_view::npos || dash == std::string_view::npos) {
      fail(number, "",
           fmt::format("\"{}\" says nothing; allowed: Object1-Pos:0 1 0, and the like",
                       line.substr(0, 40)));
    }
    const std::string_view owner = trimmed(line.substr(0, dash));
    const std::string_view key = trimmed(line.substr(dash + 1, colon - dash - 1));
    const std::string name(trimmed(line.substr(0, colon)));
    const std::string_view value = trimmed(line.substr(colon + 1));
    const bool world = owner == "World";
    const std::span<const std::string_view> known =
        world ? std::span<const std::string_view>(world_keys) : object_keys;
    Entries& entries = world ? world_ : objects_[object_number(owner, number)];
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      fail(number, name, fmt::format("is an unknown key; {}", suggestion(key, known)));
    }
    if (value.empty()) {
      fail(number, name, "has no value (is the file truncated?)");
    }
    const auto [entry, is_new] = entries.emplace(key, Entry{std::string(value), number});
    if (!is_new) {
      fail(number, name, fmt::format("is there already, in line {}", entry->second.line));
    }
  }

  [[nodiscard]] int object_number(std::string_view owner, int line) const {
    constexpr std::string_view prefix = "Object";
    int number = 0;
    const std::string_view digits =
        owner.starts_with(prefix) ? owner.substr(prefix.size()) : std::string_view();
    const auto [stop, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (digits.empty() || error != std::errc() || stop != digits.data() + digits.size() ||
        number < 1 || number > most_objects) {
      fail(line, std::string(owner), "is no object; allowed: Object1, Object2, ..., and World");
    }
    return number;
  }

  Value document() {
    Table root;
    root.set("name", text(std::filesystem::path(path_).stem().string(), 0));
    root.set("gravity", text("force", 0));
    root.set("bounds", text("obb", 0));
    const std::pair<std::string_view, const char*> plain[] = {
        {"Summary", "summary"}, {"Duration", "duration"}, {"Frame", "frame"}};
    for (const auto& [key, toml] : plain) {
      if (const auto entry = world_.find(key); entry != world_.end()) {
        root.set(toml, number_or_text(entry->second));
      }
    }
    Array bodies;
    int expected = 1;
    for (const auto& [number, entries] : objects_) {
      if (number != expected++) {
        fail(first_line(entries), fmt::format("Object{}", number),
             fmt::format("there is no Object{}; allowed: numbers from 1 without a gap",
                         expected - 1));
      }
      bodies.push_back(body(number, entries));
    }
    if (bodies.empty()) {
      fail(0, "", "holds no object; needed: at least Object1-Name, -Pos and -Type");
    }
    root.set("body", Value{std::move(bodies), file_, 0});
    return {std::move(root), file_, 0};
  }

  /// Where an object is first spoken of.
  static int first_line(const Entries& entries) {
    int line = entries.begin()->second.line;
    for (const auto& [key, entry] : entries) {
      line = std::min(line, entry.line);
    }
    return line;
  }

  Value body(int number, const Entries& entries) {
    const std::string prefix = fmt::format("Object{}-", number);
    const auto need = [&](std::string_view key) -> const Entry& {
      const auto found = entries.find(key);
      if (found == entries.end()) {
        fail(first_line(entries), prefix + std::string(key), "is missing");
      }
      return found->second;
    };
    const Entry& type = need("Type");
    const auto kind = std::find(std::begin(types), std::end(types), type.text);
    if (kind == std::end(types)) {
      fail(type.line, prefix + "Type",
           fmt::format("\"{}\" is no type; {}", type.text, suggestion(type.text, types)));
    }
    const std::string_view entity = entities[kind - std::begin(types)];
    Table table;
    table.set("entity", text(entity, type.line));
    const Entry& name = need("Name");
    const auto given = entries.find("Label");
    table.set("name",
              text(label(entries, name), given != entries.end() ? given->second.line : name.line));
    set_shape(prefix, name, need("Pos"), entries, entity, table);
    set_others(prefix, entries, entity, table);
    return {std::move(table), file_, name.line};
  }

  /// What it is called: its label, or the model's name, numbered where others have it.
  std::string label(const Entries& entries, const Entry& name) {
    const auto given = entries.find("Label");
    const std::string base = given != entries.end()
                                 ? given->second.text
                                 : std::filesystem::path(name.text).filename().string();
    const int count = ++labels_[base];
    return count == 1 ? base : fmt::format("{}-{}", base, count);
  }

  /// The box fitted to the model along the model's axes; its centre is where the body is.
  void set_shape(const std::string& prefix, const Entry& name, const Entry& position,
                 const Entries& entries, std::string_view entity, Table& table) {
    const std::string path =
        (std::filesystem::path(path_).parent_path() / (name.text + ".off")).string();
    std::error_code none;  // a name may be too long, or lead in a circle
    if (!std::filesystem::is_regular_file(path, none)) {
      fail(name.line, prefix + "Name",
           fmt::format("there is no {}{}; needed: the model, without its ending", path,
                       none && none != std::errc::no_such_file_or_directory
                           ? " (" + none.message() + ")"
                           : std::string()));
    }
    const FittedBox box = fit_box(read_off(path));
    const Vector3 scale = scale_of(prefix, entries);
    const Vector3 h = scale.cwiseProduct(box.half_extents);
    if (!(h.minCoeff() > 0.0)) {
      fail(name.line, prefix + "Name",
           fmt::format("{} is flat; a box needs an extent along each axis", path));
    }
    const bool round = entity == "ball" && h.maxCoeff() - h.minCoeff() <= round_to * h.maxCoeff();
    if (round) {
      table.set("radius", number(h.maxCoeff(), name.line));
    } else {
      table.set("half_extents", vector({h.x(), h.y(), h.z()}, name.line));
    }
    const std::vector<double> p = numbers(prefix + "Pos", position, 3);
    Quaternion q = Quaternion::Identity();
    if (const auto orient = entries.find("Orient"); orient != entries.end()) {
      const std::vector<double> c = numbers(prefix + "Orient", orient->second, 4);
      table.set("orientation", vector(c, orient->second.line));
      q = Quaternion(c[0], c[1], c[2], c[3]);
    }
    const Vector3 centre = Vector3(p[0], p[1], p[2]) + q * Vector3(scale.cwiseProduct(box.centre));
    table.set("position", vector({centre.x(), centre.y(), centre.z()}, position.line));
    table.set("scale", number(scale.maxCoeff(), name.line));
  }

  /// One factor for all axes or one for each (the thesis' Scale3D); 1 where nothing is said.
  [[nodiscard]] Vector3 scale_of(const std::string& prefix, const Entries& entries) const {
    const auto entry = entries.find("Scale");
    if (entry == entries.end()) {
      return Vector3::Ones();
    }
    const bool three = entry->second.text.find_first_of(" \t,") != std::string::npos;
    const std::vector<double> factors = numbers(prefix + "Scale", entry->second, three ? 3 : 1);
    for (const double factor : factors) {
      if (!limits::scale.contains(factor)) {
        fail(entry->second.line, prefix + "Scale",
             fmt::format("is {}; allowed: {}", factor, limits::scale.text()));
      }
    }
    return {factors[0], factors[three ? 1 : 0], factors[three ? 2 : 0]};
  }

  void set_others(const std::string& prefix, const Entries& entries, std::string_view entity,
                  Table& table) {
    const auto each = [&](std::string_view key, auto&& set) {
      if (const auto found = entries.find(key); found != entries.end()) {
        set(prefix + std::string(key), found->second);
      }
    };
    each("Normal", [&](const std::string& key, const Entry& entry) {
      const std::vector<double> n = numbers(key, entry, 3);
      if (n[0] == 0.0 && n[1] == 0.0 && n[2] == 0.0) {
        fail(entry.line, key, "has length 0; allowed: any other direction");
      }
      if (entity == "wall" || entity == "conveyor") {  // others reflect nothing
        table.set("normal", vector(n, entry.line));
      }
    });
    each("COLLType", [&](const std::string& key, const Entry& entry) {
      if (entry.text != "SQUARE" && entry.text != "ROUND") {
        fail(entry.line, key, fmt::format("is \"{}\"; allowed: SQUARE, ROUND", entry.text));
      }
      table.set("collision_type", text(entry.text == "ROUND" ? "round" : "square", entry.line));
    });
    each("Vel", [&](const std::string& key, const Entry& entry) {
      table.set("velocity", vector(numbers(key, entry, 3), entry.line));
    });
    each("Mass", [&](const std::string& key, const Entry& entry) {
      table.set("mass", number(numbers(key, entry, 1)[0], entry.line));
    });
    each("G", [&](const std::string& key, const Entry& entry) {
      table.set("G", number(numbers(key, entry, 1)[0], entry.line));
    });
  }

  /// Numbers between white space or commas: the thesis writes both.
  [[nodiscard]] std::vector<double> numbers(const std::string& key, const Entry& entry,
                                            std::size_t count) const {
    std::vector<double> result;
    constexpr std::string_view between = " \t,";
    const std::string_view line = entry.text;
    for (std::size_t at = line.find_first_not_of(between); at != std::string_view::npos;) {
      const std::size_t end = std::min(line.find_first_of(between, at), line.size());
      const auto x = parse_number(line.substr(at, end - at));
      if (!x) {
        fail(entry.line, key,
             fmt::format("\"{}\" is no number; allowed: a finite number",
                         line.substr(at, end - at)));
      }
      result.push_back(*x);
      at = line.find_first_not_of(between, end);
    }
    if (result.size() != count) {
      fail(entry.line, key, fmt::format("has {} numbers; allowed: {}", result.size(), count));
    }
    return result;
  }

  [[nodiscard]] Value text(std::string_view value, int line) const {
    return {std::string(value), file_, line};
  }
  [[nodiscard]] Value number(double value, int line) const { return {value, file_, line}; }
  [[nodiscard]] Value vector(const std::vector<double>& values, int line) const {
    Array array;
    for (const double x : values) {
      array.push_back(number(x, line));
    }
    return {std::move(array), file_, line};
  }
  [[nodiscard]] Value number_or_text(const Entry& entry) const {
    const auto x = parse_number(entry.text);
    return x ? number(*x, entry.line) : text(entry.text, entry.line);
  }

  std::string path_;
  std::shared_ptr<const std::string> file_;
  Entries world_;
  std::map<int, Entries> objects_;
  std::map<std::string, int> labels_;
};

}  // namespace

bool is_def_file(std::string_view path) { return path.ends_with(".def"); }

Value parse_def(std::string_view text, const std::string& path) {
  return DefReader(path).read(text);
}

}  // namespace core
}  // namespace kairos
