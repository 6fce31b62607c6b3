#pragma once

#include "core/instant.hpp"
#include "core/state.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace kairos {
inline namespace core {

class Archive;

/// The latest connected impacts of a body, which tell whether infinitely many of them may follow
/// each other in a finite time (Zeno), which no number of events gets past. Distances are those
/// between the two bodies that meet, so that no observer matters.
class ImpactHistory {
 public:
  /// An impact at t.
  struct Impact {
    BodyIndex partner = 0;
    double approach = 0.0;   ///< at which the two met, m/s, > 0
    double near = 0.0;       ///< a shorter way than this hangs together with the last one, m
    double tolerance = 0.0;  ///< and one shorter than this is none, m
    bool rest = false;       ///< so slow that what presses allows no hop above tolerance
  };
  void add(const Impact& impact, Instant t);

  /// How many impacts hang together, from way to way shorter than `near`.
  [[nodiscard]] std::int64_t chain() const { return chain_; }
  /// Who they were with, each once, in the order of their first.
  [[nodiscard]] std::vector<BodyIndex> partners() const;
  /// True where more than 200 in a row followed each other on no way at all. A cradle or the break
  /// of a rack has a few.
  [[nodiscard]] bool creeps() const { return creeping_ > most_creeping; }
  /// True where so many of those that hang together did that nothing is to be hoped for from more
  /// of them, whatever short way is between some. What hands an impact on among many bodies, or
  /// among light and heavy ones, takes some hundreds until it is slow.
  [[nodiscard]] bool creeps_on() const { return crept_ > 25 * most_creeping; }
  /// Whether the latest impact followed the one before on no way at all.
  [[nodiscard]] bool on_no_way() const { return creeping_ > 0; }
  /// True where one and the same body was met more than three times in a row without a hop worth
  /// the name: what presses the two together makes each hop that follows shorter.
  [[nodiscard]] bool rests() const { return resting_ > most_resting; }

  /// A look at t that changed nothing: true where more than 200 in a row came within `resolution`,
  /// s, of the one before, that is, where time stands still.
  [[nodiscard]] bool stalls(Instant t, double resolution);
  /// What stalled goes on in another way: the next time is the first.
  void go_on();

  void persist(Archive& archive);

 private:
  static constexpr int most_creeping = 200;
  static constexpr int most_resting = 3;
  static constexpr int most_stalling = 200;

  /// What few bodies have.
  struct Rare {
    std::vector<BodyIndex> partners{};  ///< empty while there is but one, which is the last
    Instant stalled = Instant::never();
    int stalling = 0;
  };
  [[nodiscard]] Rare& rare();

  Instant last_ = Instant::never();
  std::int64_t chain_ = 0;
  std::uint32_t last_partner_ = 0;
  int creeping_ = 0;
  int crept_ = 0;  ///< of the chain
  int resting_ = 0;
  std::unique_ptr<Rare> rare_;  ///< null: none of that
};

}  // namespace core
}  // namespace kairos
