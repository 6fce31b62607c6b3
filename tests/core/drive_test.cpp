#include "core/drive.hpp"

#include "core/drives/sinusoid.hpp"
#include "core/drives/track.hpp"
#include "core/random.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <limits>
#include <numbers>

using namespace kairos;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double eps = std::numeric_limits<double>::epsilon();

TrackSample sample(double t, const Vector3& p, const Vector3& turn = Vector3::Zero()) {
  return {t, {p, rotate(turn, Quaternion::Identity()).normalized()}};
}

/// The phase 2 pi f t, whole turns taken out: every product of halves is exact in long double.
long double phase(double frequency, Instant t) {
  const double frequency_high = static_cast<double>(static_cast<float>(frequency));
  const double time_high = static_cast<double>(static_cast<float>(t.seconds));
  long double turns = static_cast<long double>(frequency) * t.correction;
  for (const double f : {frequency_high, frequency - frequency_high}) {
    for (const double s : {time_high, t.seconds - time_high}) {
      const long double product = static_cast<long double>(f) * s;
      turns += product - std::floor(product);
    }
  }
  return 2.0L * std::numbers::pi_v<long double> * turns;
}

double turned_apart(const Quaternion& a, const Quaternion& b) {
  return 2.0 * std::atan2((a * b.conjugate()).vec().norm(), std::abs((a * b.conjugate()).w()));
}

}  // namespace

TEST_CASE("sinusoid: the error radius holds everywhere, also after 1e6 s", "[drive]") {
  const std::uint64_t seed = 3;
  CAPTURE(seed);
  Random random(seed);
  for (const double epoch : {0.0, 1.0, 1e6}) {
    for (int i = 0; i < 200; ++i) {
      Sinusoid::Options o;
      o.centre.position = {1.0, -2.0, 0.5};
      o.amplitude = 0.4 * random.direction();
      o.frequency = random.log_uniform(0.1, 50.0);
      o.phase = random.uniform(-3.0, 3.0);
      const Sinusoid drive(o);
      const Instant start = Instant{epoch} + random.uniform(0.0, 10.0);
      const Motion motion = drive.motion(start, infinity);
      REQUIRE(std::isfinite(motion.duration));  // as long as the error allows
      const double half = 0.5 * motion.duration;
      CHECK(drive.motion(start, half).duration == half);
      // About 1e-13 of the amplitude, and the rounding of the coordinates.
      CHECK(motion.error_radius < 1e-13 * 0.4 + 16.0 * eps * 3.0);
      for (int k = 0; k <= 16; ++k) {
        const double s = motion.duration * k / 16.0;
        const long double theta = phase(o.frequency, start + s) + o.phase;
        const Vector3 truth =
            o.centre.position + o.amplitude * static_cast<double>(std::sin(theta));
        CHECK((motion.position(s) - truth).norm() <= motion.error_radius);
        const double speed = 2.0 * std::numbers::pi * o.frequency;
        const Vector3 velocity = o.amplitude * (speed * static_cast<double>(std::cos(theta)));
        // The same remainder as the position's, times the angular frequency.
        CHECK((motion.velocity(s) - velocity).norm() <= 1e-13 * 0.4 * speed);
      }
    }
  }
}

TEST_CASE("sinusoid: a motion ends where the next one starts, to within the radii", "[drive]") {
  Sinusoid::Options o;
  o.amplitude = {0.4, 0.0, 0.0};
  o.frequency = 2.0;
  const Sinusoid drive(o);
  Instant t{1e6};
  for (int i = 0; i < 1000; ++i) {
    const Motion motion = drive.motion(t, infinity);
    const Motion next = drive.motion(motion.end(), infinity);
    CHECK((motion.position(motion.duration) - next.position[0]).norm() <=
          motion.error_radius + next.error_radius);
    t = motion.end();
  }
  CHECK(drive.motion(t, 1e-3).duration == 1e-3);
}

TEST_CASE("sinusoid: swings about an axis within its error radius", "[drive]") {
  for (const double amplitude : {0.1, 1.0, 3.1}) {
    INFO(amplitude);
    Sinusoid::Options o;
    o.centre.orientation = rotate({0.3, -0.2, 0.9}, Quaternion::Identity()).normalized();
    o.frequency = 3.0;
    o.rotation_axis = Vector3(1, 2, 2) / 3.0;
    o.rotation_amplitude = amplitude;
    o.rotation_phase = 0.4;
    o.reach = 2.0;
    const Sinusoid drive(o);
    Instant t{0.123};
    for (int i = 0; i < 100; ++i) {
      const Motion motion = drive.motion(t, infinity);
      CHECK(motion.error_radius < 1e-13 * o.reach);
      for (int k = 0; k <= 8; ++k) {
        const double s = motion.duration * k / 8.0;
        const double theta = static_cast<double>(phase(o.frequency, t + s)) + o.rotation_phase;
        const Quaternion truth =
            rotate(amplitude * std::sin(theta) * o.rotation_axis, o.centre.orientation);
        CHECK(turned_apart(motion.orientation(s), truth) * o.reach <=
              motion.error_radius + 8.0 * eps * o.reach);
        const Vector3 w =
            o.rotation_axis * (amplitude * 2.0 * std::numbers::pi * o.frequency * std::cos(theta));
        CHECK((motion.twist(s).angular - w).norm() < 1e-11);
      }
      t = motion.end();
    }
  }
}

TEST_CASE("track: straight lines, constant turns, still before and after", "[drive]") {
  const Vector3 turn(0, 0, 1.0);
  const Track track({sample(1, {0, 0, 0}), sample(2, {3, 0, 0}, turn), sample(4, {3, 4, 0}, turn)},
                    {false, 1.0, "test"});
  CHECK(track.turns());
  const Motion before = track.motion(Instant{0.25}, infinity);
  CHECK(before.duration == 0.75);
  CHECK(before.twist(0.1).linear == Vector3::Zero());

  const Motion first = track.motion(Instant{1.5}, infinity);
  CHECK(first.duration == 0.5);
  CHECK((first.pose(0.0).position - Vector3(1.5, 0, 0)).norm() < 4 * eps);
  CHECK(first.twist(0.0).linear == Vector3(3, 0, 0));
  CHECK((first.twist(0.0).angular - turn).norm() < 4 * eps);
  CHECK(turned_apart(first.orientation(0.0), rotate(0.5 * turn, Quaternion::Identity())) < 4 * eps);

  // At a sample the next segment begins: the velocity jumps there.
  const Motion second = track.motion(Instant{2.0}, 0.5);
  CHECK(second.duration == 0.5);
  CHECK(second.twist(0.0).linear == Vector3(0, 2, 0));
  CHECK(second.rotation == RotationKind::fixed);

  const Motion after = track.motion(Instant{4.0}, infinity);
  CHECK(after.duration == infinity);
  CHECK(after.pose(100.0).position == Vector3(3, 4, 0));
}

TEST_CASE("track: turns the shorter way, also where a recorder flips the sign", "[drive]") {
  TrackSample a = sample(0, {0, 0, 0}, {0, 0.1, 0});
  TrackSample b = sample(1, {0, 0, 0}, {0, 0.3, 0});
  b.pose.orientation.coeffs() = -b.pose.orientation.coeffs();
  const Track track({a, b}, {});
  CHECK((track.motion(Instant{}, 1.0).twist(0.0).angular - Vector3(0, 0.2, 0)).norm() < 1e-15);
}

TEST_CASE("track: smooth has a continuous velocity and takes parabolas exactly", "[drive]") {
  std::vector<TrackSample> samples;
  const auto parabola = [](double t) { return Vector3(t, 2.0 * t * t - t, 1.0); };
  for (const double t : {0.0, 0.5, 0.75, 1.5, 2.0}) {
    samples.push_back(sample(t, parabola(t)));
  }
  const Track track(samples, {true, 1.0, ""});
  for (const double t : {0.5, 0.75, 1.5}) {
    const Motion ahead = track.motion(Instant{t}, infinity);
    const Motion behind = track.motion(Instant{t - 0.125}, infinity);
    INFO(t);
    CHECK((behind.twist(behind.duration).linear - ahead.twist(0.0).linear).norm() < 1e-14);
    CHECK((behind.pose(behind.duration).position - ahead.pose(0.0).position).norm() < 1e-14);
  }
  for (const double t : {0.6, 0.8, 1.4}) {
    CHECK((track.motion(Instant{t}, infinity).pose(0.0).position - parabola(t)).norm() < 1e-14);
  }
}

TEST_CASE("track: a gesture lasts from its sample to the next, as its motions do", "[drive]") {
  std::vector<TrackSample> samples{sample(0.1, {0, 0, 0}), sample(0.2, {1, 0, 0}),
                                   sample(0.3, {2, 0, 0})};
  samples[1].closed = true;
  const Track track(samples, {.gestures = true});
  CHECK(track.has_gestures());
  for (const auto& [t, closed] : {std::pair{0.0, false},
                                  {0.15, false},
                                  {0.2, true},
                                  {0.25, true},
                                  {0.3, false},
                                  {9.0, false}}) {
    INFO(t);
    CHECK(track.closed(Instant{t}) == closed);
  }
  // Where a motion ends, rounding included, the next gesture begins.
  CHECK(track.closed(track.motion(Instant{0.15}, 1.0).end()));
  CHECK_FALSE(Track(samples, {}).has_gestures());
}

TEST_CASE("track: walking from end to end never meets a motion of length 0", "[drive]") {
  const std::uint64_t seed = 8;
  CAPTURE(seed);
  Random random(seed);
  std::vector<TrackSample> samples;
  double t = 1e5;
  for (int i = 0; i < 500; ++i) {
    t += random.uniform(1e-3, 0.1);
    samples.push_back(sample(t, random.direction(), random.direction()));
  }
  const Track track(samples, {false, 1.0, ""});
  Instant now{1e5 + 1e-4};
  int steps = 0;
  while (now < Instant{t} && steps < 5000) {
    const Motion motion = track.motion(now, 0.013);
    REQUIRE(motion.duration > 1e-17);
    REQUIRE(now < motion.end());
    const Motion next = track.motion(motion.end(), 0.013);
    CHECK((motion.pose(motion.duration).position - next.pose(0.0).position).norm() <=
          motion.error_radius + next.error_radius);
    now = motion.end();
    ++steps;
  }
  CHECK(steps < 5000);
}
