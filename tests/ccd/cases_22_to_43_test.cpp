// "Cases that broke others", 22 to 43: every one a test, by name and number. Judged by the long
// double reference (`broken_promise`) and, where the answer is known in closed form, by that.
#include "tests/ccd/cases.hpp"

#include <stdexcept>

using namespace kairos;
using namespace kairos::reference;

TEST_CASE("case 22: a start shifted by 1e-6", "[ccd][cases]") {
  Query q = against_unit_cube(
      box(1, 1, 1), moving(pose({4, 0.2, 0.1}, turned({1, 1, 0}, 0.3)), {-3, 0, 0}, {1, 0, 2}));
  const double before = kept(q).t_lo;
  q.motion_b.position[0].x() += 1e-6;
  const double after = kept(q).t_lo;
  CHECK(std::abs(after - before) < 1e-6);  // speed of the contact point is above 1 m/s
}

TEST_CASE("case 23: rotation about a point off the centre", "[ccd][cases]") {
  // A box on an arm of length 2: its centre moves on a circle, of which the motion is the
  // polynomial of degree 9; its own turning is the same.
  Query q{box(0.2, 0.2, 0.2), box(0.2, 0.2, 0.2), still(pose({0, 2, 0.1})),
          moving(pose({2, 0, 0}), zero, {0, 0, 1.5}), 1.0};
  q.motion_b.position.resize(9);
  double factor = 2.0;
  for (int k = 1; k <= 9; ++k) {
    factor *= 1.5 / k;
    const int quarter = k % 4;
    q.motion_b.position[k] = factor * Vector3(quarter == 0   ? 1
                                              : quarter == 2 ? -1
                                                             : 0,
                                              quarter == 1   ? 1
                                              : quarter == 3 ? -1
                                                             : 0,
                                              0);
  }
  CHECK(kept(q).status == ToiStatus::impact);
}

TEST_CASE("case 24: a target 500 m away", "[ccd][cases]") {
  Query q{box(0.5, 0.5, 0.5), box(0.5, 0.5, 0.5), still(pose(zero)),
          moving(pose({500, 0.1, 0}), {-600, 0, 0}, {1, 2, 3}), 1.0};
  CHECK(kept(q, 20000).status == ToiStatus::impact);
}

TEST_CASE("case 25: a sweep of 6 km", "[ccd][cases]") {
  Query q{box(0.1, 5, 5), Sphere{0.05}, still(pose(zero)),
          moving(pose({3000, 1, 1}), {-6000, 0, 0}), 1.0};
  const TimeOfImpact toi = kept(q, 20000);
  REQUIRE(toi.status == ToiStatus::impact);
  CHECK(toi.t_lo == Approx(2999.85 / 6000).epsilon(1e-12));  // roundoff of 3 km
}

TEST_CASE("case 26: relative velocity in a rotated frame", "[ccd][cases]") {
  const Quaternion q_W = turned({3, 1, 2}, 1.1);
  Query plain = against_unit_cube(box(1, 1, 1), moving(pose({4, 0.3, 0}), {-3, 0, 0}));
  const TimeOfImpact expected = kept(plain);
  Query rotated = plain;
  rotated.motion_a = still(pose(zero, q_W));
  rotated.motion_b = moving(pose(q_W * Vector3(4, 0.3, 0), q_W), q_W * Vector3(-3, 0, 0));
  const TimeOfImpact toi = kept(rotated);
  CHECK(toi.t_lo == Approx(expected.t_lo).epsilon(1e-12));
  CHECK((toi.normal - q_W * expected.normal).norm() < 1e-12);
}

TEST_CASE("case 27: a static body, rotated", "[ccd][cases]") {
  Query q{box(1, 1, 1), Sphere{0.5}, still(pose(zero, turned(Vector3::UnitZ(), pi / 4))),
          moving(pose({3, 0, 0}), {-2, 0, 0}), 1.0};
  const TimeOfImpact toi = kept(q);
  REQUIRE(toi.status == ToiStatus::impact);
  CHECK(toi.t_lo == Approx((3 - 0.5 - std::numbers::sqrt2) / 2).epsilon(1e-12));
}

TEST_CASE("case 28: a grazed edge does not hide the wall behind it", "[ccd][cases]") {
  // The ball passes an edge at 1e-10 and goes on to a wall: two queries, both answered.
  const Motion ball = moving(pose({0, 1.1 + 1e-10, 0}), {5, 0, 0});
  Query edge{box(0.5, 1, 1), Sphere{0.1}, still(pose({1, 0, 0})), ball, 1.0};
  CHECK(kept(edge).status == ToiStatus::separated);
  Query wall{box(0.5, 4, 4), Sphere{0.1}, still(pose({3, 0, 0})), ball, 1.0};
  CHECK(kept(wall).status == ToiStatus::impact);
}

TEST_CASE("case 29: the answer does not depend on the origin", "[ccd][cases]") {
  Query q = against_unit_cube(
      box(0.5, 1, 2), moving(pose({5, 1, 0.5}, turned({1, 2, 3}, 1.0)), {-4, 0, 0}, {2, 1, 0}));
  const double at_origin = kept(q).t_lo;
  for (const double shift : {1.0, 1024.0, 1048576.0}) {  // powers of two shift without rounding
    Query moved = q;
    moved.motion_a.position[0] += Vector3::Constant(shift);
    moved.motion_b.position[0] += Vector3::Constant(shift);
    // Coordinates round by at most u * shift, and so does the contact.
    CHECK(std::abs(kept(moved).t_lo - at_origin) < 1e-15 * shift + 1e-12);
  }
}

TEST_CASE("case 30: exactly aligned against tilted by 0.01 degrees", "[ccd][cases]") {
  double times[2] = {};
  int i = 0;
  for (const double degrees : {0.0, 0.01}) {
    const TimeOfImpact toi = kept(against_unit_cube(
        box(1, 1, 1), moving(pose({4, 0, 0}, turned({0, 1, 1}, degrees * pi / 180)), {-4, 0, 0})));
    CHECK(toi.status == ToiStatus::impact);
    times[i++] = toi.t_lo;
  }
  // The tilted corner is ahead by at most 2 sin(tilt) of the half extent.
  CHECK(times[1] < times[0]);
  CHECK(times[0] - times[1] < 2.0 * 0.01 * pi / 180 / 4);
}

TEST_CASE("case 31: two bullets head on", "[ccd][cases]") {
  Query q{Sphere{0.004}, Sphere{0.004}, moving(pose({-400, 0, 0}), {900, 0, 0}),
          moving(pose({400, 0.001, 0}), {-900, 0, 0}), 1.0};
  const TimeOfImpact toi = kept(q, 100000);
  REQUIRE(toi.status == ToiStatus::impact);
  const double reach = std::sqrt(0.008 * 0.008 - 0.001 * 0.001);
  CHECK(toi.t_lo == Approx((800 - reach) / 1800).epsilon(1e-14));
  Query boxes{box(0.004, 0.004, 0.02), box(0.004, 0.004, 0.02),
              moving(pose({-400, 0, 0}), {900, 0, 0}, {5000, 0, 0}),
              moving(pose({400, 0.001, 0}), {-900, 0, 0}, {0, 4000, 0}), 1.0};
  CHECK(kept(boxes, 100000).status == ToiStatus::impact);
}

TEST_CASE("case 32: a thin plate through an edge", "[ccd][cases]") {
  Query q{box(1, 1, 1), box(0.5, 1e-6, 0.5), still(pose(zero, turned(Vector3::UnitZ(), pi / 4))),
          moving(pose({3, 0, 0}, turned(Vector3::UnitZ(), pi / 2)), {-5, 0, 0}), 1.0};
  const TimeOfImpact toi = kept(q, 2000);
  REQUIRE(toi.status == ToiStatus::impact);
  CHECK(toi.t_lo == Approx((3 - 1e-6 - std::numbers::sqrt2) / 5).epsilon(1e-10));
}

TEST_CASE("case 33: one box wholly inside another", "[ccd][cases]") {
  const Query q = against_unit_cube(box(0.1, 0.1, 0.1), moving(pose({0.2, 0, 0}), {0.1, 0, 0}));
  CHECK(kept(q).status == ToiStatus::overlapping);
  CHECK(certified->overlap(q.a, pose(zero), q.b, pose({0.2, 0, 0})).gap ==
        Approx(-0.9).epsilon(1e-14));  // the way out to +x: 1 - 0.2 + 0.1
}

TEST_CASE("case 34: a clearance of 0.1 mm at 100 m/s", "[ccd][cases]") {
  Query q{box(1, 1, 1), box(0.5, 0.5, 0.5), still(pose(zero)),
          moving(pose({-50, 1.5001, 0}), {100, 0, 0}), 1.0};
  CHECK(kept(q, 20000).status == ToiStatus::separated);
  q.motion_b = moving(pose({-50, 1.4999, 0}), {100, 0, 0});
  CHECK(kept(q, 20000).status == ToiStatus::impact);
}

TEST_CASE("case 35: antipodal quaternions", "[ccd][cases]") {
  const Quaternion q_W = turned({1, 2, 3}, 0.8);
  const Quaternion minus(-q_W.w(), -q_W.x(), -q_W.y(), -q_W.z());
  const auto answer = [](const Quaternion& q_WB) {
    return kept(
        against_unit_cube(box(1, 0.5, 1), moving(pose({4, 0, 0}, q_WB), {-4, 0, 0}, {1, 0, 0})));
  };
  CHECK(answer(q_W).t_lo == Approx(answer(minus).t_lo).epsilon(1e-14));
}

TEST_CASE("case 36: identical start and end", "[ccd][cases]") {
  CHECK(kept(against_unit_cube(box(1, 1, 1), still(pose({3, 0, 0})))).status ==
        ToiStatus::separated);
  CHECK(kept(against_unit_cube(box(1, 1, 1), still(pose({1, 0, 0})))).status ==
        ToiStatus::overlapping);
  // There and back within the window: the end says nothing.
  Query q = against_unit_cube(box(1, 1, 1), moving(pose({3, 0, 0}), {-8, 0, 0}, zero, {16, 0, 0}));
  CHECK(kept(q).status == ToiStatus::impact);
  // A whole turn: the end is the start.
  Query turn{box(1, 0.1, 0.1), Sphere{0.1}, moving(pose(zero), zero, {0, 0, 2 * pi}),
             still(pose({0, 0.9, 0})), 1.0};
  CHECK(kept(turn).status == ToiStatus::impact);
  Query none = against_unit_cube(box(1, 1, 1), moving(pose({3, 0, 0}), {-8, 0, 0}));
  none.duration = 0.0;
  CHECK(kept(none).status == ToiStatus::separated);
}

TEST_CASE("case 37: the same query twice, the same bits", "[ccd][cases]") {
  Random random(37);
  for (int i = 0; i < 200; ++i) {
    Query q{box(1, 0.4, 0.7), box(0.3, 1, 0.5),
            moving(pose(zero, random.orientation()), random.vector(1), random.vector(3)),
            moving(pose(4 * random.direction(), random.orientation()), random.vector(4),
                   random.vector(3)),
            1.0};
    const TimeOfImpact x = q.ask(*certified);
    const TimeOfImpact y = q.ask(*ccd::make_certified());
    CHECK(x.status == y.status);
    CHECK(x.t_lo == y.t_lo);
    CHECK(x.t_hi == y.t_hi);
    CHECK(x.gap == y.gap);
    CHECK(x.normal == y.normal);
    CHECK(x.evaluations == y.evaluations);
  }
}

TEST_CASE("case 38: restitution 1 over 1e6 bounces", "[ccd][cases]") {
  const double g = 9.81;
  const double inf = std::numeric_limits<double>::infinity();
  const Shape sphere = Sphere{0.1};
  const Shape half_space = HalfSpace{};
  const Motion floor = Motion::at_rest({}, pose(zero));
  Pose at = pose({0, 5, 0});
  Vector3 v = zero;
  Instant now{};
  int overlapping = 0;
  constexpr int bounces = 1'000'000;
  for (int i = 0; i < bounces; ++i) {
    const Motion ball = Motion::ballistic(now, inf, at, {v, zero}, {0, -g, 0});
    const TimeOfImpact toi =
        certified->time_of_impact({sphere, ball}, {half_space, floor}, {now, inf}, 0.0);
    now = now + toi.t_lo;
    const double s = now - ball.start;
    at = ball.pose(s);
    v = ball.velocity(s);
    v.y() = -v.y();
    overlapping += certified->overlaps(sphere, at, half_space, pose(zero)) ? 1 : 0;
  }
  CHECK(overlapping == 0);
  const double energy = 0.5 * v.squaredNorm() + g * (at.position.y() - 0.1);
  CHECK(energy == Approx(g * 4.9).epsilon(1e-12));  // 1e6 roundings of u, mostly cancelling
  CHECK(now.seconds == Approx((2.0 * bounces - 1.0) * std::sqrt(9.8 / g)).epsilon(1e-12));
}

TEST_CASE("case 39: coordinates near 1e6 with sizes near 1", "[ccd][cases]") {
  Random random(39);
  for (int i = 0; i < 100; ++i) {
    const Vector3 far(1e6, -1e6, 7e5);
    Query q{box(1, 0.5, 0.8), box(0.6, 1, 0.5),
            moving(pose(far, random.orientation()), zero, random.vector(2)),
            moving(pose(far + 4 * random.direction(), random.orientation()), random.vector(4),
                   random.vector(2)),
            1.0};
    CHECK(broken_promise(q, q.ask(*certified)) == "");
  }
}

TEST_CASE("case 40: extents of 1e-9 beside 1e3", "[ccd][cases]") {
  Query q{box(1e-9, 1e-9, 1e-9), box(1e3, 1e3, 1e3), still(pose({1001, 3, 5})),
          moving(pose(zero), {2, 0, 0}), 1.0};
  CHECK(kept(q).status == ToiStatus::impact);
  q.motion_b = moving(pose(zero), {0.5, 0, 0}, {1e-6, 0, 0});
  CHECK(kept(q).status == ToiStatus::separated);
}

TEST_CASE("case 41: both roots of a contact within one step", "[ccd][cases]") {
  // Ball through a thin wall: in and out between the ends of the window.
  Query wall{box(0.01, 1, 1), Sphere{0.02}, still(pose(zero)),
             moving(pose({-10, 0, 0}), {215, 0, 0}), 1.0};
  CHECK(kept(wall, 20000).status == ToiStatus::impact);
  // A ball thrown up that just reaches the ceiling.
  Query ceiling{Sphere{0.5}, HalfSpace{}, moving(pose(zero), {0, 4.0, 0}, zero, {0, -8.0, 0}),
                still(pose({0, 1.5 - 1e-9, 0}, turned(Vector3::UnitX(), pi))), 1.0};
  CHECK(kept(ceiling).status == ToiStatus::impact);
}

TEST_CASE("case 42: subnormal and huge inputs", "[ccd][cases]") {
  const double tiny = 1e-310;
  Query small{box(1, 1, 1), box(1, 1, 1), still(pose(zero)),
              moving(pose({2.5, tiny, 0}), {-tiny, -tiny, 0}, {tiny, 0, 0}), 1.0};
  CHECK(kept(small).status == ToiStatus::separated);
  Query large{box(1e59, 1e59, 1e59), Sphere{1e59}, still(pose(zero)),
              moving(pose({4e59, 0, 0}), {-4e59, 0, 0}), 1.0};
  CHECK(kept(large).t_lo == Approx(0.5));
  large.motion_b = moving(pose({4e150, 0, 0}), {-4e150, 0, 0});  // powers of these overflow
  CHECK(large.ask(*certified).status == ToiStatus::undecided);
  Query sized{box(1e9, 1e9, 1e9), box(1e9, 1e9, 1e9), still(pose(zero)),
              moving(pose({4e9, 0, 0}), {-4e9, 0, 0}, {1, 1, 1}), 1.0};
  CHECK(kept(sized).status == ToiStatus::impact);
}

TEST_CASE("case 43: impacts of two pairs at the same instant, in either order", "[ccd][cases]") {
  // Two balls fall side by side: whoever is asked first, both times are the same bits.
  const Shape sphere = Sphere{0.5};
  const Shape half_space = HalfSpace{};
  const Motion floor = still(pose(zero));
  const Motion left = moving(pose({-1, 3, 0}), zero, zero, {0, -9.8, 0});
  const Motion right = moving(pose({1, 3, 0}), zero, zero, {0, -9.8, 0});
  const auto t = [&](const Motion& ball) {
    return certified->time_of_impact({sphere, ball}, {half_space, floor}, {{}, 1.0}, 0.0).t_lo;
  };
  const auto exchanged = [&](const Motion& ball) {
    return certified->time_of_impact({half_space, floor}, {sphere, ball}, {{}, 1.0}, 0.0).t_lo;
  };
  CHECK(t(left) == t(right));
  CHECK(t(left) == exchanged(right));
}

TEST_CASE("an unbounded rate of turn is no licence to pass", "[ccd][cases]") {
  // Over the whole window the quaternion cannot be bounded away from zero, so that the bound of the
  // rate is infinite: steps must shrink until it is not. Found by the random queries.
  const Query q = random_query(Difficulty::polynomial, {0, 1}, 2291);
  CHECK(std::isinf(q.motion_b.angular_speed_bound(0.0, 1.0)));
  CHECK(kept(q).status == ToiStatus::impact);
}
