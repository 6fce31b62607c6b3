#include "core/random.hpp"
#include "experiments/bench/bench.hpp"
#include "experiments/bench/bench_peers.hpp"
#include "experiments/registry.hpp"

#include <fmt/format.h>

namespace kairos::experiments {
namespace {

constexpr std::size_t overlap_pairs = std::size_t{1} << 18;  // more than a branch predictor learns
constexpr std::size_t impact_pairs = std::size_t{1} << 13;
constexpr std::uint64_t seed = 20260108;

/// Boxes near each other: about half of the pairs overlap at `spread` 1.
std::vector<BenchPair> random_pairs(std::size_t count, double spread, double turn) {
  std::vector<BenchPair> pairs;
  pairs.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    Random random(seed, i);
    const auto box = [&random] {
      return Box{{random.uniform(0.2, 1.0), random.uniform(0.2, 1.0), random.uniform(0.2, 1.0)}};
    };
    const auto motion = [&](const Vector3& from, const Vector3& velocity) {
      const Pose pose{from, random.orientation()};
      const Twist twist{velocity, turn * random.uniform() * random.direction()};
      return Motion::ballistic({}, 1.0, pose, twist, Vector3::Zero());
    };
    const Box a = box();
    const Box b = box();
    const Vector3 offset = spread * random.uniform(0.6, 1.4) * random.direction();
    // Towards the first, a little beside it.
    const Vector3 velocity = -1.5 * offset + 0.5 * random.direction();
    const Motion motion_a = motion(Vector3::Zero(), Vector3::Zero());
    const Motion motion_b = motion(offset, velocity);
    pairs.push_back({a, b, motion_a, motion_b});
  }
  return pairs;
}

std::int64_t count_overlaps(const ContactDetector& detector, const std::vector<BenchPair>& pairs) {
  std::int64_t count = 0;
  for (const BenchPair& pair : pairs) {
    count +=
        detector.overlaps(pair.a, pair.motion_a.pose(0.0), pair.b, pair.motion_b.pose(0.0)) ? 1 : 0;
  }
  return count;
}

std::int64_t count_impacts(const ContactDetector& detector, const std::vector<BenchPair>& pairs) {
  std::int64_t count = 0;
  for (const BenchPair& pair : pairs) {
    const TimeOfImpact toi =
        detector.time_of_impact({pair.a, pair.motion_a}, {pair.b, pair.motion_b}, {{}, 1.0}, 0.0);
    count += toi.status != ToiStatus::separated ? 1 : 0;  // at the start already, too
  }
  return count;
}

std::vector<PeerQuery> all_peers() {
  std::vector<PeerQuery> peers = fcl_peers();
  const std::vector<PeerQuery> bullet = bullet_peers();
  peers.insert(peers.end(), bullet.begin(), bullet.end());
  return peers;
}

/// A race over pairs; what each counted is told, so that a fast wrong answer shows.
class QueryRace {
 public:
  explicit QueryRace(std::vector<BenchPair> pairs) : pairs_(std::move(pairs)) {}
  void add(const std::string& name,
           const std::function<std::int64_t(const std::vector<BenchPair>&)>& work) {
    const std::size_t i = found_.size();
    found_.push_back(0);
    contenders_.push_back({name, [this, i, work] {
                             found_[i] = work(pairs_);
                             return static_cast<std::int64_t>(pairs_.size());
                           }});
  }
  void run(const std::string& title, int rounds) {
    print_race(title, "query", race(contenders_, rounds));
    fmt::print("  found: {}\n", fmt::join(found_, ", "));
  }

 private:
  std::vector<BenchPair> pairs_;
  std::vector<std::int64_t> found_;
  std::vector<Contender> contenders_;
};

}  // namespace

void bench_queries(int rounds) {
  QueryRace overlaps(random_pairs(overlap_pairs, 1.4, 0.0));
  for (const char* name : {"sat", "certified"}) {
    overlaps.add(std::string(name) + ": overlaps", [detector = find_detector(name)](const auto& p) {
      return count_overlaps(*detector, p);
    });
  }
  for (const PeerQuery& peer : all_peers()) {
    if (peer.overlaps) {
      overlaps.add(peer.name, peer.overlaps);
    }
  }
  overlaps.run(fmt::format("Do two boxes overlap? {} distinct pairs", overlap_pairs), rounds);

  for (const double turn : {0.7, 3.0}) {
    QueryRace impacts(random_pairs(impact_pairs, 3.0, turn));
    for (const char* name : {"certified", "conservative-advancement", "bisection"}) {
      impacts.add(name, [detector = find_detector(name)](const auto& p) {
        return count_impacts(*detector, p);
      });
    }
    for (const PeerQuery& peer : all_peers()) {
      if (peer.impacts) {
        impacts.add(peer.name, peer.impacts);
      }
    }
    impacts.run(fmt::format("When do two boxes meet? {} pairs that turn by up to {:.0f} degrees",
                            impact_pairs, turn * 57.29577951308232),
                rounds);
  }
}

}  // namespace kairos::experiments
