#include "core/reading/off_file.hpp"

#include "core/error.hpp"
#include "core/reading/csv.hpp"
#include "core/reading/document.hpp"
#include "core/reading/scene_limits.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

namespace kairos {
inline namespace core {
namespace {

/// More vertices or faces than any model has: a typing error, and memory for nothing.
constexpr double most_parts = 1e7;

/// The words of the lines that say something.
class OffLines {
 public:
  OffLines(std::string_view text, const std::string& path) : rest_(text), path_(path) {}

  /// Goes on to the next line with words; false at the end of the file.
  bool next() {
    while (!rest_.empty()) {
      const std::size_t end = rest_.find('\n');
      std::string_view line = rest_.substr(0, end);
      rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
      ++line_;
      split(line.substr(0, line.find('#')));
      if (!words_.empty()) {
        return true;
      }
    }
    return false;
  }
  /// The next line, which must be there; `what` says of what, for the message.
  void need(const std::string& what) {
    if (!next()) {
      ++line_;
      fail(fmt::format("the file ends before {} (is it truncated?)", what));
    }
  }
  [[nodiscard]] const std::vector<std::string_view>& words() const { return words_; }
  void drop_first() { words_.erase(words_.begin()); }

  [[nodiscard]] double number(std::size_t i, const Range& range) const {
    const auto x = i < words_.size() ? parse_number(words_[i]) : std::nullopt;
    if (!x || !range.contains(*x)) {
      fail(fmt::format("\"{}\" is not allowed here; allowed: {}",
                       i < words_.size() ? words_[i] : std::string_view("nothing"), range.text()));
    }
    return *x;
  }
  [[nodiscard]] std::size_t whole(std::size_t i, double highest, const std::string& what) const {
    const auto x = i < words_.size() ? parse_number(words_[i]) : std::nullopt;
    if (!x || *x < 0.0 || *x > highest || *x != std::floor(*x)) {
      fail(fmt::format("\"{}\" is no {}; allowed: a whole number from 0 to {}",
                       i < words_.size() ? words_[i] : std::string_view("nothing"), what, highest));
    }
    return static_cast<std::size_t>(*x);
  }
  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError(path_, line_, "", reason);
  }

 private:
  void split(std::string_view line) {
    words_.clear();
    constexpr std::string_view space = " \t\r";
    for (std::size_t at = line.find_first_not_of(space); at != std::string_view::npos;
         at = line.find_first_not_of(space, at)) {
      const std::size_t end = std::min(line.find_first_of(space, at), line.size());
      words_.push_back(line.substr(at, end - at));
      at = end;
    }
  }

  std::string_view rest_;
  const std::string& path_;
  int line_ = 0;
  std::vector<std::string_view> words_;
};

/// How many numbers a vertex has, by the first word of the file.
std::size_t vertex_width(const OffLines& lines) {
  const std::string_view kind = lines.words().front();
  if (kind == "OFF") {
    return 3;
  }
  if (kind == "NOFF") {
    return 6;
  }
  if (kind == "COFF") {
    return 7;
  }
  lines.fail(fmt::format("starts with \"{}\"; allowed: OFF, NOFF, COFF", kind));
}

Vector3 read_vertex(const OffLines& lines, std::size_t width) {
  if (lines.words().size() != width) {
    lines.fail(
        fmt::format("has {} numbers; allowed: {} for a vertex", lines.words().size(), width));
  }
  Vector3 vertex;
  for (std::size_t i = 0; i < width; ++i) {
    const double x = lines.number(i, limits::position);
    if (i < 3) {
      vertex[static_cast<int>(i)] = x;
    }
  }
  return vertex;
}

std::vector<std::size_t> read_face(const OffLines& lines, std::size_t vertices) {
  const std::size_t corners = lines.whole(0, most_parts, "number of corners");
  if (corners < 3) {
    lines.fail(fmt::format("a face with {} corners; allowed: 3 or more", corners));
  }
  if (lines.words().size() < corners + 1) {
    lines.fail(fmt::format("names {} vertices; needed: {}", lines.words().size() - 1, corners));
  }
  std::vector<std::size_t> face;
  for (std::size_t i = 1; i <= corners; ++i) {
    face.push_back(
        lines.whole(i, static_cast<double>(vertices) - 1.0, "vertex (they count from 0)"));
  }
  for (std::size_t i = corners + 1; i < lines.words().size(); ++i) {
    (void)lines.number(i, limits::component);  // a colour
  }
  return face;
}

}  // namespace

OffModel parse_off(std::string_view text, const std::string& path) {
  OffLines lines(text, path);
  lines.need("its first word, OFF");
  const std::size_t width = vertex_width(lines);
  lines.drop_first();
  if (lines.words().empty()) {
    lines.need("the numbers of vertices, faces and edges");
  }
  const std::size_t vertices = lines.whole(0, most_parts, "number of vertices");
  const std::size_t faces = lines.whole(1, most_parts, "number of faces");
  if (lines.words().size() > 3) {
    lines.fail("has more than three numbers; allowed: vertices, faces, edges");
  }
  if (vertices == 0) {
    lines.fail("there are no vertices; needed: at least one");
  }
  OffModel model;
  for (std::size_t i = 0; i < vertices; ++i) {
    lines.need(fmt::format("vertex {} of {}", i + 1, vertices));
    model.vertices.push_back(read_vertex(lines, width));
  }
  for (std::size_t i = 0; i < faces; ++i) {
    lines.need(fmt::format("face {} of {}", i + 1, faces));
    model.faces.push_back(read_face(lines, vertices));
  }
  if (lines.next()) {
    lines.fail(fmt::format("something follows the last of {} faces", faces));
  }
  return model;
}

OffModel read_off(const std::string& path) { return parse_off(read_text_file(path), path); }

FittedBox fit_box(const OffModel& model) {
  Vector3 least = model.vertices.front();
  Vector3 greatest = least;
  for (const Vector3& vertex : model.vertices) {
    least = least.cwiseMin(vertex);
    greatest = greatest.cwiseMax(vertex);
  }
  return {0.5 * (least + greatest), 0.5 * (greatest - least)};
}

}  // namespace core
}  // namespace kairos
