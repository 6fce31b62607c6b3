// How long two bodies in touch are known to stay apart, against where they are at many times.

#include "core/contacts/separation_watch.hpp"

#include "core/random.hpp"
#include "tests/catch.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

using namespace kairos;

namespace {

constexpr double nearest = 1e-9;
constexpr double duration = 1e-3;

Vector3 any(Random& random, double size) {
  return size *
         Vector3(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
}

TouchFeature ball(double radius) {
  return {TouchFeature::Kind::ball, Vector3::Zero(), Vector3::Zero(), radius};
}

/// Two balls `nearest` apart that move as a cubic each; nothing holds them.
struct TwoBalls {
  explicit TwoBalls(Random& random) {
    pair.a = 0;
    pair.b = 1;
    pair.nearest = nearest;
    pair.corners_a = {ball(random.uniform(0.01, 1.0))};
    pair.corners_b = {ball(random.uniform(0.01, 1.0))};
    const Vector3 towards = any(random, 1.0).normalized();
    Pose at;
    motion_a = Motion::at_rest({}, at);
    at.position = (pair.corners_a[0].radius + pair.corners_b[0].radius + nearest) * towards;
    motion_b = Motion::at_rest({}, at);
    for (Motion* const motion : {&motion_a, &motion_b}) {
      motion->duration = duration;
      motion->position.resize(3);
      motion->position[1] = any(random, std::pow(10.0, random.uniform(-9.0, -6.0)));
      motion->position[2] = any(random, std::pow(10.0, random.uniform(-5.0, 0.0)));
      motion->position[3] = any(random, std::pow(10.0, random.uniform(-3.0, 2.0)));
    }
    touch.b = 1;
    touch.on_a = pair.corners_a[0];
    touch.on_b = pair.corners_b[0];
    touch.normal = towards;
  }

  [[nodiscard]] double gap(double s) const {
    return static_cast<double>(
        (motion_b.position(s).cast<long double>() - motion_a.position(s).cast<long double>())
            .norm() -
        pair.corners_a[0].radius - pair.corners_b[0].radius);
  }

  TurningPair pair;
  Motion motion_a;
  Motion motion_b;
  Touch touch;
};

/// How far two boxes are apart along the axis that separates them most; by the fifteen axes, in
/// long double.
long double gap_of_boxes(const Vector3& half_a, const Pose& a, const Vector3& half_b,
                         const Pose& b) {
  using Vector = Eigen::Matrix<long double, 3, 1>;
  const auto axis = [](const Pose& pose, int k) {
    return Vector(pose.orientation.cast<long double>().normalized() * Vector(Vector::Unit(k)));
  };
  const Vector d = b.position.cast<long double>() - a.position.cast<long double>();
  long double most = -1.0L;
  const auto look = [&](const Vector& along) {
    if (along.norm() < 1e-6L) {
      return;
    }
    const Vector n = along.normalized();
    long double reach = 0.0L;
    for (int k = 0; k < 3; ++k) {
      reach += std::abs(n.dot(axis(a, k))) * static_cast<long double>(half_a[k]) +
               std::abs(n.dot(axis(b, k))) * static_cast<long double>(half_b[k]);
    }
    most = std::max(most, std::abs(n.dot(d)) - reach);
  };
  for (int i = 0; i < 3; ++i) {
    look(axis(a, i));
    look(axis(b, i));
    for (int j = 0; j < 3; ++j) {
      look(axis(a, i).cross(axis(b, j)));
    }
  }
  return most;
}

/// Two boxes whose edges cross at a rim of each, `nearest` apart, one above the other and tilted
/// from it by a little, so that corners of one come below the top of the other, beside it. They go
/// round where the edges cross.
struct CrossedBoxes {
  explicit CrossedBoxes(Random& random) {
    pair.a = 0;
    pair.b = 1;
    pair.nearest = nearest;
    const Box a{Vector3(0.2, 0.1, 0.3)};
    const Box b{Vector3(0.25, 0.15, 0.2)};
    half_a = a.half_extents;
    half_b = b.half_extents;
    pair.corners_a = *corners_of(a);
    pair.corners_b = *corners_of(b);
    // The rim of a at its right goes along z; that of b at its back along x.
    touch.b = 1;
    touch.on_a = {TouchFeature::Kind::line, half_a, Vector3::UnitZ(), 0.0};
    touch.on_b = {TouchFeature::Kind::line, -half_b, Vector3::UnitX(), 0.0};
    touch.normal = Vector3::UnitY();
    const auto tilted = [&] {
      const Vector3 way = any(random, std::pow(10.0, random.uniform(-10.0, -7.0)));
      return Quaternion(1.0, way.x(), way.y(), way.z()).normalized();
    };
    Pose at_a;
    at_a.orientation = tilted();
    Pose at_b;
    at_b.orientation = tilted();
    const Vector3 edge_a(half_a.x(), half_a.y(), random.uniform(-0.9, 0.9) * half_a.z());
    const Vector3 edge_b(random.uniform(-0.9, 0.9) * half_b.x(), -half_b.y(), -half_b.z());
    const Vector3 n = (at_b.orientation * Vector3::UnitX())
                          .cross(at_a.orientation * Vector3::UnitZ())
                          .normalized();
    const Vector3 up = n.y() < 0.0 ? Vector3(-n) : n;
    at_b.position = at_a.to_world(edge_a) + nearest * up - at_b.orientation * edge_b;
    motion_a = Motion::at_rest({}, at_a);
    motion_b = Motion::at_rest({}, at_b);
    motion_b.duration = duration;
    motion_b.position.resize(1);
    motion_b.position[1] = any(random, std::pow(10.0, random.uniform(-12.0, -6.0)));
    motion_b.position[1] -= up * up.dot(motion_b.position[1]);  // the gap is held
  }

  [[nodiscard]] long double apart(double s) const {
    return gap_of_boxes(half_a, motion_a.pose(s), half_b, motion_b.pose(s));
  }

  TurningPair pair;
  Vector3 half_a;
  Vector3 half_b;
  Motion motion_a;
  Motion motion_b;
  Touch touch;
};

/// Two boxes anywhere beside each other, `gap` apart, that move and turn; the one plane that is
/// known is of a face that does not separate them.
struct BoxesBeside {
  BoxesBeside(Random& random, double gap) {
    pair.a = 0;
    pair.b = 1;
    pair.nearest = nearest;
    const auto any_half = [&] {
      return Vector3(random.uniform(0.1, 1.0), random.uniform(0.1, 1.0), random.uniform(0.1, 1.0));
    };
    half_a = any_half();
    half_b = any_half();
    shape_a = Box{half_a};
    shape_b = Box{half_b};
    pair.shape_a = &shape_a;
    pair.shape_b = &shape_b;
    pair.corners_a = *corners_of(shape_a);
    pair.corners_b = *corners_of(shape_b);
    const auto any_turn = [&](double size) {
      const Vector3 way = any(random, size);
      return Quaternion(1.0, way.x(), way.y(), way.z()).normalized();
    };
    // Some nearly as the other, so that edges are nearly parallel.
    Pose a;
    a.orientation = any_turn(2.0);
    Pose b;
    b.orientation = a.orientation * any_turn(std::pow(10.0, random.uniform(-6.0, 0.5)));
    const Vector3 way = any(random, 1.0).normalized();
    double low = 0.0;
    double high = 10.0;
    for (int k = 0; k < 100; ++k) {
      b.position = 0.5 * (low + high) * way;
      (gap_of_boxes(half_a, a, half_b, b) < static_cast<long double>(gap) ? low : high) =
          b.position.norm();
    }
    pair.planes_b = {faces_of(shape_b)[0]};
    if (((a.position - b.position).dot(b.orientation * pair.planes_b[0].direction)) > 0.0) {
      pair.planes_b = {faces_of(shape_b)[1]};  // away from a
    }
    motion_a = Motion::at_rest({}, a);
    motion_b = Motion::at_rest({}, b);
    for (Motion* const motion : {&motion_a, &motion_b}) {
      motion->duration = duration;
      motion->position.resize(2);
      motion->position[1] = any(random, std::pow(10.0, random.uniform(-8.0, 0.0)));
      motion->position[2] = any(random, std::pow(10.0, random.uniform(-3.0, 2.0)));
      motion->rotation = RotationKind::constant_rate;
      motion->rotation_rate = any(random, std::pow(10.0, random.uniform(-6.0, 2.0)));
    }
  }

  [[nodiscard]] long double apart(double s) const {
    return gap_of_boxes(half_a, motion_a.pose(s), half_b, motion_b.pose(s));
  }

  TurningPair pair;
  Shape shape_a;
  Shape shape_b;
  Vector3 half_a;
  Vector3 half_b;
  Motion motion_a;
  Motion motion_b;
};

}  // namespace

TEST_CASE("separation watch: boxes whose edges cross are apart as long as that is known",
          "[turning]") {
  const std::uint64_t seed = 20261124;
  INFO("seed " << seed);
  Random random(seed);
  int all = 0;
  int none = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    CAPTURE(trial);
    const CrossedBoxes boxes(random);
    const SeparationWatch watch{boxes.pair, boxes.motion_a, boxes.motion_b, {boxes.touch}, {}};
    const double until = watch.strike_time(duration);
    long double least = 1.0L;
    for (int k = 0; k <= 100 && until > 0.0; ++k) {
      least = std::min(least, boxes.apart(until * k / 100.0));
    }
    CHECK(least > 0.0L);
    all += until == duration ? 1 : 0;
    none += until == 0.0 ? 1 : 0;
  }
  // Both what is known at once and what is not are asked about.
  CHECK(all > 100);
  CHECK(none > 100);
}

TEST_CASE("separation watch: where the plane that touches tells nothing, another is found",
          "[turning][slow]") {
  const std::uint64_t seed = 20261126;
  INFO("seed " << seed);
  Random random(seed);
  int some = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    CAPTURE(trial);
    const double gap = std::pow(10.0, random.uniform(-9.0, -3.0));
    const BoxesBeside boxes(random, gap);
    SeparationWatch watch{boxes.pair, boxes.motion_a, boxes.motion_b, {}, {}};
    const double until = watch.strike_time(duration);
    long double least = 1.0L;
    for (int k = 0; k <= 100 && until > 0.0; ++k) {
      least = std::min(least, boxes.apart(until * k / 100.0));
    }
    CHECK(least > 0.0L);
    some += until > 0.0 ? 1 : 0;
  }
  // Without another plane there is none; edges that may become parallel in the step are left out.
  CHECK(some > 3000);
}

TEST_CASE("separation watch: across edges that are nearly parallel", "[turning]") {
  // Edges along x that cross at an angle of 1e-8: no face separates the two, and the plane across
  // both edges would turn with them.
  const Box box{Vector3(0.5, 0.5, 0.5)};
  const Shape shape = box;
  const Vector3 n = Vector3(0.0, 1.0, 1.0).normalized();
  const Vector3 meet(0.1, 0.5, 0.5);
  const Quaternion turned(Eigen::AngleAxisd(1e-8, n));
  for (const double gap : {1e-12, 1e-10}) {
    CAPTURE(gap);
    Pose at_b;
    at_b.orientation = turned;
    at_b.position = meet + gap * n + turned * (Vector3(0.0, 0.5, 0.5) - Vector3(0.1, 0.0, 0.0));
    TurningPair pair{0, 1, *corners_of(shape), *corners_of(shape), {}, {}, gap, &shape, &shape};
    const auto until = [&] {
      return SeparationWatch{pair, Motion::at_rest({}, {}), Motion::at_rest({}, at_b), {}, {}}
          .strike_time(duration);
    };
    CHECK(until() == 0.0);
    pair.apart = n;
    CHECK(until() == duration);
    // What a detector tells is a proposal: no plane across it is, and none is believed.
    pair.apart = Vector3::UnitX();
    CHECK(until() == 0.0);
  }
}

TEST_CASE(
    "separation watch: a corner beyond the rim that comes to the plane of the face is no strike",
    "[turning]") {
  // A box hangs over the rim of a face by d, tilted so that its corner there is `above` the plane,
  // and goes below; over the rim it stays d times the tilt away.
  const double overhang = 0.05;
  const Box a{Vector3(0.2, 0.1, 0.3)};
  const Box b{Vector3(0.25, 0.15, 0.2)};
  const Shape shape_a = a;
  const Shape shape_b = b;
  for (const double above : {-1e-12, 0.0, 1e-16, 1e-14}) {
    for (const double tilt : {2e-8, 1e-6, 1e-4}) {
      CAPTURE(above, tilt);
      TurningPair pair{
          0, 1, *corners_of(shape_a), *corners_of(shape_b), {}, {}, nearest, &shape_a, &shape_b};
      pair.planes_a = {{TouchFeature::Kind::plane, a.half_extents, Vector3::UnitY(), 0.0}};
      Pose at_b;
      at_b.orientation = Quaternion(1.0, 0.0, 0.0, -0.5 * tilt).normalized();
      const Vector3 corner(b.half_extents.x(), -b.half_extents.y(), 0.0);
      at_b.position = Vector3(a.half_extents.x() + overhang, a.half_extents.y() + above, 0.0) -
                      at_b.orientation * corner;
      Motion falls = Motion::at_rest({}, at_b);
      falls.duration = duration;
      falls.position.resize(1);
      falls.position[1] = Vector3(0.0, -1e-9, 0.0);  // 1e-12 m in all
      const SeparationWatch watch{pair, Motion::at_rest({}, Pose{}), falls, {}, {}};
      CHECK(watch.strike_time(duration) == duration);
      CHECK(gap_of_boxes(a.half_extents, Pose{}, b.half_extents, falls.pose(duration)) > 0.0L);
    }
  }
}

TEST_CASE("separation watch: of two balls that nothing holds none comes nearer than it may",
          "[turning]") {
  const std::uint64_t seed = 20261124;
  INFO("seed " << seed);
  Random random(seed);
  int all = 0;
  int cut = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    CAPTURE(trial);
    const TwoBalls balls(random);
    const SeparationWatch watch{balls.pair, balls.motion_a, balls.motion_b, {}, {balls.touch}};
    const double until = watch.strike_time(duration);
    double least = nearest;
    for (int k = 0; k <= 1000; ++k) {
      least = std::min(least, balls.gap(until * k / 1000.0));
    }
    // Centres of some metres are known to 1e-15 m: a part of 1e-6 of the gap.
    CHECK(least > (watch.least - 1e-5) * nearest);
    if (until == duration) {
      ++all;
      continue;
    }
    // It is no excuse for a step without length: what ends it is near, or comes.
    ++cut;
    const double past = until + 1e-6 * duration;
    CHECK(std::min(balls.gap(past), balls.gap(until)) < (watch.least + 1e-3) * nearest);
  }
  CHECK(all > 100);
  CHECK(cut > 100);
}
