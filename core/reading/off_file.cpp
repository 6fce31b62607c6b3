#include "core/reading/off_file.hpp"

#include "core/reading/document.hpp"
#include "core/reading/scene_limits.hpp"
#include "core/reading/word_lines.hpp"

#include <fmt/format.h>

#include <utility>

namespace kairos {
inline namespace core {
namespace {

/// More vertices or faces than any model has: a typing error, and memory for nothing.
constexpr double most_parts = 1e7;

/// How many numbers a vertex has, by the first word of the file.
std::size_t vertex_width(const WordLines& lines) {
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

Vector3 read_vertex(const WordLines& lines, std::size_t width) {
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

void read_face(const WordLines& lines, std::size_t vertices, std::vector<std::size_t>& face) {
  const std::size_t corners = lines.whole(0, most_parts, "number of corners");
  if (corners < 3) {
    lines.fail(fmt::format("a face with {} corners; allowed: 3 or more", corners));
  }
  if (lines.words().size() < corners + 1) {
    lines.fail(fmt::format("names {} vertices; needed: {}", lines.words().size() - 1, corners));
  }
  face.clear();
  for (std::size_t i = 1; i <= corners; ++i) {
    face.push_back(
        lines.whole(i, static_cast<double>(vertices) - 1.0, "vertex (they count from 0)"));
  }
  for (std::size_t i = corners + 1; i < lines.words().size(); ++i) {
    (void)lines.number(i, limits::component);  // a colour
  }
}

}  // namespace

void parse_off(std::string_view text, const std::string& path, OffSink& sink) {
  WordLines lines(text, path);
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
  for (std::size_t i = 0; i < vertices; ++i) {
    lines.need(fmt::format("vertex {} of {}", i + 1, vertices));
    sink.vertex(read_vertex(lines, width), lines.line());
  }
  std::vector<std::size_t> face;
  for (std::size_t i = 0; i < faces; ++i) {
    lines.need(fmt::format("face {} of {}", i + 1, faces));
    read_face(lines, vertices, face);
    sink.face(face, lines.line());
  }
  if (lines.next()) {
    lines.fail(fmt::format("something follows the last of {} faces", faces));
  }
}

OffModel parse_off(std::string_view text, const std::string& path) {
  struct Keep : OffSink {
    OffModel model;
    void vertex(const Vector3& p, int /*line*/) override { model.vertices.push_back(p); }
    void face(std::span<const std::size_t> corners, int /*line*/) override {
      model.faces.emplace_back(corners.begin(), corners.end());
    }
  } keep;
  parse_off(text, path, keep);
  return std::move(keep.model);
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
