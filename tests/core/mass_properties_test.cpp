// Mass, centre and inertia of the solid inside a triangle mesh.

#include "core/mass_properties.hpp"

#include "core/error.hpp"
#include "core/mesh_shapes.hpp"
#include "core/shape.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <numbers>
#include <vector>

using namespace kairos;

namespace {

MassProperties solid_of(const MeshData& mesh) {
  return mass_properties(mesh.vertices, mesh.triangles);
}

/// Reasons are compared by what they must say.
void check_refused(const MeshData& mesh, const std::string& part) {
  try {
    (void)solid_of(mesh);
  } catch (const InputError& error) {
    INFO(error.what());
    CHECK(error.reason().find(part) != std::string::npos);
    return;
  }
  FAIL("was not refused: " << part);
}

}  // namespace

TEST_CASE("mass properties: a box as a mesh has the inertia of a box", "[mesh]") {
  const Vector3 half(0.3, 0.5, 0.2);
  const MassProperties solid = solid_of(box_mesh(half));
  const double mass = 8.0 * half.prod();
  const Vector3 moments = solid_inertia(Box{half}, mass);
  // Roundoff of a dozen tetrahedra.
  CHECK(solid.volume == Approx(mass).epsilon(1e-14));
  CHECK(solid.centre.norm() <= 1e-15);
  CHECK((solid.inertia - Matrix3(moments.asDiagonal())).norm() <= 1e-14 * moments.norm());
  CHECK(solid.moments.x() == Approx(moments.minCoeff()).epsilon(1e-13));
  CHECK(solid.moments.z() == Approx(moments.maxCoeff()).epsilon(1e-13));
}

TEST_CASE("mass properties: what is moved and turned is moved and turned", "[mesh]") {
  MeshData mesh = box_mesh({0.3, 0.5, 0.2});
  mesh.vertices[7] = {0.6, 0.9, 0.1};  // no symmetry is left
  const MassProperties before = solid_of(mesh);
  const Quaternion turn = Quaternion(0.4, -0.2, 0.7, 0.1).normalized();
  const Matrix3 R = turn.toRotationMatrix();
  const Vector3 shift(1e3, -2e3, 5e2);
  for (Vector3& vertex : mesh.vertices) {
    vertex = turn * vertex + shift;
  }
  const MassProperties after = solid_of(mesh);
  // Coordinates of 2e3 beside sizes near 1: their roundoff, 5e-13, and no more.
  CHECK(after.volume == Approx(before.volume).epsilon(1e-11));
  CHECK((after.centre - (turn * before.centre + shift)).norm() <= 1e-11);
  CHECK((after.inertia - R * before.inertia * R.transpose()).norm() <= 1e-11);
  CHECK((after.moments - before.moments).norm() <= 1e-11);
  // The principal axes diagonalise, and are a rotation.
  const Matrix3 P = before.axes.toRotationMatrix();
  CHECK((P.transpose() * before.inertia * P - Matrix3(before.moments.asDiagonal())).norm() <=
        1e-15);
  CHECK(P.determinant() == Approx(1.0).epsilon(1e-14));
}

TEST_CASE("mass properties: a tetrahedron by its formula, a solid with a hole by difference",
          "[mesh]") {
  // The corner of a cube, edge a: volume a^3/6, centre a/4, Ixx about the centre a^5/80 (Tonon
  // 2004).
  const MeshData corner{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}},
                        {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const MassProperties solid = solid_of(corner);
  CHECK(solid.volume == Approx(8.0 / 6.0).epsilon(1e-15));
  CHECK((solid.centre - Vector3(0.5, 0.5, 0.5)).norm() <= 1e-15);
  CHECK(solid.inertia(0, 0) == Approx(32.0 / 80.0).epsilon(1e-14));
  CHECK(solid.inertia(0, 1) == Approx(32.0 / 480.0).epsilon(1e-14));

  MeshData hollow = box_mesh({1.0, 1.0, 1.0});
  const MeshData hole = box_mesh({0.5, 0.4, 0.3});
  for (const Vector3& vertex : hole.vertices) {
    hollow.vertices.push_back(vertex);
  }
  for (const Triangle& t : hole.triangles) {
    hollow.triangles.push_back({t[0] + 8, t[2] + 8, t[1] + 8});  // its outside is the hole
  }
  const MassProperties rest = solid_of(hollow), outer = solid_of(box_mesh({1, 1, 1})),
                       inner = solid_of(hole);
  CHECK(rest.volume == Approx(outer.volume - inner.volume).epsilon(1e-14));
  CHECK((rest.inertia - (outer.inertia - inner.inertia)).norm() <= 1e-14);
}

TEST_CASE("mass properties: finer and finer meshes of a sphere become one, as h^2", "[mesh]") {
  const double radius = icosphere_mesh(0).vertices.front().norm();
  const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3);
  double volume_error = 0.0, inertia_error = 0.0;
  for (int level = 0; level < 6; ++level) {
    const MassProperties solid = solid_of(icosphere_mesh(level));
    const double e = std::abs(solid.volume - volume);
    const double i = (solid.moments - Vector3::Constant(0.4 * volume * radius * radius)).norm();
    if (level > 3) {
      CHECK(std::log2(volume_error / e) == Approx(2.0).margin(0.1));
      CHECK(std::log2(inertia_error / i) == Approx(2.0).margin(0.1));
    }
    volume_error = e;
    inertia_error = i;
  }
}

TEST_CASE("mass properties: what has no inside is refused with the reason", "[mesh]") {
  const MeshData box = box_mesh({1, 1, 1});
  MeshData bad = box;
  bad.triangles.pop_back();
  check_refused(bad, "not closed");
  bad = box;
  bad.triangles[0] = {0, 1, 2};
  check_refused(bad, "twice");
  bad = box;
  for (Triangle& t : bad.triangles) {
    std::swap(t[0], t[1]);
  }
  check_refused(bad, "inside out");
  bad = box;
  bad.triangles[3][1] = 8;
  check_refused(bad, "corner 8");
  bad = box;
  bad.vertices[2].y() = std::nan("");
  check_refused(bad, "vertex 2");
  bad = box;
  for (Vector3& vertex : bad.vertices) {
    vertex.z() = 0.25;
  }
  check_refused(bad, "no volume");
  bad = box;
  bad.vertices[4].y() = 3.0;
  check_refused(bad, "crosses itself");
  check_refused({}, "empty");
}
