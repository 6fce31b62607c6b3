// Two boxes at one instant: all ways to ask agree, and what is proven is true.
#include "ccd/box_batch.hpp"
#include "ccd/nearest_points.hpp"
#include "ccd/pair_overlap.hpp"
#include "ccd/relative_boxes.hpp"
#include "ccd/sine_cosine.hpp"
#include "experiments/accuracy/random_query.hpp"
#include "tests/catch.hpp"

#include <limits>

using namespace kairos;
using namespace kairos::reference;

namespace {

constexpr double u = 0x1p-53;

struct Pair {
  Query query;
  ccd::OrientedBox a, b;
  ccd::RelativeBoxes relative;
};

/// Boxes near each other; `nearly` parallel ones are turned against each other by a tiny angle.
Pair random_pair(Random& random, bool nearly) {
  const Quaternion q_a = random.orientation();
  const Quaternion q_b =
      nearly ? rotate(random.vector(random.log_uniform(1e-16, 1e-2)), q_a) : random.orientation();
  const Pose at_a = pose(random.vector(1.0), q_a);
  const Pose at_b = pose(random.vector(1.5), q_b);
  Pair pair{{box(1, 1, 1), random_shape(random, 1, 1.5), moving(at_a, Vector3::Zero()),
             moving(at_b, Vector3::Zero()), 0.0},
            {},
            {},
            {}};
  const auto oriented = [](const Shape& shape, const Pose& at) {
    return ccd::OrientedBox{at.position, at.orientation.toRotationMatrix(),
                            std::get<Box>(shape).half_extents};
  };
  pair.a = oriented(pair.query.a, at_a);
  pair.b = oriented(pair.query.b, at_b);
  pair.relative =
      ccd::RelativeBoxes(std::get<Box>(pair.query.a), at_a, std::get<Box>(pair.query.b), at_b);
  return pair;
}

}  // namespace

TEST_CASE("verdicts from world poses and from relative poses are true", "[ccd][sat]") {
  Random random(11);
  int undecided = 0;
  for (int i = 0; i < 20000; ++i) {
    const Pair pair = random_pair(random, i % 2 == 0);
    const Real truth = pair.query.separation(0);
    for (const ccd::Verdict verdict :
         {ccd::classify(pair.a, pair.b), ccd::classify(pair.relative)}) {
      const bool lie = (verdict == ccd::Verdict::separated && truth <= 0) ||
                       (verdict == ccd::Verdict::overlapping && truth > 0);
      if (lie) {
        FAIL_CHECK("pair " << i);
      }
      undecided += verdict == ccd::Verdict::undecided ? 1 : 0;
    }
  }
  CHECK(undecided == 0);  // none of these is within 1e-14 of touching
}

TEST_CASE("the greatest separation is the greatest of the fifteen", "[ccd][sat]") {
  Random random(12);
  for (int i = 0; i < 5000; ++i) {
    const Pair pair = random_pair(random, i % 2 == 0);
    const ccd::AxisSeparation best = ccd::greatest_separation(pair.relative);
    for (int axis = 0; axis < ccd::axis_count; ++axis) {
      const ccd::AxisSeparation other = ccd::axis_separation(pair.relative, axis);
      // Noise over a small sine does not compete: edges count less their rounding.
      const double lowered = axis < 6 ? other.value : other.value - pair.relative.error();
      if (lowered > 1e-12 * other.length + best.gap() * other.length) {  // roundoff of sizes of 3
        FAIL_CHECK("pair " << i << " axis " << axis);
      }
    }
    const ccd::AxisSeparation again = ccd::axis_separation(pair.relative, best.axis);
    CHECK(again.value == Approx(best.value).margin(16 * u));
    CHECK(again.length == Approx(best.length).margin(4 * u));
    CHECK(again.sign == best.sign);
  }
}

/// Of the fifteen axes, in long double, in the frame of a: there the product of two edges that are
/// nearly parallel is at a right angle to that of a.
double exact_gap(const Vector3& half_a, const Pose& at_a, const Vector3& half_b, const Pose& at_b) {
  using Vector = Eigen::Matrix<Real, 3, 1>;
  const auto to_a = at_a.orientation.cast<Real>().normalized().conjugate();
  const Eigen::Matrix<Real, 3, 3> b =
      (to_a * at_b.orientation.cast<Real>().normalized()).toRotationMatrix();
  const Vector d = to_a * Vector(at_b.position.cast<Real>() - at_a.position.cast<Real>());
  Real greatest = -std::numeric_limits<Real>::infinity();
  const auto look = [&](const Vector& axis) {
    if (axis.norm() > 0) {
      const Vector n = axis.normalized();
      const Real reach = half_a.cast<Real>().dot(n.cwiseAbs()) +
                         half_b.cast<Real>().dot((b.transpose() * n).cwiseAbs());
      greatest = std::max(greatest, std::abs(n.dot(d)) - reach);
    }
  };
  for (int i = 0; i < 3; ++i) {
    look(Vector::Unit(i));
    look(b.col(i));
    for (int j = 0; j < 3; ++j) {
      look(Vector::Unit(i).cross(b.col(j)));
    }
  }
  return static_cast<double>(greatest);
}

TEST_CASE("a gap between edges is told as exactly as any, however nearly parallel they are",
          "[ccd][sat]") {
  Random random(14);
  int apart = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vector3 half_a(0.3, 0.2, random.uniform(0.2, 1.0));
    const Vector3 half_b(0.25, 0.35, random.uniform(0.2, 1.0));
    // In the frame of a, whose corner (x, y) looks along n; that of b looks back.
    const double along = random.uniform(0.2, 1.3);
    const Vector3 n(std::cos(along), std::sin(along), 0.0);
    const double sine = random.log_uniform(1e-12, 1e-1);
    const Quaternion turned =
        rotate(n * sine, rotate(Vector3::UnitZ() * (along + random.uniform(-0.6, 0.6) + M_PI - 0.7),
                                Quaternion::Identity()));
    const double gap = random.log_uniform(1e-13, 1e-8) * (i % 2 == 0 ? 1.0 : -1.0);
    const Vector3 corner_a(half_a.x(), half_a.y(), 0.0);
    const Vector3 corner_b(half_b.x(), half_b.y(), 0.0);
    const Quaternion q = random.orientation();
    const Pose at_a = pose(random.vector(1.0), q);
    const Pose at_b =
        pose(at_a.position + q * Vector3(corner_a + gap * n - turned * corner_b), q * turned);
    const double exact = exact_gap(half_a, at_a, half_b, at_b);
    const Overlap told = ccd::measure_overlap(box(half_a.x(), half_a.y(), half_a.z()), at_a,
                                              box(half_b.x(), half_b.y(), half_b.z()), at_b);
    // Rounding of a separation is 24 u of a size of 3. The two points put together are no farther
    // apart than the gap.
    const double rounding = 72.0 * u;
    INFO("pair " << i << ", sine " << sine << ", gap " << gap << ", exact " << exact << ", told "
                 << told.gap);
    CHECK(told.gap > exact - rounding);
    CHECK(told.gap < std::max(exact, std::abs(gap)) + rounding);
    CHECK((exact > 0.0 || told.gap < exact + rounding));
    CHECK((exact < rounding || !told.overlapping));
    apart += exact > 0.0 ? 1 : 0;
  }
  CHECK(apart > 1000);  // and not all overlap
}

TEST_CASE("a cached axis separates as long as it does, and is replaced when it does not",
          "[ccd][sat]") {
  Random random(13);
  int separated = 0;
  for (int i = 0; i < 2000; ++i) {
    const Pair pair = random_pair(random, false);
    int axis = ccd::axis_count - 1;
    const ccd::Verdict first = ccd::classify(pair.relative, axis);
    CHECK(first == ccd::classify(pair.relative));
    if (first != ccd::Verdict::separated) {
      continue;
    }
    CHECK(ccd::axis_separation(pair.relative, axis).value > pair.relative.error());
    // A little further apart: the same axis still does.
    ccd::RelativeBoxes further = pair.relative;
    further.d_A *= 1.0 + 1e-3;
    const int before = axis;
    CHECK(ccd::classify(further, axis) == ccd::Verdict::separated);
    CHECK(axis == before);
    ++separated;
  }
  CHECK(separated > 200);
}

TEST_CASE("many pairs of boxes at once give the bits of one", "[ccd][sat][batch]") {
  Random random(14);
  std::vector<ccd::RelativeBoxes> pairs;
  for (int i = 0; i < 20'001; ++i) {  // no multiple of what is looked at at once
    ccd::RelativeBoxes boxes = random_pair(random, i % 2 == 0).relative;
    if (i % 7 == 0) {  // exactly parallel, a face on a face, or a box that is none
      boxes.axes_A.setIdentity();
      boxes.d_A[0] = boxes.half_a[0] + boxes.half_b[0];
    }
    if (i % 11 == 0) {
      boxes.d_A.setZero();
      boxes.half_b.setZero();
    }
    pairs.push_back(boxes);
  }
  ccd::BoxBatch batch;
  batch.push_back(pairs.back());
  batch.clear();
  for (const ccd::RelativeBoxes& boxes : pairs) {
    batch.push_back(boxes);
  }
  std::vector<ccd::Verdict> verdicts(pairs.size());
  std::vector<ccd::AxisSeparation> separations(pairs.size());
  std::vector<double> errors(pairs.size());
  ccd::classify_batch(batch, verdicts);
  ccd::greatest_separation_batch(batch, separations, errors);
  int verdict[3] = {0, 0, 0};
  int edges = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const ccd::AxisSeparation one = ccd::greatest_separation(pairs[i]);
    const ccd::AxisSeparation& of_many = separations[i];
    if (verdicts[i] != ccd::classify(pairs[i]) || of_many.axis != one.axis ||
        of_many.value != one.value || of_many.length != one.length || of_many.sign != one.sign) {
      FAIL_CHECK("pair " << i << ": axis " << of_many.axis << " " << of_many.value << ", not "
                         << one.axis << " " << one.value);
    }
    CHECK(errors[i] == Approx(pairs[i].error()).epsilon(8 * u));  // another order of the same sum
    ++verdict[static_cast<int>(verdicts[i])];
    edges += one.axis >= 6 ? 1 : 0;
  }
  CHECK(verdict[0] > 1000);  // otherwise the pairs show nothing
  CHECK(verdict[1] > 1000);
  CHECK(verdict[2] > 1000);
  CHECK(edges > 1000);
  CHECK_THROWS_AS(ccd::classify_batch(batch, std::span(verdicts).first(3)), std::invalid_argument);
}

TEST_CASE("sine and cosine are right to 3 u", "[ccd]") {
  for (int i = -15000; i <= 15000; ++i) {
    const double x = i * 1e-4 * (1.0 - 1e-9);
    double sine = 0.0;
    double cosine = 0.0;
    ccd::sine_cosine(x, sine, cosine);
    if (std::abs(sine - std::sin(Real(x))) > 3 * Real(u) ||
        std::abs(cosine - std::cos(Real(x))) > 3 * Real(u)) {
      FAIL_CHECK(x);
    }
  }
}

TEST_CASE("nearest points of boxes are those of all their corners and pairs of edges",
          "[ccd][sat]") {
  // Edges that are left out change no bit.
  Random random(20261124);
  for (int k = 0; k < 20000; ++k) {
    CAPTURE(k);
    ccd::RelativeBoxes s = random_pair(random, k % 2 == 0).relative;
    if (k % 4 == 0) {  // one on the other, apart by as little as a hop
      s.d_A.y() = s.half_a.y() + s.half_b.y() + random.log_uniform(1e-16, 1e-6);
    }
    ccd::NearestPoints best;
    best.distance = std::numeric_limits<double>::infinity();
    const auto keep = [&best](const Vector3& on_a, const Vector3& on_b, double distance) {
      if (distance < best.distance) {
        best = {on_a, on_b, distance};
      }
    };
    const auto clamped = [](const Vector3& x, const Vector3& half) -> Vector3 {
      return x.cwiseMax(-half).cwiseMin(half);
    };
    for (int c = 0; c < 8; ++c) {
      const Vector3 corner_b = s.d_A + s.axes_A * ccd::box_corner(s.half_b, c);
      const Vector3 below = clamped(corner_b, s.half_a);
      keep(below, corner_b, (corner_b - below).norm());
      const Vector3 corner_a = ccd::box_corner(s.half_a, c);
      const Vector3 above =
          s.d_A + s.axes_A * clamped(s.axes_A.transpose() * (corner_a - s.d_A), s.half_b);
      keep(corner_a, above, (above - corner_a).norm());
    }
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        for (int c = 0; c < 16; ++c) {
          const ccd::NearestPoints edges = ccd::nearest_of_segments(
              ccd::edge_centre(s.half_a, i, c & 3), Vector3::Unit(i), s.half_a[i],
              s.d_A + s.axes_A * ccd::edge_centre(s.half_b, j, c >> 2), s.axes_A.col(j),
              s.half_b[j]);
          keep(edges.on_a, edges.on_b, edges.distance);
        }
      }
    }
    const ccd::NearestPoints found = ccd::nearest_of_boxes(s);
    REQUIRE(found.distance == best.distance);
    REQUIRE(found.on_a == best.on_a);
    REQUIRE(found.on_b == best.on_b);
  }
}
