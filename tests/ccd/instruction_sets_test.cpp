#include "ccd/ball_filter.hpp"
#include "ccd/box_batch.hpp"
#include "core/random.hpp"
#include "tests/catch.hpp"
#include "tests/ccd/instruction_set.hpp"

#include <array>
#include <cstring>

using namespace kairos;
using namespace kairos::ccd;

namespace {

bool same_double(double x, double y) { return std::memcmp(&x, &y, sizeof x) == 0; }

bool same(const AxisSeparation& x, const AxisSeparation& y) {
  return x.axis == y.axis && same_double(x.value, y.value) && same_double(x.length, y.length) &&
         same_double(x.sign, y.sign);
}

/// Those that this processor has; the first is the baseline.
std::vector<InstructionSet> sets() {
  std::vector<InstructionSet> all{baseline_set()};
  for (const InstructionSet& wide : {avx2_set(), avx512_set()}) {
    if (wide.here) {
      all.push_back(wide);
    }
  }
  return all;
}

Vector3 around(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

/// Some that meet, some that pass, some that touch; at rest, in step, far away, falling otherwise.
BallFlight random_flight(Random& random, const BallFlight& near) {
  BallFlight ball;
  const double draw = random.uniform();
  ball.radius = random.log_uniform(1e-3, 1.0);
  ball.velocity = draw < 0.1 ? near.velocity : around(random, 2.0);
  ball.acceleration = draw < 0.2 ? Vector3(Vector3::Zero()) : Vector3(0.0, -9.8, 0.0);
  ball.start = Instant{random.uniform(0.0, draw < 0.5 ? 1e-3 : 1.0)};
  ball.position = near.position + around(random, draw < 0.8 ? 3.0 : 0.3);
  if (draw > 0.95) {
    ball.position = near.position + random.direction() * (near.radius + ball.radius);
    ball.start = near.start;
  } else if (draw > 0.9) {
    ball.position *= 1e9;
  }
  return ball;
}

RelativeBoxes random_boxes(Random& random) {
  RelativeBoxes boxes;
  for (Vector3* half : {&boxes.half_a, &boxes.half_b}) {
    *half = {random.log_uniform(0.1, 1.0), random.log_uniform(0.1, 1.0),
             random.log_uniform(0.1, 1.0)};
  }
  const double draw = random.uniform();
  if (draw > 0.2) {  // else edges are parallel, or nearly
    const double angle = draw < 0.4 ? 1e-9 : random.uniform(0.0, 3.0);
    boxes.axes_A = Quaternion(Eigen::AngleAxisd(angle, random.direction())).toRotationMatrix();
  }
  boxes.d_A = around(random, 2.0);
  if (draw > 0.9) {  // touching along an axis of a
    boxes.d_A[0] = boxes.half_a[0] + boxes.axes_A.row(0).cwiseAbs().dot(boxes.half_b);
  }
  return boxes;
}

}  // namespace

// The processor decides at load time which of them a run takes: no bit may depend on it.
TEST_CASE("balls are let through alike by registers of all widths", "[instruction-sets]") {
  constexpr std::uint64_t seed = 15;
  INFO("seed " << seed);
  Random random(seed);
  const std::vector<InstructionSet> all = sets();
  std::size_t let_through = 0;
  std::size_t kept_out = 0;
  for (int round = 0; round < 4000; ++round) {
    BallFlight one = random_flight(random, {});
    const bool alike = round % 3 != 0;
    if (round % 3 == 1) {
      one.acceleration.setZero();
    }
    std::vector<BallFlight> others(random.below(70));  // blocks, and what is left of one
    for (BallFlight& other : others) {
      other = random_flight(random, one);
    }
    const double tolerance = round % 2 == 0 ? 0.0 : 1e-9;
    FlightsBeside beside;
    alike ? beside.begin_alike(one) : beside.begin(one);
    for (const BallFlight& other : others) {
      alike ? beside.add_alike(other) : beside.add(other);
    }
    std::vector<double> expected(beside.blocks().size() * FlightsBeside::block);
    std::vector<double> found(expected.size());
    all[0].filter_balls(beside, tolerance, expected);
    expected.resize(others.size());
    for (const double clear : expected) {
      ++(clear < std::numeric_limits<double>::infinity() ? let_through : kept_out);
    }
    const auto compare = [&](const char* name) {
      INFO(name << ", round " << round);
      REQUIRE(std::equal(expected.begin(), expected.end(), found.begin(), same_double));
    };
    for (std::size_t k = 1; k < all.size(); ++k) {
      all[k].filter_balls(beside, tolerance, found);
      compare(all[k].name);
    }
    filter_balls(beside, tolerance, found);
    compare("as it is in the program");
  }
  // Both happen, or nothing has been compared.
  CHECK(let_through > 10'000);
  CHECK(kept_out > 10'000);
}

TEST_CASE("boxes are apart alike by registers of all widths", "[instruction-sets]") {
  constexpr std::uint64_t seed = 16;
  INFO("seed " << seed);
  Random random(seed);
  const std::vector<InstructionSet> all = sets();
  std::array<std::size_t, 3> seen{};
  for (int round = 0; round < 400; ++round) {
    std::vector<RelativeBoxes> boxes(1 + random.below(200));
    for (RelativeBoxes& each : boxes) {
      each = random_boxes(random);
    }
    struct Answers {
      std::vector<Verdict> verdicts;
      std::vector<AxisSeparation> separations;
      std::vector<double> errors;
      explicit Answers(std::size_t n) : verdicts(n), separations(n), errors(n) {}
    };
    Answers expected(boxes.size());
    all[0].batch(boxes, expected.verdicts, expected.separations, expected.errors);
    const auto compare = [&](const Answers& found, const char* name) {
      INFO(name << ", round " << round);
      REQUIRE(found.verdicts == expected.verdicts);
      REQUIRE(std::equal(found.separations.begin(), found.separations.end(),
                         expected.separations.begin(), same));
      REQUIRE(std::equal(found.errors.begin(), found.errors.end(), expected.errors.begin(),
                         same_double));
    };
    for (std::size_t k = 1; k < all.size(); ++k) {
      Answers found(boxes.size());
      all[k].batch(boxes, found.verdicts, found.separations, found.errors);
      compare(found, all[k].name);
    }
    BoxBatch pairs;
    for (const RelativeBoxes& each : boxes) {
      pairs.push_back(each);
    }
    Answers found(boxes.size());
    classify_batch(pairs, found.verdicts);
    greatest_separation_batch(pairs, found.separations, found.errors);
    compare(found, "as it is in the program");
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      ++seen[static_cast<std::size_t>(expected.verdicts[i])];
      const AxisSeparation one = all[0].greatest(boxes[i]);
      const int verdicts = all[0].verdicts(boxes[i]);
      REQUIRE(same(one, greatest_separation(boxes[i])));
      for (std::size_t k = 1; k < all.size(); ++k) {
        INFO(all[k].name << ", round " << round << ", pair " << i);
        REQUIRE(same(all[k].greatest(boxes[i]), one));
        REQUIRE(all[k].verdicts(boxes[i]) == verdicts);
      }
    }
  }
  CHECK(seen[0] > 1000);
  CHECK(seen[1] > 1000);
}
