#pragma once

#include "core/model.hpp"
#include "core/recorder.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace kairos {
inline namespace simulation {

/// What `GasAverages` averages, and how.
struct GasAverageOptions {
  std::int64_t skipped_frames =
      0;  ///< before the first block: what a gas takes to forget its start
  std::int64_t frames_a_block = 100;  ///< >= 1
  double greatest_distance =
      0.0;                     ///< m, of pairs that are counted at the end of each block; 0: none
  std::size_t distances = 60;  ///< intervals of these, >= 1
};

/// One stretch of a run.
struct GasBlock {
  double duration = 0.0;     ///< s
  std::int64_t impacts = 0;  ///< between bodies that move freely
  std::int64_t wall_impacts = 0;
  double virial = 0.0;        ///< sum over impacts of impulse times distance of the centres, N m s
  double wall_impulse = 0.0;  ///< sum of impulses on what does not move freely, N s
  double kinetic = 0.0;       ///< mean over frames, J: translation about the common centre of mass
  Vector3 spin = Vector3::Zero();  ///< the same of turning about each principal axis, J
  /// Mean square of the way of a body from the start of the block to each frame of it, the motion
  /// of the centre of mass left out, m^2.
  std::vector<double> way;
};

/// Listens to a run of many bodies and keeps averages alone: its memory does not grow with the run,
/// and with the bodies by some 80 bytes each. Blocks follow each other; their scatter tells the
/// error of a mean.
///
/// In blocks: pressure by the virial of impacts, temperature, rate of impacts, mean square way; at
/// the end of each, how many pairs of free bodies are how far apart (nearest images).
class GasAverages : public Recorder {
 public:
  explicit GasAverages(const GasAverageOptions& options) : options_(options) {}

  void begin(const Model& model) override;
  void frame(const Frame& frame) override;
  void event(const Event& event) override;

  /// Those that are complete.
  [[nodiscard]] const std::vector<GasBlock>& blocks() const { return blocks_; }
  /// Bodies that move freely.
  [[nodiscard]] std::size_t bodies() const { return free_.size(); }
  /// Pairs found in each interval of distances, summed over the ends of blocks.
  [[nodiscard]] const std::vector<std::int64_t>& pairs() const { return pairs_; }
  /// Frames of a block are so long after its start, s; of the last one that is complete.
  [[nodiscard]] const std::vector<double>& times() const { return times_; }

 private:
  void open_block(const Frame& frame);
  void look(const Frame& frame);
  void close_block(const Frame& frame);
  void count_pairs(const Frame& frame);

  GasAverageOptions options_;
  const Model* model_ = nullptr;
  std::vector<BodyIndex> free_;
  double mass_ = 0.0;  ///< of all that move freely, kg
  std::vector<GasBlock> blocks_;
  std::optional<GasBlock> open_;
  std::vector<std::int64_t> pairs_;
  std::vector<double> times_;
  std::vector<Vector3> origin_;  ///< of each free body against the centre of mass, at the start
  double start_ = 0.0;           ///< of the open block, s
  std::int64_t looks_ = 0;
};

/// A mean and its standard error, from the scatter of blocks.
struct BlockMean {
  double mean = 0.0;
  double error = 0.0;
};
[[nodiscard]] BlockMean block_mean(const std::vector<double>& of_blocks);

}  // namespace simulation
}  // namespace kairos
