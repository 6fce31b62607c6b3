// "Cases that broke others", 1 to 21: every one a test, by name and number. Judged by the long
// double reference (`broken_promise`) and, where the answer is known in closed form, by that.
#include "ccd/relative_boxes.hpp"
#include "tests/ccd/cases.hpp"

using namespace kairos;
using namespace kairos::reference;

TEST_CASE("case 1: edge ends within 1e-12 of touching", "[ccd][cases]") {
  // Two edges that cross at right angles; b sinks to 1e-12 above contact, or below it.
  const Quaternion edge_up = turned(Vector3::UnitX(), pi / 4);
  const Quaternion edge_down = turned(Vector3::UnitZ(), pi / 4);
  for (const double left : {1e-12, -1e-12}) {
    const double contact = 2.0 * std::numbers::sqrt2;
    Query q{box(1, 1, 1), box(1, 1, 1), still(pose(zero, edge_up)),
            moving(pose({0, contact + 0.5, 0}, edge_down), {0, -0.5 + left, 0}), 1.0};
    const TimeOfImpact toi = kept(q);
    CHECK(toi.status == (left > 0 ? ToiStatus::separated : ToiStatus::impact));
  }
}

TEST_CASE("case 2: edge-edge offset 1 +- 1e-8", "[ccd][cases]") {
  for (const double offset : {1.0 - 1e-8, 1.0, 1.0 + 1e-8}) {
    // b passes over the end of the edge of a: its side face is at x = offset.
    const TimeOfImpact toi =
        kept(against_unit_cube(box(1, 1, 1), moving(pose({1.0 + offset, 5, 0}), {0, -4, 0})));
    if (offset != 1.0) {
      CHECK(toi.status == (offset > 1.0 ? ToiStatus::separated : ToiStatus::impact));
    } else {
      CHECK(toi.status != ToiStatus::separated);  // faces slide along each other from t = 0.75 on
    }
  }
}

TEST_CASE("case 3: grazing rotation at pi/6 - 1e-12", "[ccd][cases]") {
  // The corner of a turning square plate of half diagonal r rises to its highest at 45 degrees;
  // here the turn stops 1e-12 short of the contact angle, or 1e-12 beyond it.
  const double contact = std::sin(pi / 4 + pi / 6) * std::numbers::sqrt2;
  for (const double short_by : {1e-12, -1e-12}) {
    Query q{box(1, 1, 1), HalfSpace{}, moving(pose(zero), zero, {0, 0, pi / 6 - short_by}),
            still(pose({0, contact, 0}, turned(Vector3::UnitX(), pi))), 1.0};
    const TimeOfImpact toi = kept(q);
    CHECK(toi.status == (short_by > 0 ? ToiStatus::separated : ToiStatus::impact));
  }
}

TEST_CASE("case 4: 4e5 rad within a step", "[ccd][cases]") {
  // A stick spins about its middle while a ball comes in from the side.
  const double w = 4e5;
  Query hit{Sphere{0.1}, box(1, 0.05, 0.05), moving(pose({2, 0, 0}), {-1.5, 0, 0}),
            moving(pose(zero), zero, {0, 0, w}), 1.0};
  const TimeOfImpact toi = kept(hit, 2000);
  REQUIRE(toi.status == ToiStatus::impact);
  // The ball cannot sink in by more than it moves in half a turn.
  CHECK(toi.t_lo == Approx((2.0 - 1.1) / 1.5).margin(0.02));
  Query miss = hit;
  miss.motion_a = moving(pose({1.2, 0, 0}), {0, 1, 0});
  CHECK(kept(miss, 2000).status == ToiStatus::separated);
  // In the waist of the double cone that the spinning stick passes: one turn is as good as all.
  miss.motion_a = moving(pose({0, 0.5, 0}), zero);
  miss.motion_b = moving(pose(zero), zero, 1e9 * Vector3(1, 0, 1));
  CHECK(kept(miss, 2000).status == ToiStatus::separated);
  // If it moves none is: undecided, after the work allowed, and proven apart that far.
  miss.motion_a = moving(pose({0, 0.5, 0}), {0, 1e-3, 0});
  const TimeOfImpact waist = miss.ask(*certified);
  CHECK(waist.status == ToiStatus::undecided);
  CHECK(waist.t_lo > 0.0);
  CHECK(waist.t_hi == waist.t_lo);
  CHECK(waist.gap > 0.1);
  // Above the cone, apart along the axis of the spin.
  miss.motion_a = moving(pose({0, 0, 0.5}), zero);
  miss.motion_b = moving(pose(zero), zero, 1e9 * Vector3(0.3, 0, 1));
  CHECK(miss.ask(*certified).status == ToiStatus::separated);
  // Out of reach, or separated along the axis of the spin: no matter how fast.
  miss.motion_a = moving(pose({0, 0, 5}), zero);
  CHECK(miss.ask(*certified).status == ToiStatus::separated);
}

TEST_CASE("case 5: unwrapped angle of 513 rad", "[ccd][cases]") {
  Query q{Sphere{0.05}, box(1, 0.05, 0.05), still(pose({0, 0.9, 0})),
          moving(pose(zero), zero, {0, 0, 513.0}), 1.0};
  const TimeOfImpact toi = kept(q, 4000);
  REQUIRE(toi.status == ToiStatus::impact);
  const double quarter = pi / 2 - std::asin(0.1 / 0.9);      // the side of the stick meets the ball
  CHECK(toi.t_lo == Approx(quarter / 513.0).epsilon(1e-9));  // solver: a bracket of 1e-12 s
}

TEST_CASE("case 6: pure spin, no translation", "[ccd][cases]") {
  // The corner of a square of half side 1 reaches a wall at 1.2 when cos(45 - angle) = 1.2/sqrt 2.
  Query q{box(1, 1, 1), box(1, 5, 5), moving(pose(zero), zero, {0, 0, 1.0}),
          still(pose({2.2, 0, 0})), 1.0};
  const TimeOfImpact toi = kept(q);
  REQUIRE(toi.status == ToiStatus::impact);
  const double exact = pi / 4 - std::acos(1.2 / std::numbers::sqrt2);
  CHECK(toi.t_lo <= exact);
  CHECK(toi.t_hi >= exact);
}

TEST_CASE("case 7: thin spinning stick through a sphere", "[ccd][cases]") {
  Query q{Sphere{0.2}, box(1e-4, 2, 1e-4), still(pose({1.5, 0, 0})),
          moving(pose(zero), zero, {0, 0, 40.0}), 1.0};
  CHECK(kept(q, 2000).status == ToiStatus::impact);
}

TEST_CASE("case 8: coaxial screw with a tight gap", "[ccd][cases]") {
  // Turning about the common normal while the gap of 1e-6 stays, or closes at the end.
  for (const double sink : {0.0, 1e-6 * (1.0 + 1e-6)}) {
    Query q{box(1, 1, 1), box(1, 1, 1), still(pose(zero)),
            moving(pose({0, 2.0 + 1e-6, 0}), {0, -sink, 0}, {0, 20.0, 0}), 1.0};
    CHECK(kept(q).status == (sink > 0.0 ? ToiStatus::impact : ToiStatus::separated));
  }
}

TEST_CASE("case 9: the curved path hits where its chord misses", "[ccd][cases]") {
  Query q{Sphere{0.1}, box(0.1, 0.1, 0.1), still(pose({0, 1, 0})),
          moving(pose({-1, 0, 0}), {2, 4, 0}, zero, {0, -8, 0}), 1.0};
  CHECK(kept(q).status == ToiStatus::impact);
}

TEST_CASE("case 10: the first of two contacts is not skipped", "[ccd][cases]") {
  // A turning bar meets the wall with one end, frees itself, and meets it again with the other.
  Query q{box(1, 0.1, 0.1), HalfSpace{}, moving(pose({0, 0.8, 0}), zero, {0, 0, 7.0}),
          still(pose(zero)), 1.0};
  const TimeOfImpact toi = kept(q, 2000);
  REQUIRE(toi.status == ToiStatus::impact);
  // sin x + 0.1 cos x = 0.8 at the first contact.
  const double exact = (std::asin(0.8 / std::sqrt(1.01)) - std::atan(0.1)) / 7.0;
  CHECK(toi.t_lo == Approx(exact).epsilon(1e-10));  // solver
}

TEST_CASE("case 11: identically coplanar crossing mid-step", "[ccd][cases]") {
  // All edges stay in parallel planes; the front faces meet at 0.5.
  const TimeOfImpact toi =
      kept(against_unit_cube(box(1, 1, 1), moving(pose({4, 0, 0}), {-4, 0, 0})));
  REQUIRE(toi.status == ToiStatus::impact);
  CHECK(toi.t_lo == Approx(0.5).epsilon(1e-12));  // roundoff of coordinates of 4
}

TEST_CASE("case 12: no contact at 0 where the bodies are separated", "[ccd][cases]") {
  const Query q = against_unit_cube(box(1, 1, 1), moving(pose({2 + 1e-9, 0, 0}), {1, 0, 0}));
  CHECK(kept(q).status == ToiStatus::separated);
}

TEST_CASE("case 13: touching, tangential motion", "[ccd][cases]") {
  // Neither an impact nor a hang: in touch all along, the gap is 0 to roundoff.
  const TimeOfImpact boxes =
      kept(against_unit_cube(box(1, 1, 1), moving(pose({2, 0, 0}), {0, 0.5, 0})));
  CHECK(boxes.status == ToiStatus::undecided);
  CHECK(boxes.t_lo == 0.0);
  Query ball{Sphere{1}, HalfSpace{}, moving(pose({0, 1, 0}), {1, 0, 0}), still(pose(zero)), 1.0};
  CHECK(kept(ball).status == ToiStatus::undecided);
  Query balls{Sphere{1}, Sphere{1}, still(pose(zero)), moving(pose({2, 0, 0}), {0, 1, 0}), 1.0};
  CHECK(kept(balls).status == ToiStatus::separated);  // it leaves along the tangent
}

TEST_CASE("case 14: touching, separating", "[ccd][cases]") {
  CHECK(kept(against_unit_cube(box(1, 1, 1), moving(pose({2, 0, 0}), {0.5, 0, 0}))).status ==
        ToiStatus::separated);
  CHECK(kept(against_unit_cube(box(1, 1, 1), moving(pose({2, 0, 0}), {0.5, 0, 0}, {0, 0, 0.1})))
            .status == ToiStatus::separated);
  Query ball{Sphere{1}, HalfSpace{}, moving(pose({0, 1, 0}), {0, 2, 0}, zero, {0, -9.8, 0}),
             still(pose(zero)), 1.0};
  const TimeOfImpact toi = kept(ball);
  REQUIRE(toi.status == ToiStatus::impact);
  CHECK(toi.t_lo == Approx(4.0 / 9.8).epsilon(1e-13));  // roundoff
}

TEST_CASE("case 15: advance to the answer, ask again, and again", "[ccd][cases]") {
  Query q = against_unit_cube(
      box(1, 0.5, 0.7), moving(pose({5, 0.3, 0.2}, turned({1, 2, 3}, 0.7)), {-4, 0, 0}, {1, 2, 1}));
  const TimeOfImpact first = kept(q);
  REQUIRE(first.status == ToiStatus::impact);
  Instant now{};
  double left = q.duration;
  double again = first.t_lo;
  for (int i = 0; i < 5; ++i) {
    now = now + again;
    left -= again;
    const TimeOfImpact next =
        certified->time_of_impact(q.moving_a(), q.moving_b(), {now, left}, 0.0);
    CHECK(next.status == ToiStatus::impact);
    CHECK(next.t_lo < 1e-9);  // still there: nothing was handled, nothing is overlapping
    again = next.t_lo;
  }
}

TEST_CASE("case 16: endless impacts on one contact", "[ccd][cases]") {
  // After a reflection the same contact is not an impact again.
  Motion ball = moving(pose({0, 3, 0}), {0, -1, 0}, zero, {0, -9.8, 0}, 10.0);
  const Motion floor = Motion::at_rest({}, pose(zero));
  const Shape sphere = Sphere{0.5};
  const Shape half_space = HalfSpace{};
  Instant now{};
  for (int i = 0; i < 50; ++i) {
    const TimeOfImpact toi =
        certified->time_of_impact({sphere, ball}, {half_space, floor}, {now, 10.0}, 0.0);
    REQUIRE(toi.status == ToiStatus::impact);
    CHECK((i == 0 || toi.t_lo > 0.1));
    now = now + toi.t_lo;
    const double s = now - ball.start;
    Twist twist = ball.twist(s);
    twist.linear.y() *= -1.0;
    ball = Motion::ballistic(now, 20.0, ball.pose(s), twist, {0, -9.8, 0});
  }
}

TEST_CASE("case 17: kissing boxes below epsilon", "[ccd][cases]") {
  for (const double gap : {1e-15, 1e-14, 1e-13}) {
    for (const double direction : {-1.0, 1.0}) {
      const TimeOfImpact toi =
          kept(against_unit_cube(box(1, 1, 1), moving(pose({2.0 + gap, 0, 0}), {direction, 0, 0})));
      CHECK(toi.status == (direction < 0 ? ToiStatus::impact : ToiStatus::separated));
    }
  }
}

TEST_CASE("case 18: exactly parallel faces", "[ccd][cases]") {
  const Quaternion common = turned({1, 2, 3}, 0.9);
  const Vector3 n = common * Vector3::UnitY();
  Query q{box(1, 1, 1), box(2, 0.5, 1), still(pose(zero, common)),
          moving(pose(2.5 * n, common), -2.0 * n), 1.0};
  const TimeOfImpact toi = kept(q);
  REQUIRE(toi.status == ToiStatus::impact);
  CHECK(toi.t_lo == Approx(0.5).epsilon(1e-12));  // roundoff of rotated coordinates
}

TEST_CASE("case 19: near-parallel edges at 1e-3 ... 1e-15", "[ccd][cases]") {
  const Quaternion edge_up = turned(Vector3::UnitX(), pi / 4);
  for (int k = 3; k <= 15; ++k) {
    const double angle = std::pow(10.0, -k);
    CAPTURE(angle);
    const Quaternion edge_down = turned(Vector3::UnitY(), angle) * edge_up;
    Query q{box(1, 1, 1), box(1, 1, 1), still(pose(zero, edge_up)),
            moving(pose({0, 4, 0.1}, edge_down), {0, -3, 0}), 1.0};
    CHECK(kept(q).status == ToiStatus::impact);
    q.motion_b = moving(pose({0, 4, 0.1}, edge_down), {0, -3, 0}, {0, 1e-3, 0});
    CHECK(kept(q).status == ToiStatus::impact);
  }
}

TEST_CASE("case 20: no degeneracy guard after normalising", "[ccd][cases]") {
  // Tiny boxes: cross products of edges are not tiny because the boxes are.
  Query q{box(1e-12, 1e-12, 1e-12), box(1e-12, 1e-12, 1e-12),
          still(pose(zero, turned(Vector3::UnitX(), pi / 4))),
          moving(pose({0, 4e-12, 0}, turned(Vector3::UnitZ(), pi / 4)), {0, -3e-12, 0}), 1.0};
  const TimeOfImpact toi = kept(q);
  REQUIRE(toi.status == ToiStatus::impact);
  CHECK(toi.t_lo == Approx((4 - 2 * std::numbers::sqrt2) / 3).epsilon(1e-10));  // solver
}

TEST_CASE("case 21: cubes in general position", "[ccd][cases]") {
  // 2e4 of them here (1e7 in the benchmark): the plain test agrees with long double wherever that
  // is not within roundoff of touching.
  Random random(21);
  int wrong = 0;
  int undecided = 0;
  for (int i = 0; i < 20000; ++i) {
    Query q{box(1, 1, 1), box(1, 1, 1), still(pose(random.vector(1.5), random.orientation())),
            still(pose(random.vector(1.5), random.orientation())), 0.0};
    const Real truth = q.separation(0);
    const bool overlap = certified->overlaps(q.a, q.motion_a.pose(0), q.b, q.motion_b.pose(0));
    const ccd::RelativeBoxes boxes(std::get<Box>(q.a), q.motion_a.pose(0), std::get<Box>(q.b),
                                   q.motion_b.pose(0));
    const ccd::Verdict verdict = ccd::classify(boxes);
    wrong += std::abs(truth) > 1e-13L && overlap != (truth <= 0) ? 1 : 0;
    wrong += verdict == ccd::Verdict::separated && truth <= 0 ? 1 : 0;
    wrong += verdict == ccd::Verdict::overlapping && truth > 0 ? 1 : 0;
    undecided += verdict == ccd::Verdict::undecided ? 1 : 0;
  }
  CHECK(wrong == 0);
  CHECK(undecided == 0);
}
