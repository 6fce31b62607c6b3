#include "ccd/relative_boxes.hpp"
#include "ccd/swept_box.hpp"
#include "core/random.hpp"
#include "experiments/bench/bench.hpp"
#include "experiments/bench/race_table.hpp"
#include "simulation/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace kairos::experiments {
namespace {

constexpr std::uint64_t seed = 20260109;  ///< of the balls
constexpr double fcl_accuracy = 1e-4;     ///< m, and s

Contest sat_overlaps(const std::vector<BoxPair>& pairs) {
  std::vector<std::pair<ccd::OrientedBox, ccd::OrientedBox>> boxes;
  boxes.reserve(pairs.size());
  const auto box = [](const Box& shape, const Pose& pose) {
    return ccd::OrientedBox{pose.position, pose.orientation.toRotationMatrix(), shape.half_extents};
  };
  for (const BoxPair& pair : pairs) {
    boxes.emplace_back(box(pair.a, pair.start_a), box(pair.b, pair.start_b));
  }
  return [boxes = std::move(boxes)](std::size_t first, std::size_t last,
                                    std::vector<double>& answers) {
    for (std::size_t i = first; i < last; ++i) {
      answers[i] =
          ccd::classify(boxes[i].first, boxes[i].second) == ccd::Verdict::separated ? never : 0.0;
    }
  };
}

double time_of(const TimeOfImpact& toi) {
  return toi.status == ToiStatus::separated ? never : toi.t_lo;
}

/// Motions are made from the pairs within the time that is measured, as the peers make theirs.
Contest impacts(const std::vector<BoxPair>& pairs, const std::string& name, double tolerance) {
  return [&pairs, detector = find_detector(name), tolerance](std::size_t first, std::size_t last,
                                                             std::vector<double>& answers) {
    for (std::size_t i = first; i < last; ++i) {
      const BoxPair& pair = pairs[i];
      const Shape a = pair.a;
      const Shape b = pair.b;
      const Motion motion_a =
          Motion::ballistic({}, 1.0, pair.start_a, pair.twist_a, Vector3::Zero());
      const Motion motion_b =
          Motion::ballistic({}, 1.0, pair.start_b, pair.twist_b, Vector3::Zero());
      answers[i] =
          time_of(detector->time_of_impact({a, motion_a}, {b, motion_b}, {{}, 1.0}, tolerance));
    }
  };
}

std::vector<PeerQuery> all_peers() {
  std::vector<PeerQuery> peers = fcl_peers();
  const std::vector<PeerQuery> bullet = bullet_peers();
  peers.insert(peers.end(), bullet.begin(), bullet.end());
  return peers;
}

const char* const fcl_overlap = "FCL: OBB::overlap";
const char* const fcl_advancement = "FCL: conservative advancement, libccd";

void race_overlaps(std::size_t count, int rounds, std::vector<Bar>& bars) {
  const std::vector<BoxPair> pairs = random_box_pairs(count, 1.4, 0.0);
  std::vector<Racer> racers{{"sat, proven", sat_overlaps(pairs)}};
  for (const PeerQuery& peer : all_peers()) {
    if (peer.overlaps) {
      racers.push_back({peer.name, peer.overlaps(pairs)});
    }
  }
  const auto results = tell(fmt::format("Do two boxes overlap? {} distinct pairs", count), racers,
                            count, rounds, {fcl_overlap, fcl_accuracy});
  bars.push_back({"sat / FCL OBB::overlap", ratio(results, "sat, proven", fcl_overlap), 0.5});
}

void race_impacts(std::size_t count, int rounds, double turn, std::vector<Bar>& bars) {
  const std::vector<BoxPair> pairs = random_box_pairs(count, 3.0, turn);
  const std::string at_1e4 = "conservative-advancement at 1e-4 m";
  std::vector<Racer> racers{{"certified", impacts(pairs, "certified", 0.0)},
                            {at_1e4, impacts(pairs, "conservative-advancement", fcl_accuracy)},
                            {"bisection", impacts(pairs, "bisection", 0.0)}};
  for (const PeerQuery& peer : all_peers()) {
    if (peer.impacts) {
      racers.push_back({peer.name, peer.impacts(pairs, fcl_accuracy)});
    }
  }
  const double degrees = std::round(turn * 57.29577951308232);
  const auto results = tell(
      fmt::format("When do two boxes meet? {} distinct pairs that turn by up to {:.0f} degrees",
                  count, degrees),
      racers, count, rounds, {fcl_advancement, fcl_accuracy});
  const auto name = [&](const char* what) {
    return fmt::format("{} / FCL advancement, {:.0f} degrees", what, degrees);
  };
  bars.push_back(
      {name("conservative-advancement at 1e-4"), ratio(results, at_1e4, fcl_advancement), 0.1});
  bars.push_back({name("certified"), ratio(results, "certified", fcl_advancement), 0.2});
}

/// A cloud of balls under gravity, and every pair of them.
struct Cloud {
  std::vector<Shape> balls;
  std::vector<Motion> motions;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;

  explicit Cloud(std::size_t count) {
    const auto size =
        static_cast<std::uint32_t>(std::ceil(std::sqrt(2.0 * static_cast<double>(count)))) + 1;
    for (std::uint32_t i = 0; i < size; ++i) {
      Random random(seed, i);
      balls.emplace_back(Sphere{random.uniform(0.05, 0.2)});
      const Pose at{{random.uniform(0.0, 4.0), random.uniform(0.0, 4.0), random.uniform(0.0, 4.0)},
                    Quaternion::Identity()};
      const double speed = random.uniform(0.0, 8.0);
      const Vector3 velocity = speed * random.direction();
      motions.push_back(
          Motion::ballistic({}, 1.0, at, {velocity, Vector3::Zero()}, {0.0, -9.8, 0.0}));
      for (std::uint32_t j = 0; j < i && pairs.size() < count; ++j) {
        pairs.emplace_back(j, i);
      }
    }
  }
};

void race_balls(std::size_t count, int rounds, std::vector<Bar>& bars) {
  const Cloud cloud(count);
  const Contest impact = [&cloud, detector = find_detector("certified")](
                             std::size_t first, std::size_t last, std::vector<double>& answers) {
    for (std::size_t k = first; k < last; ++k) {
      const auto [i, j] = cloud.pairs[k];
      answers[k] = time_of(detector->time_of_impact(
          {cloud.balls[i], cloud.motions[i]}, {cloud.balls[j], cloud.motions[j]}, {{}, 1.0}, 0.0));
    }
  };
  const std::string title = "When do two balls under gravity meet?";
  const auto results =
      tell(fmt::format("{} {} distinct pairs of {}", title, count, cloud.balls.size()),
           {{"certified", impact}}, count, rounds, {});
  bars.push_back({"certified, balls under gravity (ns)", results.front().nanoseconds, 60.0});

  // The same for a shorter window, in which nearly all stay apart: first their swept boxes.
  const double window = 1.0 / 60.0;
  std::vector<Aabb> boxes;
  for (std::size_t i = 0; i < cloud.balls.size(); ++i) {
    boxes.push_back(ccd::swept_aabb(cloud.balls[i], cloud.motions[i], 0.0, window));
  }
  const Contest reject = [&](std::size_t first, std::size_t last, std::vector<double>& answers) {
    for (std::size_t k = first; k < last; ++k) {
      const auto [i, j] = cloud.pairs[k];
      answers[k] = boxes[i].overlaps(boxes[j]) ? 0.0 : never;
    }
  };
  const auto rejected =
      tell("Could they meet within 1/60 s?", {{"swept boxes", reject}}, count, rounds, {});
  bars.push_back({"rejection by swept boxes (ns)", rejected.front().nanoseconds, 10.0});
}

}  // namespace

void bench_queries(std::size_t pairs, int rounds) {
  std::vector<Bar> bars;
  race_overlaps(pairs, rounds, bars);
  race_impacts(pairs, rounds, 0.7, bars);
  race_impacts(pairs, rounds, 3.0, bars);
  race_balls(pairs, rounds, bars);
  print_bars(bars);
}

}  // namespace kairos::experiments
