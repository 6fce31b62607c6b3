#include "core/reading/stl_file.hpp"

#include "core/reading/scene_limits.hpp"
#include "core/reading/word_lines.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstring>

namespace kairos {
inline namespace core {
namespace {

constexpr std::size_t header_size = 80;
constexpr std::size_t prefix_size = header_size + 4;
constexpr std::size_t record_size = 50;

/// Little-endian, wherever it is read.
std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 4; i-- > 0;) {
    word = word << 8U | static_cast<unsigned char>(bytes[at + i]);
  }
  return word;
}
Vector3 vector_at(std::string_view bytes, std::size_t at) {
  Vector3 v;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t word = word_at(bytes, at + 4 * i);
    float x = 0.0F;  // std::bit_cast is not in the oldest libc++ that is built with
    std::memcpy(&x, &word, sizeof x);
    v[static_cast<Eigen::Index>(i)] = x;
  }
  return v;
}

/// How many triangles a binary file says it has; 0 if it is too short to say so.
std::size_t told_triangles(std::string_view bytes) {
  return bytes.size() < prefix_size ? 0 : word_at(bytes, header_size);
}

void add_facet(const Vector3& normal, const std::array<Vector3, 3>& corners, int line,
               MeshBuilder& builder) {
  const auto first = static_cast<std::uint32_t>(builder.vertex_count());
  for (const Vector3& p : corners) {
    builder.vertex(p, line);
  }
  builder.face_normal(normal);
  builder.face(std::array{first, first + 1, first + 2}, line);
}

void parse_binary(std::string_view bytes, MeshBuilder& builder) {
  for (std::size_t at = prefix_size; at < bytes.size(); at += record_size) {
    add_facet(vector_at(bytes, at),
              {vector_at(bytes, at + 12), vector_at(bytes, at + 24), vector_at(bytes, at + 36)}, 0,
              builder);
  }
}

/// The keywords of a text, in upper or in lower case.
bool same_word(std::string_view word, std::string_view keyword) {
  if (word.size() != keyword.size()) {
    return false;
  }
  for (std::size_t i = 0; i < word.size(); ++i) {
    const char c = word[i];
    if ((c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c) != keyword[i]) {
      return false;
    }
  }
  return true;
}

class FacetLines {
 public:
  FacetLines(std::string_view text, const std::string& path) : lines_(text, path) {}

  void parse(MeshBuilder& builder) {
    bool inside = false;
    while (lines_.next()) {
      if (!inside) {
        expect("solid");
        inside = true;
      } else if (is("endsolid")) {
        inside = false;
      } else {
        read_facet(builder);
      }
    }
    if (inside) {
      lines_.need("endsolid");
    }
  }

 private:
  [[nodiscard]] bool is(std::string_view keyword, std::size_t i = 0) const {
    return i < lines_.words().size() && same_word(lines_.words()[i], keyword);
  }
  void expect(std::string_view keyword, std::string_view second = "", std::size_t numbers = 0) {
    const std::size_t words = (second.empty() ? 1U : 2U) + numbers;
    const bool any_length = same_word("solid", keyword);
    if (!is(keyword) || (!second.empty() && !is(second, 1)) ||
        (!any_length && lines_.words().size() != words)) {
      lines_.fail(fmt::format("\"{}\" is not expected here; needed: {}{}{}{}",
                              lines_.words().front(), keyword, second.empty() ? "" : " ", second,
                              numbers == 3 ? " x y z" : ""));
    }
  }
  [[nodiscard]] Vector3 vector(std::size_t first) const {
    const double x = lines_.number(first, limits::component);
    const double y = lines_.number(first + 1, limits::component);
    return {x, y, lines_.number(first + 2, limits::component)};
  }
  void read_facet(MeshBuilder& builder) {
    const int line = lines_.line();
    expect("facet", "normal", 3);
    const Vector3 normal = vector(2);
    lines_.need("outer loop");
    expect("outer", "loop");
    std::array<Vector3, 3> corners;
    for (Vector3& corner : corners) {
      lines_.need("vertex");
      expect("vertex", "", 3);
      corner = vector(1);
    }
    lines_.need("endloop");
    expect("endloop");
    lines_.need("endfacet");
    expect("endfacet");
    add_facet(normal, corners, line, builder);
  }

  WordLines lines_;
};

bool begins_as_text(std::string_view bytes) {
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && same_word(bytes.substr(first, 5), "solid");
}

}  // namespace

void parse_stl(std::string_view bytes, const std::string& path, MeshBuilder& builder) {
  const std::size_t told = told_triangles(bytes);
  if (bytes.size() >= prefix_size && bytes.size() == prefix_size + record_size * told) {
    parse_binary(bytes, builder);
  } else if (begins_as_text(bytes)) {
    FacetLines(bytes, path).parse(builder);
  } else {
    builder.fail(0, bytes.size() < prefix_size
                        ? fmt::format("is no STL: neither text that begins with \"solid\" nor the "
                                      "{} bytes that begin a binary file",
                                      prefix_size)
                        : fmt::format("is no STL: it says {} triangles, for which {} bytes are "
                                      "needed, and has {} (is it truncated?)",
                                      told, prefix_size + record_size * told, bytes.size()));
  }
}

}  // namespace core
}  // namespace kairos
