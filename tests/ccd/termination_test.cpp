// Queries end, and an answer that settles nothing still gets somewhere.
#include "tests/ccd/cases.hpp"

using namespace kairos;
using namespace kairos::reference;

namespace {

/// Two edges that cross at 30 degrees `gap` apart and part at 1 m/s, the upper body by a polynomial
/// whose quaternion nearly vanishes within the window: how fast it turns there, no bound tells.
Query parting_edges(double gap) {
  const double edge = 0.1 * std::sqrt(2.0);  // of a box of 0.1 m that stands on its edge
  Query q{
      box(0.1, 0.1, 0.5), box(0.5, 0.1, 0.1), still(pose(zero, turned({0, 0, 1}, pi / 4))),
      moving(pose({0, 2.0 * edge + gap, 0}, turned({0, 1, 0}, pi / 3) * turned({1, 0, 0}, pi / 4)),
             {0, 1, 0}),
      1.0};
  const Vector4 start = q.motion_b.quaternion[0];
  const Quaternion about_y =
      Quaternion(0.0, 0.0, 0.01, 0.0) * Quaternion(start[0], start[1], start[2], start[3]);
  q.motion_b.rotation = RotationKind::polynomial;
  q.motion_b.quaternion.resize(2);
  q.motion_b.quaternion[1] = Vector4(about_y.w(), about_y.x(), about_y.y(), about_y.z());
  q.motion_b.quaternion[2] = -2.0 * start;
  return q;
}

}  // namespace

TEST_CASE("termination: an undecided start gets as far as the gap that its rounding hides",
          "[ccd][termination]") {
  int undecided = 0;
  for (int k = 0; k < 400; ++k) {  // the whole range that rounding hides, some 1e-13 m
    const double gap = k * 1e-15;
    const TimeOfImpact toi = parting_edges(gap).ask(*certified);
    CAPTURE(gap, std::string(to_string(toi.status)), toi.t_lo, toi.t_hi);
    CHECK(toi.evaluations <= 1000);  // some 60 doublings, thrice
    if (toi.status == ToiStatus::undecided) {
      ++undecided;
      // Roundoff of coordinates of 0.3 m, 1e-17 m and more, at 1 m/s.
      CHECK(toi.t_hi - toi.t_lo >= 1e-17);
    }
  }
  CAPTURE(undecided);
  CHECK(undecided > 0);
}

TEST_CASE("termination: a linear quaternion that nearly vanishes turns without a bound",
          "[ccd][termination]") {
  // A rod that turns once about y, almost all of it within 0.01 s, past a cube at its side.
  Query q{box(0.1, 0.1, 0.1), box(1.0, 0.05, 0.05), still(pose({0.0, 0.0, 0.5})),
          moving(pose(zero), zero), 1.0};
  q.motion_b.rotation = RotationKind::polynomial;
  q.motion_b.quaternion.resize(1);
  q.motion_b.quaternion[1] = Vector4(-2.0, 0.0, 0.01, 0.0);
  CHECK(kept(q, 20000).status == ToiStatus::impact);
}

TEST_CASE("touch: a pair that hardly approaches and is drawn together is not looked through",
          "[ccd][termination]") {
  const Vector3 pull(0.0, -10.0, 0.0);
  const Shape ball = Sphere{0.05};
  const std::pair<Shape, double> others[] = {{Sphere{0.05}, 0.1}, {box(0.05, 0.05, 0.05), 0.1}};
  for (const auto& [under, height] : others) {
    for (const double approach : {0.0, 1e-300, 1e-18, 1e-16, 1e-14, 1e-12, 1e-9, 1e-6}) {
      for (const double duration : {0.01, 0.3, 1.0, 10.0}) {  // it is through in 0.2 s
        const Query q{under, ball, moving(pose(zero), zero, zero, zero, duration),
                      moving(pose({0, height, 0}), {0, -approach, 0}, zero, pull, duration),
                      duration};
        const TimeOfImpact toi = q.ask(*certified);
        CAPTURE(under.index(), approach, duration, std::string(to_string(toi.status)), toi.t_hi);
        CHECK(toi.status == ToiStatus::impact);
        CHECK(toi.t_lo == 0.0);
        // An overlap of some 1e-14 m, which rounding does not hide, takes sqrt(2e-15) s.
        CHECK(toi.t_hi < 1e-6);
      }
    }
  }
}
