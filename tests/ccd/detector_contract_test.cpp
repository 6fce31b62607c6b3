// Contract of ContactDetector, run over every detector by name.
#include "ccd/bisection.hpp"
#include "ccd/certified.hpp"
#include "ccd/conservative_advancement.hpp"
#include "ccd/sat.hpp"
#include "ccd/step_ends.hpp"
#include "ccd/toi_batch.hpp"
#include "experiments/accuracy/random_query.hpp"
#include "tests/catch.hpp"

#include <memory>
#include <numbers>
#include <vector>

using namespace kairos;
using namespace kairos::reference;

namespace {

std::vector<std::unique_ptr<ContactDetector>> detectors() {
  std::vector<std::unique_ptr<ContactDetector>> all;
  all.push_back(ccd::make_sat());
  all.push_back(ccd::make_bisection());
  all.push_back(ccd::make_conservative_advancement());
  all.push_back(ccd::make_certified());
  return all;
}

const Vector3 zero = Vector3::Zero();
const double inf = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("a batch of times of impact is what each gives by itself, in order", "[ccd][batch]") {
  const auto certified = ccd::make_certified();
  Random random(2);
  std::vector<Query> kept;
  for (int i = 0; i < 400; ++i) {
    const ShapeKinds kinds = shape_kinds[random.below(5)];
    kept.push_back({random_shape(random, kinds.a, 1.0), random_shape(random, kinds.b, 1.0),
                    moving(pose(random.vector(2.0), random.orientation()), random.vector(3.0)),
                    moving(pose(random.vector(2.0), random.orientation()), zero), 1.0});
  }
  std::vector<ccd::ToiQuery> queries;
  for (const Query& q : kept) {
    queries.push_back({{q.a, q.motion_a}, {q.b, q.motion_b}, {Instant{}, 1.0}});
  }
  std::vector<TimeOfImpact> answers(queries.size());
  ccd::toi_batch(*certified, queries, answers);
  int impacts = 0;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const ccd::ToiQuery& q = queries[i];
    const TimeOfImpact one = certified->time_of_impact(q.a, q.b, q.window, 0.0);
    CHECK(answers[i].status == one.status);
    CHECK(answers[i].t_lo == one.t_lo);
    CHECK(answers[i].t_hi == one.t_hi);
    impacts += one.status == ToiStatus::impact ? 1 : 0;
  }
  CHECK(impacts > 10);  // otherwise the batch shows nothing
  CHECK_THROWS_AS(ccd::toi_batch(*certified, queries, std::span(answers).first(3)),
                  std::invalid_argument);
}

TEST_CASE("detectors agree with long double on who overlaps", "[ccd][contract]") {
  for (const auto& detector : detectors()) {
    CAPTURE(std::string(detector->info().name));
    Random random(1);
    int wrong = 0;
    for (int i = 0; i < 4000; ++i) {
      const ShapeKinds kinds = shape_kinds[random.below(5)];
      Query q{random_shape(random, kinds.a, 1.0), random_shape(random, kinds.b, 1.0),
              moving(pose(random.vector(1.0), random.orientation()), zero),
              moving(pose(random.vector(1.0), random.orientation()), zero), 0.0};
      const Pose a = q.motion_a.pose(0);
      const Pose b = q.motion_b.pose(0);
      const Real truth = q.separation(0);
      if (std::abs(truth) < 1e-13L) {  // roundoff of unit sizes
        continue;
      }
      const bool overlaps = detector->overlaps(q.a, a, q.b, b);
      const Overlap measured = detector->overlap(q.a, a, q.b, b);
      wrong += overlaps != (truth <= 0) || overlaps != detector->overlaps(q.b, b, q.a, a) ||
                       measured.overlapping != overlaps || (measured.gap > 0) == overlaps ||
                       std::abs(measured.normal.norm() - 1.0) > 1e-12
                   ? 1
                   : 0;
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("the measured gap separates: moved by it along the normal, the bodies touch",
          "[ccd][contract]") {
  const auto detector = ccd::make_certified();
  Random random(2);
  int wrong = 0;
  for (int i = 0; i < 4000; ++i) {
    const ShapeKinds kinds = shape_kinds[random.below(5)];
    Query q{random_shape(random, kinds.a, 1.0), random_shape(random, kinds.b, 1.0),
            moving(pose(random.vector(1.0), random.orientation()), zero),
            moving(pose(random.vector(1.5), random.orientation()), zero), 0.0};
    const Overlap at = detector->overlap(q.a, q.motion_a.pose(0), q.b, q.motion_b.pose(0));
    Query touching = q;
    touching.motion_b.position[0] -= at.gap * at.normal;
    wrong += std::abs(touching.separation(0)) > 1e-9L ? 1 : 0;  // roundoff, through 1/sine of edges
  }
  CHECK(wrong == 0);
}

TEST_CASE("contact points are the middle of the patch", "[ccd][contract]") {
  for (const auto& detector : detectors()) {
    CAPTURE(std::string(detector->info().name));
    const Pose floor = pose(zero);
    const double root = std::numbers::sqrt2;
    // Flat on a plane; on an edge; on a corner.
    CHECK((detector->overlap(box(1, 2, 3), pose({5, 2, 7}), HalfSpace{}, floor).point -
           Vector3(5, 0, 7))
              .norm() < 1e-14);
    const Quaternion on_edge = turned(Vector3::UnitX(), std::numbers::pi / 4);
    CHECK((detector->overlap(box(1, 1, 1), pose({5, root, 7}, on_edge), HalfSpace{}, floor).point -
           Vector3(5, 0, 7))
              .norm() < 1e-14);
    // Box on box, shifted: the patch is the common area.
    const Overlap flat = detector->overlap(box(1, 1, 1), floor, box(1, 1, 1), pose({1, 2, 0.5}));
    CHECK((flat.point - Vector3(0.5, 1, 0.25)).norm() < 1e-14);
    CHECK((flat.normal - Vector3::UnitY()).norm() < 1e-14);
    const Overlap edge =
        detector->overlap(box(1, 1, 1), floor, box(1, 1, 1), pose({0.5, 1 + root, 0}, on_edge));
    // Common stretch: -0.5 to 1; the edge is found to within the band of 1024 u that counts as
    // lowest.
    CHECK((edge.point - Vector3(0.25, 1, 0)).norm() < 1e-12);
    // Crossed edges.
    const Quaternion crossed = turned(Vector3::UnitZ(), std::numbers::pi / 4);
    const Overlap point = detector->overlap(box(1, 1, 1), pose(zero, on_edge), box(1, 1, 1),
                                            pose({0.1, 2 * root - 1e-3, 0.2}, crossed));
    CHECK(point.gap == Approx(-1e-3).epsilon(1e-10));
    CHECK((point.point - Vector3(0.1, root - 0.5e-3, 0)).norm() < 1e-12);
  }
}

TEST_CASE("detectors that locate find a head-on impact, in every order of shapes",
          "[ccd][contract]") {
  struct Pair {
    Shape a, b;
    double contact;  ///< distance of the origins at contact
  };
  const Pair pairs[] = {{Sphere{0.5}, Sphere{0.5}, 1.0},
                        {Sphere{0.5}, box(0.5, 0.5, 0.5), 1.0},
                        {Sphere{0.5}, HalfSpace{}, 0.5},
                        {box(0.5, 0.5, 0.5), box(0.5, 0.5, 0.5), 1.0},
                        {box(0.5, 0.5, 0.5), HalfSpace{}, 0.5}};
  for (const auto& detector : detectors()) {
    const DetectorInfo info = detector->info();
    CAPTURE(std::string(info.name));
    for (const Pair& pair : pairs) {
      Query q{pair.a, pair.b, moving(pose({0, 3, 0}), {0, -4, 0}), moving(pose(zero), zero), 1.0};
      for (const Query& asked : {q, q.exchanged()}) {
        const TimeOfImpact toi = asked.ask(*detector);
        if (!info.locates) {
          CHECK(toi.status == ToiStatus::separated);
          continue;
        }
        CHECK(toi.status == ToiStatus::impact);
        // Tolerance: 1e-9 of an extent of 1 at 4 m/s.
        CHECK(toi.t_lo == Approx((3 - pair.contact) / 4).margin(1e-9));
        CHECK(toi.t_lo <= toi.t_hi);
        const Vector3 towards_b = asked.motion_b.position(0) - asked.motion_a.position(0);
        CHECK(toi.normal.dot(towards_b.normalized()) == Approx(1.0).epsilon(1e-9));
      }
    }
  }
}

TEST_CASE("what advancement calls separated is separated, and impacts are not late",
          "[ccd][contract]") {
  const auto advancement = ccd::make_conservative_advancement();
  const auto certified = ccd::make_certified();
  for (int d = 0; d < difficulties; ++d) {
    for (const ShapeKinds kinds : shape_kinds) {
      for (std::uint64_t seed = 1000; seed < 1200; ++seed) {
        const Query q = random_query(static_cast<Difficulty>(d), kinds, seed);
        const TimeOfImpact truth = q.ask(*certified);
        const TimeOfImpact toi =
            q.ask(*advancement, 1e-4 * smallest_extent(q.a.index() == 2 ? q.b : q.a));
        if (truth.status == ToiStatus::impact) {
          CHECK(toi.status == ToiStatus::impact);
          CHECK(toi.t_lo <= truth.t_hi);
        }
      }
    }
  }
}

TEST_CASE("what starts in touch and is pressed together meets at once, or at the end of its hop",
          "[ccd][contract]") {
  // A ball of 1 m on a floor, thrown up at v: it is back after 2 v/g, maybe long before a look.
  constexpr double g = 9.8;
  for (const auto& detector : detectors()) {
    if (!detector->info().locates) {
      continue;
    }
    CAPTURE(std::string(detector->info().name));
    for (const double v : {0.0, 1e-3, 0.1, 1.0}) {
      Query q{Sphere{0.5}, HalfSpace{}, moving(pose({0, 0.5, 0}), zero), moving(pose(zero), zero),
              1.0};
      q.motion_a.position =
          Polynomial<3>(Vector3(0, 0.5, 0), Vector3(0, v, 0), Vector3(0, -0.5 * g, 0));
      q.motion_a.velocity = Polynomial<3>(Vector3(0, v, 0), Vector3(0, -g, 0));
      for (const Query& asked : {q, q.exchanged()}) {
        const TimeOfImpact toi = asked.ask(*detector);
        CAPTURE(v, toi.t_lo, toi.t_hi);
        CHECK(toi.status == ToiStatus::impact);
        // A tolerance of 1e-9 m is a way of the ball's speed, or of its fall from rest.
        CHECK(toi.t_lo == Approx(2.0 * v / g).margin(v > 0.0 ? 1e-8 / v : std::sqrt(2e-8 / g)));
      }
    }
  }
}

TEST_CASE("bisection misses a grazed corner, certified does not", "[ccd][contract]") {
  // The ball cuts the corner of a box by 1 mm between two looks.
  const double cut = 1e-3;
  const double side = 0.5 + (0.5 - cut) / std::numbers::sqrt2;
  const Vector3 direction = Vector3(1, -1, 0).normalized();
  Query q{Sphere{0.5}, box(0.5, 0.5, 0.5),
          moving(pose(Vector3(side, side, 0) - 2.13 * direction), 20 * direction),
          moving(pose(zero), zero), 1.0};
  CHECK(q.ask(*ccd::make_certified()).status == ToiStatus::impact);
  CHECK(q.ask(*ccd::make_bisection()).status == ToiStatus::separated);
}

TEST_CASE("what is not a number decides nothing and ends", "[ccd][contract]") {
  const auto certified = ccd::make_certified();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const ShapeKinds kinds : shape_kinds) {
    Query q = random_query(Difficulty::turning, kinds, 1);
    q.motion_a.position[1].x() = nan;
    CHECK(q.ask(*certified).status == ToiStatus::undecided);
  }
}

TEST_CASE("windows may be infinite", "[ccd][contract]") {
  const Motion floor = Motion::at_rest({}, pose(zero));
  const Motion up = Motion::ballistic({}, inf, pose({0, 3, 0}), {{0, 1, 0}, zero}, zero);
  const Motion thrown =
      Motion::ballistic({}, inf, pose({0, 3, 0}), {{0, 1, 0}, {1, 2, 3}}, {0, -9.8, 0});
  const Shape shapes[] = {Sphere{0.5}, box(0.5, 0.4, 0.3)};
  const Shape plane = HalfSpace{};
  const Shape slab = box(50, 1, 50);
  for (const auto& detector : detectors()) {
    if (!detector->info().locates) {
      continue;
    }
    CAPTURE(std::string(detector->info().name));
    for (const Shape& shape : shapes) {
      for (const Shape& ground : {plane, slab}) {
        CHECK(detector->time_of_impact({shape, up}, {ground, floor}, {{}, inf}, 0.0).status ==
              ToiStatus::separated);
        const TimeOfImpact toi =
            detector->time_of_impact({shape, thrown}, {ground, floor}, {{}, inf}, 0.0);
        CHECK(toi.status == ToiStatus::impact);
        CHECK(toi.t_lo < 1.0);
      }
    }
  }
}

TEST_CASE("the end of a contact", "[ccd][contract]") {
  for (const auto& detector : detectors()) {
    CAPTURE(std::string(detector->info().name));
    struct Field {
      Shape body, field;
      double parts_at;  ///< height of the body's origin
    };
    const Field fields[] = {{Sphere{0.1}, box(1, 0.5, 1), 0.6},
                            {Sphere{0.1}, HalfSpace{}, 0.1},
                            {Sphere{0.1}, Sphere{0.5}, 0.6},
                            {box(0.1, 0.1, 0.1), box(1, 0.5, 1), 0.6},
                            {box(0.1, 0.1, 0.1), HalfSpace{}, 0.1}};
    for (const Field& f : fields) {
      Query q{f.body, f.field, moving(pose({0, -0.05, 0}), {0, 1, 0}), moving(pose(zero), zero),
              1.0};
      for (const Query& asked : {q, q.exchanged()}) {
        const TimeOfImpact toi =
            detector->time_of_separation(asked.moving_a(), asked.moving_b(), asked.window(), 0.0);
        REQUIRE(toi.status == ToiStatus::impact);
        CHECK(toi.t_lo <= f.parts_at + 0.05 + 1e-14);
        CHECK(toi.t_hi >= f.parts_at + 0.05 - 1e-14);
        CHECK(toi.t_hi - toi.t_lo < 1e-8);  // tolerance: 1e-9 of the extent over 1 m/s
      }
      q.motion_a = moving(pose({0, -0.05, 0}), {0, 0.1, 0});
      CHECK(detector->time_of_separation(q.moving_a(), q.moving_b(), q.window(), 0.0).status ==
            ToiStatus::overlapping);
      q.motion_a = moving(pose({0, 2, 0}), {0, 0.1, 0});
      CHECK(detector->time_of_separation(q.moving_a(), q.moving_b(), q.window(), 0.0).status ==
            ToiStatus::separated);
      // Entering from touch: it parts later, not now.
      q.motion_a = moving(pose({0, f.parts_at, 0}), {0, -1, 0}, zero, {0, 4, 0});
      const TimeOfImpact entered =
          detector->time_of_separation(q.moving_a(), q.moving_b(), q.window(), 0.0);
      CHECK(entered.status == ToiStatus::impact);
      CHECK(entered.t_hi == Approx(0.5).epsilon(1e-6));  // tolerance over the speed of 1 m/s
    }
  }
}

TEST_CASE("error radii are added to the gap", "[ccd][contract]") {
  const auto certified = ccd::make_certified();
  for (const ShapeKinds kinds : shape_kinds) {
    Random random(5);
    Query q{random_shape(random, kinds.a, 1.0), random_shape(random, kinds.b, 1.0),
            moving(pose({0, 3, 0}), {0, -3, 0}), moving(pose(zero), zero), 1.0};
    const double plain = q.ask(*certified).t_lo;
    q.motion_a.error_radius = 0.01;
    q.motion_b.error_radius = 0.02;
    const TimeOfImpact toi = q.ask(*certified);
    CHECK(toi.status == ToiStatus::impact);
    CHECK(toi.t_lo == Approx(plain - 0.01).epsilon(1e-9));
  }
}

TEST_CASE("no detector misses what sweeps overlap cannot exclude", "[ccd][contract]") {
  const auto certified = ccd::make_certified();
  for (int d = 0; d < difficulties; ++d) {
    for (const ShapeKinds kinds : shape_kinds) {
      for (std::uint64_t seed = 0; seed < 200; ++seed) {
        const Query q = random_query(static_cast<Difficulty>(d), kinds, seed);
        if (q.ask(*certified).status != ToiStatus::separated) {
          CHECK(certified->swept_overlap(q.moving_a(), q.moving_b(), q.window()));
        }
      }
    }
  }
}

TEST_CASE("linear: late or early by the curvature of the gap, blind to what is within a step",
          "[ccd]") {
  const auto linear = ccd::make_linear();
  // A ball of 0.5 m falls from a gap of 1 m under a = -8: contact after 0.5 s; on the straight line
  // between gaps of 1 m and 1 - 4 h^2 it is at h / (4 h^2) = 1/(4 h).
  const auto fall = [&](double h) {
    const Shape ball = Sphere{0.5};
    const Shape floor = HalfSpace{};
    const Motion falling = Motion::ballistic({}, h, pose({0.0, 1.5, 0.0}, Quaternion::Identity()),
                                             {}, {0.0, -8.0, 0.0});
    const Motion resting = Motion::at_rest({}, pose(zero, Quaternion::Identity()));
    return linear->time_of_impact({ball, falling}, {floor, resting}, {{}, h}, 0.0);
  };
  CHECK(fall(0.4).status == ToiStatus::separated);
  for (const double h : {0.6, 0.8, 1.0}) {
    const TimeOfImpact toi = fall(h);
    CHECK(toi.status == ToiStatus::impact);
    CHECK(toi.t_lo == Approx(0.25 / h).epsilon(1e-14));
    CHECK(toi.evaluations == 3);
  }
  // Through a wall of 0.2 m within the window: both ends are apart, and nothing is seen.
  const Shape ball = Sphere{0.1};
  const Shape wall = Box{{0.1, 1.0, 1.0}};
  const Motion bullet = Motion::ballistic({}, 1.0, pose({-5.0, 0.0, 0.0}, Quaternion::Identity()),
                                          {{10.0, 0.0, 0.0}, zero}, zero);
  const Motion resting = Motion::at_rest({}, pose(zero, Quaternion::Identity()));
  CHECK(linear->time_of_impact({ball, bullet}, {wall, resting}, {{}, 1.0}, 0.0).status ==
        ToiStatus::separated);
  CHECK(ccd::make_certified()
            ->time_of_impact({ball, bullet}, {wall, resting}, {{}, 1.0}, 0.0)
            .status == ToiStatus::impact);
  Motion endless = bullet;
  endless.duration = inf;
  CHECK(linear->time_of_impact({ball, endless}, {wall, resting}, {{}, inf}, 0.0).status ==
        ToiStatus::undecided);
}
