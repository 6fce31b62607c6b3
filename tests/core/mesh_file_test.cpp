// Meshes from OBJ, STL and OFF: the same mesh from each, and what is refused, by line and face.

#include "core/reading/mesh_file.hpp"

#include "core/error.hpp"
#include "core/mass_properties.hpp"
#include "tests/catch.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <string>
#include <vector>

using namespace kairos;

namespace {

/// A tetrahedron at the corner of a cube with edge 2.
const std::string off =
    "OFF\n4 4 0\n0 0 0\n2 0 0\n0 2 0\n0 0 2\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
const std::string obj =
    "# a comment\nmtllib no.mtl\nv 0 0 0\nv 2 0 0 1\nv 0 2 0 0.5 0.5 0.5\nvn 0 0 1\nv 0 0 2\n"
    "g sides\nf 1 3 2\nf 1//1 2//1 4//1\nusemtl x\nf -4 -1 -2\nf 2/1/1 3/1/1 4/1/1\n";

std::string facet(const Vector3& a, const Vector3& b, const Vector3& c) {
  const auto vertex = [](const Vector3& p) {
    return fmt::format("vertex {} {} {}\n", p.x(), p.y(), p.z());
  };
  return fmt::format("facet normal 0 0 0\nouter loop\n{}{}{}endloop\nendfacet\n", vertex(a),
                     vertex(b), vertex(c));
}
std::string stl_text(const MeshData& mesh) {
  std::string text = "solid tetrahedron\n";
  for (const Triangle& t : mesh.triangles) {
    text += facet(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  }
  return text + "endsolid\n";
}
void append_word(std::string& bytes, std::uint32_t word) {
  for (int i = 0; i < 4; ++i) {
    bytes += static_cast<char>(word >> (8 * i) & 255U);
  }
}
/// Begins with "solid", as some programs write it although it is binary.
std::string stl_bytes(const MeshData& mesh) {
  std::string bytes = "solid but binary";
  bytes.resize(80, ' ');
  append_word(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) {
    bytes.append(12, '\0');
    for (const std::uint32_t corner : t) {
      for (int i = 0; i < 3; ++i) {
        append_word(bytes,
                    std::bit_cast<std::uint32_t>(static_cast<float>(mesh.vertices[corner][i])));
      }
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

double volume(const MeshFile& file) {
  return mass_properties(file.mesh.vertices, file.mesh.triangles).volume;
}

struct Refused {
  std::string text;
  int line;
  std::string reason;
};
void check_refused(const std::string& name, const std::vector<Refused>& cases) {
  for (const Refused& bad : cases) {
    INFO(name << ": " << bad.text);
    try {
      (void)parse_mesh(bad.text, name);
      FAIL_CHECK("was read");
    } catch (const InputError& error) {
      INFO(error.what());
      CHECK(error.line() == bad.line);
      CHECK(error.reason().find(bad.reason) != std::string::npos);
    }
  }
}

}  // namespace

TEST_CASE("mesh files: OFF, OBJ and both kinds of STL give the same mesh", "[mesh]") {
  const MeshFile from_off = parse_mesh(off, "t.off");
  CHECK(volume(from_off) == Approx(8.0 / 6.0).epsilon(1e-15));
  const std::vector<MeshFile> others{parse_mesh(obj, "t.obj"),
                                     parse_mesh(stl_text(from_off.mesh), "t.stl"),
                                     parse_mesh(stl_bytes(from_off.mesh), "t.STL")};
  for (const MeshFile& other : others) {
    CHECK(other.mesh.vertices.size() == 4);
    REQUIRE(other.mesh.triangles.size() == 4);
    for (std::size_t k = 0; k < 4; ++k) {
      CHECK(other.faces[k] == k + 1);
      for (std::size_t i = 0; i < 3; ++i) {
        CHECK(other.mesh.vertices[other.mesh.triangles[k][i]] ==
              from_off.mesh.vertices[from_off.mesh.triangles[k][i]]);
      }
    }
  }
  CHECK(others[1].merged_vertices == 8);
  CHECK(from_off.where(2) == "t.off:9: face 3");
  CHECK(others[2].where(2) == "t.STL: face 3");
  CHECK(volume(parse_mesh(obj, "t.obj", 0.001)) == Approx(8.0 / 6.0 * 1e-9).epsilon(1e-14));
}

TEST_CASE("mesh files: polygons are divided inside, also where they are not convex", "[mesh]") {
  // An L as a prism of height 1: area 3, two caps of six corners, six rectangles.
  std::string text;
  const std::vector<std::pair<int, int>> L{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (int z = 0; z < 2; ++z) {
    for (const auto& [x, y] : L) {
      text += fmt::format("v {} {} {}\n", x, y, z);
    }
  }
  text += "f 4 3 2 1 6 5\nf 7 8 9 10 11 12\n";
  for (int i = 0; i < 6; ++i) {
    const int j = (i + 1) % 6;
    text += fmt::format("f {} {} {} {}\n", i + 1, j + 1, j + 7, i + 7);
  }
  const MeshFile prism = parse_mesh(text, "prism.obj");
  CHECK(prism.mesh.triangles.size() == 4 + 4 + 12);
  CHECK(prism.divided_polygons == 8);
  CHECK(volume(prism) == Approx(3.0).epsilon(1e-15));
  double area = 0.0;
  for (std::size_t k = 0; k < 8; ++k) {  // none of the triangles of the caps lies outside
    const Triangle& t = prism.mesh.triangles[k];
    const std::vector<Vector3>& v = prism.mesh.vertices;
    area += 0.5 * (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]).norm();
  }
  CHECK(area == Approx(6.0).epsilon(1e-15));
}

TEST_CASE("mesh files: repeated and unused vertices, contrary normals are counted", "[mesh]") {
  const MeshFile file = parse_mesh(
      "v 0 0 0\nv 5 5 5\nv 1 0 0\nv 0 1 0\nv 1 0 -0\nv 1 1 0\nf 1 3 4\nf 5 6 4\n", "a.obj");
  CHECK(file.mesh.vertices.size() == 4);
  CHECK(file.merged_vertices == 1);
  CHECK(file.unused_vertices == 1);
  CHECK(file.mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}});
  const MeshFile stl = parse_mesh(
      "SOLID\nfacet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
      "endfacet\nendsolid\n",
      "b.stl");
  CHECK(stl.contrary_normals == 1);
}

TEST_CASE("mesh files: what is no mesh is refused by line or face", "[mesh]") {
  check_refused("m.obj", {{"", 0, "no faces"},
                          {"v 0 0 0\n", 0, "no faces"},
                          {"v 0 0\n", 1, "2 numbers"},
                          {"v 0 0 nan\n", 1, "\"nan\""},
                          {"v 0 0 1e300\n", 1, "\"1e300\""},
                          {"v 0 0 0 2\n", 1, "weight"},
                          {"v 0 0 0\nf 1 1\n", 2, "2 corners"},
                          {"v 0 0 0\nf 1 2 1\n", 2, "\"2\" is no vertex"},
                          {"v 0 0 0\nf 1 0 1\n", 2, "\"0\" is no vertex"},
                          {"v 0 0 0\nf 1 -2 1\n", 2, "\"-2\" is no vertex"},
                          {"v 0 0 0\nf 1 1.5 1\n", 2, "\"1.5\""},
                          {"v 0 0 0\nf 1 x 1\n", 2, "\"x\""},
                          {"curv 0 1 1 2\n", 1, "curved surfaces"},
                          {"v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n", 5, "no area"},
                          {"v 0 0 0\nv 3 3 0\nv 3 0 0\nv 0 1 0\nf 1 2 3 4\n", 5, "crosses"}});
  check_refused("m.stl",
                {{"", 0, "is no STL"},
                 {"hello", 0, "is no STL"},
                 {"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", 5, "truncated"},
                 {"solid x\nendsolid x\n", 0, "no faces"},
                 {"solid x\n", 2, "endsolid"},
                 {"solid x\nfacet normal 0 0\n", 2, "facet normal x y z"},
                 {"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 inf\n", 4, "\"inf\""}});
  check_refused("m.ply", {{"ply\n", 0, ".off, .obj, .stl"}});
  check_refused("m.off", {{"OFF\n1 1 0\n0 0 0\n3 0 0 1\n", 4, "no vertex"}});
  CHECK_THROWS_AS(parse_mesh(off, "t.off", 0.0), InputError);
  CHECK_THROWS_AS(parse_mesh(off, "t.off", std::nan("")), InputError);

  // Every part of a binary file is too short; a number that is none is named by its face.
  const std::string bytes = stl_bytes(parse_mesh(off, "t.off").mesh);
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    CHECK_THROWS_AS(parse_mesh(bytes.substr(0, n), "t.stl"), InputError);
  }
  std::string not_finite = bytes;
  not_finite.replace(84 + 50 + 12, 4, std::string("\0\0\x80\x7f", 4));
  try {
    (void)parse_mesh(not_finite, "t.stl");
    FAIL_CHECK("was read");
  } catch (const InputError& error) {
    CHECK(error.reason().find("face 2") != std::string::npos);
  }
}
