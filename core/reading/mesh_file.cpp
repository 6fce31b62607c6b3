#include "core/reading/mesh_file.hpp"

#include "core/error.hpp"
#include "core/reading/document.hpp"
#include "core/reading/obj_file.hpp"
#include "core/reading/off_file.hpp"
#include "core/reading/scene_limits.hpp"
#include "core/reading/stl_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>

namespace kairos {
inline namespace core {
namespace {

/// The text of 1e7 triangles is about that long. Where addresses end before, they are the limit.
constexpr auto longest_mesh = static_cast<std::size_t>(
    std::min<std::uint64_t>(std::uint64_t{1} << 32, std::numeric_limits<std::size_t>::max()));

void parse_off_into(std::string_view text, const std::string& path, MeshBuilder& builder) {
  struct Build : OffSink {
    explicit Build(MeshBuilder& to) : target(to) {}
    MeshBuilder& target;
    std::vector<std::uint32_t> corners;

    void vertex(const Vector3& p, int line) override { target.vertex(p, line); }
    void face(std::span<const std::size_t> face, int line) override {
      corners.assign(face.begin(), face.end());
      target.face(corners, line);
    }
  } build(builder);
  parse_off(text, path, build);
}

std::string ending(const std::string& path) {
  std::string text = std::filesystem::path(path).extension().string();
  for (char& c : text) {
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return text;
}

}  // namespace

MeshFile parse_mesh(std::string_view bytes, const std::string& path, double scale) {
  if (!limits::scale.contains(scale)) {
    throw InputError(path, 0, "scale",
                     fmt::format("{} is not allowed; allowed: {}", scale, limits::scale.text()));
  }
  MeshBuilder builder(path, scale);
  const std::string kind = ending(path);
  if (kind == ".off") {
    parse_off_into(bytes, path, builder);
  } else if (kind == ".obj") {
    parse_obj(bytes, path, builder);
  } else if (kind == ".stl") {
    parse_stl(bytes, path, builder);
  } else {
    throw InputError(path, 0, "",
                     fmt::format("\"{}\" is no format of meshes; allowed: .off, .obj, .stl", kind));
  }
  return builder.finish();
}

MeshFile read_mesh(const std::string& path, double scale) {
  return parse_mesh(read_text_file(path, longest_mesh), path, scale);
}

}  // namespace core
}  // namespace kairos
