#include "core/reading/obj_file.hpp"

#include "core/reading/csv.hpp"
#include "core/reading/scene_limits.hpp"
#include "core/reading/word_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace kairos {
inline namespace core {
namespace {

/// Statements that say nothing of the surface.
constexpr std::array<std::string_view, 20> skipped{
    "vt",     "vn",       "vp",       "g",      "o",   "s",          "mg",
    "usemtl", "mtllib",   "usemap",   "maplib", "lod", "shadow_obj", "trace_obj",
    "bevel",  "c_interp", "d_interp", "l",      "p",   "call"};

void read_vertex(const WordLines& lines, MeshBuilder& builder) {
  const std::size_t numbers = lines.words().size() - 1;
  if (numbers != 3 && numbers != 4 && numbers != 6) {
    lines.fail(fmt::format("has {} numbers; allowed: x y z, with a weight of 1 or a colour r g b",
                           numbers));
  }
  for (std::size_t i = 4; i <= numbers; ++i) {
    const double further = lines.number(i, limits::component);
    if (numbers == 4 && further != 1.0) {
      lines.fail(fmt::format("has the weight {}; allowed: 1", further));
    }
  }
  const double x = lines.number(1, limits::component);
  const double y = lines.number(2, limits::component);
  builder.vertex({x, y, lines.number(3, limits::component)}, lines.line());
}

/// The vertex of "7", "7/1", "7//2" or "-1/..": from 1 on, or backwards from the last one so far.
std::uint32_t corner(const WordLines& lines, std::string_view word, std::size_t vertices) {
  const std::optional<double> index = parse_number(word.substr(0, word.find('/')));
  const auto count = static_cast<double>(vertices);
  if (!index || *index != std::floor(*index) || *index == 0.0 || std::abs(*index) > count) {
    lines.fail(
        fmt::format("\"{}\" is no vertex; allowed: 1 to {}, or -1 to -{} from the last one "
                    "backwards",
                    word, vertices, vertices));
  }
  return static_cast<std::uint32_t>(*index > 0.0 ? *index - 1.0 : count + *index);
}

}  // namespace

void parse_obj(std::string_view text, const std::string& path, MeshBuilder& builder) {
  WordLines lines(text, path);
  std::vector<std::uint32_t> corners;
  while (lines.next()) {
    const std::string_view what = lines.words().front();
    if (what == "v") {
      read_vertex(lines, builder);
    } else if (what == "f") {
      if (lines.words().size() < 4) {
        lines.fail(
            fmt::format("a face with {} corners; allowed: 3 or more", lines.words().size() - 1));
      }
      corners.clear();
      for (std::size_t i = 1; i < lines.words().size(); ++i) {
        corners.push_back(corner(lines, lines.words()[i], builder.vertex_count()));
      }
      builder.face(corners, lines.line());
    } else if (std::find(skipped.begin(), skipped.end(), what) == skipped.end()) {
      lines.fail(
          fmt::format("\"{}\" is not known; allowed: v and f, and those skipped (vt, vn, "
                      "g, o, s, usemtl, mtllib, l, p and the like); curved surfaces are not",
                      what));
    } else if (lines.words().back() == "\\") {
      lines.fail("goes on in the next line; allowed: statements of one line");
    }
  }
}

}  // namespace core
}  // namespace kairos
