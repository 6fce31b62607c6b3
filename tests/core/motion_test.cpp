// Motion: what it says at an instant, and that its bounds hold.
#include "core/motion.hpp"

#include "core/bent_motion.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <limits>
#include <numbers>

using namespace kairos;

namespace {

/// Counter-based random numbers in [-1, 1] (SplitMix64).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double operator()() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ull);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
  }

 private:
  std::uint64_t state_;
};

Motion random_motion(std::uint64_t seed, int degree) {
  Random random(seed);
  Motion motion;
  motion.duration = 1.0;
  motion.position.resize(degree);
  motion.rotation = RotationKind::polynomial;
  motion.quaternion.resize(4);
  for (int k = 0; k <= degree; ++k) {
    motion.position[k] = Vector3(random(), random(), random());
  }
  for (int k = 1; k <= 4; ++k) {
    motion.quaternion[k] = 0.3 * Vector4(random(), random(), random(), random());
  }
  motion.velocity = motion.position.differentiated();
  return motion;
}

double angle_between(const Quaternion& p, const Quaternion& q) {
  return 2.0 * std::atan2((p.conjugate() * q).vec().norm(), std::abs((p.conjugate() * q).w()));
}

/// The rate at which a motion turns, of its quaternions: w = 2 q' q* / |q|^2.
Vector3 turns_at(const Motion& motion, double s) {
  const auto quaternion = [](const Vector4& q) { return Quaternion(q[0], q[1], q[2], q[3]); };
  const Vector4 q = motion.quaternion(s);
  return 2.0 * (quaternion(motion.quaternion.derivative(s)) * quaternion(q).conjugate()).vec() /
         q.squaredNorm();
}

}  // namespace

TEST_CASE("a ballistic motion starts at the state, bit for bit", "[core][motion]") {
  const Pose pose{{0.1, 0.2, 0.3}, rotate({0.3, -0.4, 0.5}, Quaternion::Identity())};
  const Twist twist{{1.1, -2.3, 0.7}, {3.0, 1.0, -2.0}};
  const Motion motion = Motion::ballistic({1.0, 0.0}, 2.0, pose, twist, {0.0, -9.81, 0.0});
  CHECK(motion.pose(0.0).position == pose.position);
  CHECK(motion.pose(0.0).orientation.coeffs() == pose.orientation.coeffs());
  CHECK(motion.twist(0.0).linear == twist.linear);
  CHECK(motion.twist(0.0).angular == twist.angular);
  CHECK(motion.acceleration(1.0) == Vector3(0.0, -9.81, 0.0));
  CHECK(motion.end() == Instant{3.0, 0.0});
  const Vector3 expected = pose.position + twist.linear * 2.0 - Vector3(0.0, 0.5 * 9.81 * 4.0, 0.0);
  CHECK((motion.pose(2.0).position - expected).norm() < 1e-14);  // 16 u of 19 m
}

TEST_CASE("a body at rest stays, for ever", "[core][motion]") {
  const Motion motion = Motion::at_rest({}, {{1, 2, 3}, Quaternion::Identity()});
  const double inf = std::numeric_limits<double>::infinity();
  CHECK(motion.duration == inf);
  CHECK(motion.pose(inf).position == Vector3(1, 2, 3));
  CHECK(motion.displacement_bound(0.0, inf) == 0.0);
  CHECK(motion.speed_bound(0.0, inf) == 0.0);
  CHECK(motion.angular_speed_bound(0.0, inf) == 0.0);
  CHECK(motion.twist(1e9).linear == Vector3::Zero());
}

TEST_CASE("a constant rate does not wear out: 6.4e4 turns later", "[core][motion]") {
  // The axis is not a unit vector of the grid, so |w| is irrational; after a whole number of turns
  // of the exact rate the body is back. The period is rounded to u, hence the angle to u * angle.
  const Vector3 w(1.0, 2.0, -1.5);
  const Motion motion = Motion::ballistic({}, 1e6, Pose{}, {Vector3::Zero(), w}, Vector3::Zero());
  const long double rate = std::sqrt(1.0L + 4.0L + 2.25L);
  const double s = static_cast<double>(4.0e5L / rate);
  const long double half = rate * static_cast<long double>(s) / 2.0L;
  const Quaternion q = motion.orientation(s);
  CHECK(std::abs(q.w() - static_cast<double>(std::cos(half))) < 1e-15);  // a few u, no 4e5 u
  CHECK(std::abs(q.norm() - 1.0) < 1e-15);
}

TEST_CASE("a shifted motion is the same motion seen later", "[core][motion]") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Motion motion = random_motion(seed, 6);
    motion.angular_velocity.resize(3);
    const Motion later = motion.shifted(0.4);
    CHECK(later.duration == 0.6);
    CHECK(later.position(0.0) == motion.position(0.4));                  // bit for bit
    CHECK((later.position(0.5) - motion.position(0.9)).norm() < 1e-13);  // 100 u of sizes of 10
    CHECK(angle_between(later.orientation(0.5), motion.orientation(0.9)) < 1e-14);
    CHECK((later.velocity(0.5) - motion.velocity(0.9)).norm() < 1e-12);
  }
  const Motion turning = Motion::ballistic({}, 9.0, Pose{}, {{1, 0, 0}, {0, 2, 1}}, {0, -1, 0});
  CHECK(angle_between(turning.shifted(3.0).orientation(2.0), turning.orientation(5.0)) < 1e-14);
}

TEST_CASE("bounds of speed, displacement and turning hold and are not idle", "[core][motion]") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Motion motion = random_motion(seed, 1 + static_cast<int>(seed % 13));
    const double s0 = 0.3;
    const double s1 = seed % 2 == 0 ? 0.35 : 1.0;
    const double speed = motion.speed_bound(s0, s1);
    const double displacement = motion.displacement_bound(s0, s1);
    const double turning = motion.angular_speed_bound(s0, s1);
    double fastest = 0.0;
    double furthest = 0.0;
    double turned_fastest = 0.0;
    constexpr int samples = 400;
    for (int i = 0; i <= samples; ++i) {
      const double s = s0 + (s1 - s0) * i / samples;
      fastest = std::max(fastest, motion.position.derivative(s).norm());
      furthest = std::max(furthest, (motion.position(s) - motion.position(s0)).norm());
      if (i > 0) {
        const double before = s0 + (s1 - s0) * (i - 1) / samples;
        turned_fastest = std::max(
            turned_fastest,
            angle_between(motion.orientation(before), motion.orientation(s)) / (s - before));
      }
    }
    CHECK(fastest <= speed);
    CHECK(furthest <= displacement * (1.0 + 1e-12));
    CHECK(turned_fastest <= turning * (1.0 + 1e-9));  // a difference quotient of angles of 1e-3
    if (s1 < 0.5) {  // short pieces: the hull is close to the curve
      CHECK(speed < 1.5 * fastest);
      CHECK(displacement < 1.5 * furthest);
    }
  }
}

TEST_CASE("the angular speed is unbounded where the quaternion may vanish", "[core][motion]") {
  Motion motion;
  motion.rotation = RotationKind::polynomial;
  motion.quaternion = Polynomial<4>(Vector4(1, 0, 0, 0), Vector4(-2, 0, 0, 0));
  CHECK(std::isinf(motion.angular_speed_bound(0.0, 1.0)));
  CHECK(motion.angular_speed_bound(0.0, 0.25) < 10.0);
}

TEST_CASE("Bernstein coefficients: ends, hull and a known cubic", "[core][motion]") {
  const Polynomial<3> cubic(Vector3(1, 0, 0), Vector3(0, 3, 0), Vector3(0, 0, 3), Vector3(1, 1, 1));
  std::array<Polynomial<3>::Value, Polynomial<3>::max_degree + 1> b;
  bernstein(cubic, 0.0, 1.0, b);
  // b_j = sum_k C(j, k) / C(3, k) c_k.
  CHECK(b[0] == Vector3(1, 0, 0));
  CHECK(b[1] == Vector3(1, 1, 0));
  CHECK(b[2] == Vector3(1, 2, 1));
  CHECK(b[3] == Vector3(2, 4, 4));
  bernstein(cubic, 0.5, 2.0, b);
  CHECK((b[0] - cubic(0.5)).norm() < 1e-15);
  CHECK((b[3] - cubic(2.0)).norm() < 1e-14);
}

TEST_CASE("rotate turns by the rotation vector in the world", "[core][pose]") {
  const double pi = std::numbers::pi;
  const Quaternion q = rotate({0, 0, pi / 2}, Quaternion::Identity());
  CHECK((q * Vector3::UnitX() - Vector3::UnitY()).norm() < 1e-15);
  const Quaternion then = rotate({pi / 2, 0, 0}, q);  // world axes: y goes to z
  CHECK((then * Vector3::UnitX() - Vector3::UnitZ()).norm() < 1e-15);
  CHECK(rotate(Vector3::Zero(), q).coeffs() == q.coeffs());
  CHECK(rotate({1e-200, 0, 0}, Quaternion::Identity()).x() == 0.5e-200);
}

TEST_CASE("a bent motion begins and ends at the states, and changes there as they say",
          "[core][motion]") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    constexpr double h = 0.7;
    Motion motion = random_motion(seed, 4);
    Random random(seed + 100);
    const auto near = [&](double s) {
      const auto off = [&] { return Vector3(0.1 * Vector3(random(), random(), random())); };
      const Pose pose = motion.pose(s);
      const Twist twist = motion.twist(s);
      return BodyState{{pose.position + off(), rotate(off(), pose.orientation)},
                       {twist.linear + off(), twist.angular + off()}};
    };
    const BodyState before = near(0.0);
    const BodyState after = near(h);
    bend_to(motion, h, before, after);
    for (const auto& [s, state] : {std::pair{0.0, before}, {h, after}}) {
      // A few roundoffs of polynomials whose coefficients are at most 100.
      constexpr double rounded = 1e-13;
      CHECK((motion.pose(s).position - state.pose.position).norm() <= rounded);
      CHECK(angle_between(motion.pose(s).orientation, state.pose.orientation) <= rounded);
      CHECK((motion.position.derivative(s) - state.twist.linear).norm() <= rounded);
      CHECK((turns_at(motion, s) - state.twist.angular).norm() <= rounded);
      CHECK((motion.twist(s).linear - state.twist.linear).norm() <= rounded);
      CHECK((motion.twist(s).angular - state.twist.angular).norm() <= rounded);
    }
  }
}
