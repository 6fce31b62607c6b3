// Shape: sizes and inertia from formulas.
#include "core/shape.hpp"

#include "core/error.hpp"
#include "core/time_of_impact.hpp"
#include "tests/catch.hpp"

#include <cmath>

using namespace kairos;

TEST_CASE("names and sizes of shapes", "[core][shape]") {
  const Shape sphere = Sphere{0.5};
  const Shape box = Box{{1, 2, 3}};
  const Shape half_space = HalfSpace{};
  CHECK(shape_name(sphere) == "sphere");
  CHECK(shape_name(box) == "box");
  CHECK(shape_name(half_space) == "half-space");
  CHECK(bounding_radius(sphere) == 0.5);
  CHECK(bounding_radius(box) == std::sqrt(14.0));
  CHECK(std::isinf(bounding_radius(half_space)));
  CHECK(smallest_extent(sphere) == 1.0);
  CHECK(smallest_extent(box) == 2.0);
  CHECK(std::isinf(smallest_extent(half_space)));
}

TEST_CASE("the thesis' box of a ball, and none of a half-space", "[core][shape]") {
  CHECK(bounding_box(Sphere{0.5}).half_extents == Vector3::Constant(0.5));
  CHECK(bounding_box(Box{{1, 2, 3}}).half_extents == Vector3(1, 2, 3));
  CHECK_THROWS_AS(bounding_box(HalfSpace{}), InputError);
}

TEST_CASE("inertia of homogeneous solids", "[core][shape]") {
  CHECK((solid_inertia(Sphere{0.5}, 2.0) - Vector3::Constant(0.2)).norm() < 1e-16);
  // m/12 (full extents squared): 3/12 (16 + 36) and so on.
  CHECK((solid_inertia(Box{{1, 2, 3}}, 3.0) - Vector3(13, 10, 5)).norm() < 1e-14);
  CHECK(solid_inertia(HalfSpace{}, -1.0) == Vector3::Zero());
}

TEST_CASE("the normal of a half-space is its +y, or what was given, to the last bit",
          "[core][shape]") {
  CHECK(half_space_normal(HalfSpace{}, {}) == Vector3::UnitY());
  const Pose tilted{Vector3::Zero(), rotate({0, 0, 0.5}, Quaternion::Identity())};
  CHECK(
      (half_space_normal(HalfSpace{}, tilted) - Vector3(-std::sin(0.5), std::cos(0.5), 0)).norm() <
      1e-15);
  for (const Vector3& n : {Vector3(1, 0, 0), Vector3(0, 0, -1), Vector3(0.6, 0.8, 0)}) {
    CHECK(half_space_normal(HalfSpace{n}, {{1, 2, 3}, Quaternion::Identity()}) == n);
  }
}

TEST_CASE("statuses have names", "[core][time-of-impact]") {
  CHECK(to_string(ToiStatus::separated) == "separated");
  CHECK(to_string(ToiStatus::impact) == "impact");
  CHECK(to_string(ToiStatus::overlapping) == "overlapping");
  CHECK(to_string(ToiStatus::undecided) == "undecided");
}
