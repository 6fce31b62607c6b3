// Queries that `certified` once answered wrongly, each file a class: the rows are samples of it,
// and "properties of hard queries" draws others.
#include "ccd/rounding/roundoff.hpp"
#include "ccd/swept_box.hpp"
#include "tests/ccd/cases.hpp"
#include "tests/ccd/query_rows.hpp"

#include <stdexcept>

using namespace kairos;
using namespace kairos::reference;

namespace {

/// Every row of a file, its answer and its name.
template <typename Check>
void for_rows(const std::string& file, const Check& check) {
  const std::vector<QueryRow> rows = query_rows(file);
  REQUIRE(!rows.empty());
  for (const QueryRow& row : rows) {
    const TimeOfImpact toi = row.query.ask(*certified);
    CAPTURE(row.id, std::string(to_string(toi.status)), toi.t_lo, toi.t_hi, toi.gap,
            toi.evaluations);
    check(row.query, toi);
  }
}

}  // namespace

TEST_CASE("mended: boxes in touch that slide and enter are in contact from the start",
          "[ccd][mended]") {
  // Edges of one orientation are parallel to roundoff: along their cross products, which are noise,
  // nothing leaves.
  for_rows("touch_and_enter.csv", [](const Query& q, const TimeOfImpact& toi) {
    CHECK(toi.status == ToiStatus::impact);
    CHECK(toi.t_lo == 0.0);
    CHECK(q.separation(toi.t_hi) < 0);
  });
}

TEST_CASE("mended: a box that slides into a block does not fall through it", "[ccd][mended]") {
  const Quaternion q =
      turned({-0.8986864557269622, 0.4313282652498902, 0.07948950804622834}, 2.83573447929511);
  const Query slide{
      box(1, 1, 1), box(0.5, 0.5, 0.5), moving(pose(zero, q), zero, zero, zero, 20.0),
      moving(pose({-1.1718040082001422, -0.8852028947846686, -0.3054360840354721}, q),
             {-0.32433942670898275, 0.19416778538370782, 0.9271476729201636}, zero, zero, 20.0),
      20.0};
  const TimeOfImpact toi = slide.ask(*certified);
  REQUIRE(toi.status == ToiStatus::impact);
  CHECK(toi.t_lo == 0.0);
  CHECK(slide.separation(1) < -1e-3);  // where it would be
}

TEST_CASE("mended: along tilted planes for long, contacts are neither missed nor late",
          "[ccd][mended]") {
  // Rounded, a normal is off by 1e-16, and the height by as much of a way of up to 5e10 m.
  for_rows("along_tilted_planes.csv", [](const Query& q, const TimeOfImpact& toi) {
    CHECK(toi.status == ToiStatus::impact);
    CHECK(toi.evaluations <= 10);
    // Long double: 8 roundings of 1e-19 of the way. Contacts as deep as 1e-5 m were missed.
    const Real way = (q.motion_a.twist(q.duration).linear.norm() + 1.0) * q.duration;
    const Real e = 8 * std::numeric_limits<Real>::epsilon() * way;
    const auto f = [&q](Real t) { return q.separation(t); };
    CHECK(f(toi.t_lo) > -e);
    CHECK(f(toi.t_hi) < e);
    CHECK(f(Real(q.duration)) < -e);
  });
}

TEST_CASE("mended: a box that passes another after a long way is not told to hit it",
          "[ccd][mended]") {
  // The gap is below the roundoff of the way: that it is negative is not proven.
  for_rows("misses_after_a_long_way.csv", [](const Query& q, const TimeOfImpact& toi) {
    const bool hidden = toi.status == ToiStatus::undecided || toi.status == ToiStatus::separated;
    CHECK(hidden);
    CHECK(toi.gap <= ccd::default_tolerance(q.moving_a(), q.moving_b(), q.window()));
    CHECK(toi.evaluations <= 100);
  });
}

TEST_CASE("mended: 1e8 m from the origin poses at t_lo do not overlap", "[ccd][mended]") {
  // An ulp of time is nothing there: it takes 1e-8 s until a coordinate changes.
  for_rows("contacts_far_from_the_origin.csv", [](const Query& q, const TimeOfImpact& toi) {
    CHECK(toi.status == ToiStatus::impact);
    CHECK(!certified->overlaps(q.a, q.motion_a.pose(toi.t_lo), q.b, q.motion_b.pose(toi.t_lo)));
  });
}

TEST_CASE("mended: grazes of turning bodies do not stall", "[ccd][mended]") {
  // They took 2,200 to 20,000 evaluations, and some ended undecided beside a clear contact.
  for_rows("grazing_turns.csv", [](const Query& q, const TimeOfImpact& toi) {
    CHECK(toi.status != ToiStatus::undecided);
    CHECK(toi.evaluations <= 100);
    CHECK(broken_promise(q, toi, 2000) == "");
  });
}

TEST_CASE("mended: what spins beside a body is outside its solid of revolution", "[ccd][mended]") {
  // Up to 3.9e5 rad, 1e-12 m beside it, took ten million evaluations.
  for_rows("fast_spins.csv", [](const Query&, const TimeOfImpact& toi) {
    CHECK(toi.status == ToiStatus::separated);
    CHECK(toi.evaluations <= 10);
  });
}

TEST_CASE("mended: spinning towards a wall is no contact in mid-air, however fast",
          "[ccd][mended]") {
  // A cube that spins about the normal of a wall 1 m off, up to 1e6 rad until it is there.
  for (const double rate : {600.0, 1e5, 1e6}) {
    const Query q{box(0.5, 0.5, 0.5), HalfSpace{Vector3(-1, 0, 0)},
                  moving(pose(zero), {0.2, 0, 0}, {rate, 0, 0}, zero, 10.0),
                  moving(pose({2, 0, 0}), zero, zero, zero, 10.0), 10.0};
    const TimeOfImpact toi = q.ask(*certified);
    CAPTURE(rate, toi.evaluations);
    REQUIRE(toi.status == ToiStatus::impact);
    CHECK(toi.t_lo == Approx(7.5).epsilon(1e-12));  // roundoff of coordinates of 2 m at 0.2 m/s
    CHECK(toi.evaluations <= 10);
  }
}

TEST_CASE("mended: who asks again from where an undecided query stopped comes through",
          "[ccd][mended]") {
  // A ball in the waist of the double cone that a stick passes, spinning slowly towards it: the
  // work of one query is not enough.
  const Query q{Sphere{0.1}, box(1, 0.05, 0.05),
                moving(pose({0, 0.5, 0}), {0, -0.4, 0}, zero, zero, 1.0),
                moving(pose(zero), zero, 2e6 * Vector3(1, 0, 1), zero, 1.0), 1.0};
  double t = 0.0;
  TimeOfImpact toi;
  int asked = 0;
  do {
    toi =
        certified->time_of_impact(q.moving_a(), q.moving_b(), {Instant{} + t, q.duration - t}, 0.0);
    REQUIRE(++asked < 20);
    if (toi.status == ToiStatus::undecided) {
      CHECK(toi.t_hi > 0.0);
    }
    t += toi.status == ToiStatus::undecided ? toi.t_hi : toi.t_lo;
  } while (toi.status == ToiStatus::undecided);
  CHECK(asked > 1);
  REQUIRE(toi.status == ToiStatus::impact);
  CHECK(q.separation(t) < 1e-6);
}

TEST_CASE("mended: a slightly tilted half-space is unbounded to every side", "[ccd][mended]") {
  // 1e9 m off, a tilt of 1e-9 is a metre.
  const Shape ground = HalfSpace{};
  const Motion tilted = still(pose(zero, turned({0, 0, 1}, 1e-9)));
  const Aabb swept = ccd::swept_aabb(ground, tilted, 0.0, 1.0);
  CHECK(swept.upper.y() == ccd::infinity);
  // Along an axis that was computed, roundoff is no tilt: a wall stays a wall.
  const Motion wall = still(pose(zero, turned({0, 0, 1}, -pi / 2)));
  const Aabb behind = ccd::swept_aabb(ground, wall, 0.0, 1.0);
  CHECK(behind.upper.x() < 1e-12);
  CHECK(behind.lower.x() == -ccd::infinity);
}

TEST_CASE("mended: a ball that closes in by roundoff of a speed is apart, not undecided",
          "[ccd][mended]") {
  // It flies along a tilted plane; what is left of its speed towards it is 1e-20 m/s and less.
  const Vector3 n(0.46588655069068374, 0, -0.8848444619737059);
  for (double closing = 1e-20; closing > 0.0; closing *= 1e-7) {
    const Query q{Sphere{1.1}, HalfSpace{n},
                  moving(pose({8.1, 1.1, -10.3}), {-closing, 1.33, 0}, zero, {0, -9.8, 0}),
                  still(pose(zero)), 1.0};
    Query pulled = q;
    pulled.motion_a = moving(pose({8.1, 1.1, -10.3}), {0, 1.33, 0}, zero, {-closing, -9.8, 0});
    CAPTURE(closing);
    CHECK(q.ask(*certified).status == ToiStatus::separated);
    CHECK(pulled.ask(*certified).status == ToiStatus::separated);
  }
}

TEST_CASE("mended: a half-space that turns carries what is far from its origin", "[ccd][mended]") {
  // A box 0.1 m deep in the ground, 1000 m from where the ground turns at 1e-3 rad/s: 1 m/s there.
  const Query q{box(0.5, 0.5, 0.5), HalfSpace{}, still(pose({1000, 0.4, 0})),
                moving(pose(zero), zero, {0, 0, -1e-3}), 1.0};
  const TimeOfImpact toi =
      certified->time_of_separation(q.moving_a(), q.moving_b(), q.window(), 0.0);
  REQUIRE(toi.status == ToiStatus::impact);
  CHECK(q.separation(toi.t_lo) <= 1e-9);  // the tolerance
  CHECK(q.separation(toi.t_hi) > 0);
  CHECK(toi.t_hi == Approx(0.1).epsilon(1e-3));  // sin and cos of 1e-4 rad
}

TEST_CASE("mended: boxes that slide a little inside each other are followed until they part",
          "[ccd][mended]") {
  // 50 nm deep, sliding at 1 or 2 m/s: depth over speed would take steps of 25 or 50 ns. Looks are
  // counted: a few for each face that is crossed, and some twenty to the tolerance.
  constexpr double depth = 50e-9;
  const auto slides = [](const Query& q, double parts_at) {
    const TimeOfImpact toi =
        certified->time_of_separation(q.moving_a(), q.moving_b(), q.window(), 0.0);
    CAPTURE(toi.evaluations, toi.t_lo, toi.t_hi);
    REQUIRE(toi.status == ToiStatus::impact);
    CHECK(toi.evaluations < 200);
    CHECK(q.separation(toi.t_lo) <= 1e-9);  // the tolerance
    CHECK(q.separation(toi.t_hi) > 0);
    CHECK(toi.t_hi == Approx(parts_at).epsilon(1e-6));
  };
  const Query flat{box(0.5, 0.5, 0.5), box(0.5, 0.5, 0.5), still(pose(zero)),
                   moving(pose({0, 1 - depth, 0}), {2, 0, 0}), 1.0};
  slides(flat, 0.5);
  // Edge over edge at right angles: each slides along itself and across the other.
  const double edge = 0.5 * std::sqrt(2.0);
  const Query crossed{
      box(0.5, 0.5, 0.5), box(0.5, 0.5, 0.5), still(pose(zero, turned({0, 0, 1}, pi / 4))),
      moving(pose({0, 2 * edge - depth, 0}, turned({1, 0, 0}, pi / 4)), {0.6, 0, 0.8}), 1.0};
  slides(crossed, 0.625);  // where b's edge ends, at z = 0.5
  const Query ball{Sphere{0.25}, box(0.5, 0.5, 0.5), moving(pose({0, 0.75 - depth, 0}), {-2, 0, 0}),
                   still(pose(zero)), 1.0};
  slides(ball, 0.25 + std::sqrt(0.5 * 0.25 * depth));  // over the rim
}

TEST_CASE("mended: what is no query is refused", "[ccd][mended]") {
  const Motion still_a = still(pose(zero));
  const Motion falling = moving(pose({0, 3, 0}), {0, -2, 0});
  const Shape unit_ball = Sphere{1.0};
  const auto asked = [&](const Shape& shape, const Motion& motion, double duration,
                         double tolerance = 0.0) {
    return certified->time_of_impact({unit_ball, still_a}, {shape, motion}, {{}, duration},
                                     tolerance);
  };
  CHECK(asked(unit_ball, falling, 1.0).status == ToiStatus::impact);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {-1.0, 0.0, nan, ccd::infinity, 1e-300, 1e300}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(asked(Sphere{bad}, falling, 1.0), std::invalid_argument);
    CHECK_THROWS_AS(asked(box(1, bad, 1), falling, 1.0), std::invalid_argument);
    CHECK_THROWS_AS(certified->overlaps(Sphere{bad}, pose(zero), unit_ball, pose(zero)),
                    std::invalid_argument);
  }
  CHECK_THROWS_AS(asked(HalfSpace{Vector3(0, 2, 0)}, falling, 1.0), std::invalid_argument);
  CHECK_THROWS_AS(asked(unit_ball, falling, 1.5), std::invalid_argument);  // the motion lasts 1 s
  CHECK_THROWS_AS(asked(unit_ball, falling, -0.5), std::invalid_argument);
  CHECK_THROWS_AS(asked(unit_ball, falling, nan), std::invalid_argument);
  CHECK_THROWS_AS(asked(unit_ball, falling, 1.0, -1.0), std::invalid_argument);
  Motion bad = falling;
  bad.quaternion[0] *= 2.0;
  CHECK_THROWS_AS(asked(unit_ball, bad, 1.0), std::invalid_argument);
  bad = falling;
  for (const double lost : {1e100, ccd::infinity, nan}) {  // by an integration: nothing is proven
    bad.position[1].x() = lost;
    CHECK(asked(unit_ball, bad, 1.0).status == ToiStatus::undecided);
  }
  bad = falling;
  bad.error_radius = -1e-9;
  CHECK_THROWS_AS(asked(unit_ball, bad, 1.0), std::invalid_argument);
}

TEST_CASE("mended: boxes that meet edge to edge, or flat and turning, touch where they say",
          "[ccd][mended]") {
  // Cubes of one orientation that meet along their edges: a face of one, clipped by the other, is
  // an edge or, by rounding, nothing. Flat faces: edges across each other have their direction too.
  const Quaternion eighth(Eigen::AngleAxisd(0.25 * pi, Vector3(1, 1, 0).normalized()));
  const double diagonal = 2.0 * std::sqrt(2.0);
  const Vector3 way = eighth * Vector3(1, 1, 0).normalized();
  const Motion turning = moving(pose(zero, Quaternion(Eigen::AngleAxisd(0.149, Vector3::UnitZ()))),
                                zero, {0, 0, 0.3}, zero, 2.0);
  const struct {
    Shape a, b;
    Motion motion_a, motion_b;
  } cases[] = {
      {box(1, 1, 1), box(1, 1, 1), moving(pose(zero, eighth), zero, zero, zero, 2.0),
       moving(pose((diagonal + 1.6) * way, eighth), -1.66 * way, zero, zero, 2.0)},
      {box(1.026, 0.211, 0.864), box(0.311, 0.162, 1.497), turning,
       moving(pose({0, 0, 4.16}), {0, 0, -1.24}, zero, zero, 2.0)},
  };
  for (const auto& [a, b, motion_a, motion_b] : cases) {
    const TimeOfImpact toi = certified->time_of_impact({a, motion_a}, {b, motion_b}, {{}, 2.0}, 0);
    REQUIRE(toi.status == ToiStatus::impact);
    // Ten times the tolerance, 1e-9 of an extent.
    CHECK((toi.witness_b - toi.witness_a).norm() <= 1e-8);
    const auto on_surface = [&](const Shape& shape, const Motion& motion, const Vector3& point) {
      const Pose at = motion.pose(toi.t_lo);
      const Vector3 local = at.orientation.conjugate() * (point - at.position);
      const Vector3 beyond = local.cwiseAbs() - std::get<Box>(shape).half_extents;
      return std::abs(beyond.maxCoeff()) <= 1e-8;
    };
    CHECK(on_surface(a, motion_a, toi.witness_a));
    CHECK(on_surface(b, motion_b, toi.witness_b));
  }
}

TEST_CASE("mended: a window ends with its motion, as well as instants tell", "[ccd][mended]") {
  // A pyramid under the law garwin came to motions of 5e-24 s; at 1 s an instant resolves 1e-32 s.
  constexpr double lasts = 5e-24;
  const Instant start{1.0, 0.0};
  const Shape ball = Sphere{1.0};
  const auto asked = [&](double until) {
    Motion a = still(pose(zero));
    Motion b = moving(pose({0, 3, 0}), {0, -2, 0});
    a.start = b.start = start;
    a.duration = b.duration = lasts;
    const double from = 3e-24;
    return certified->time_of_impact({ball, a}, {ball, b}, {start + from, until - from}, 0.0);
  };
  CHECK(asked(lasts + 1e-32).status == ToiStatus::separated);
  CHECK_THROWS_AS(asked(lasts + 1e-28), std::invalid_argument);
}
