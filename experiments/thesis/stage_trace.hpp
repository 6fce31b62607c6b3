#pragma once

#include "core/recorder.hpp"
#include "experiments/thesis/figure_data.hpp"

#include <vector>

namespace kairos::experiments::thesis {

/// Remembers the stages that a scheme really goes through, as it goes through them.
class StageTrace : public Recorder {
 public:
  struct Entry {
    std::int64_t frame = 0;  ///< the frame that was drawn last
    double time = 0.0;       ///< s, when that frame was drawn
    Stage stage{};
    double fraction = 0.0;  ///< of the frame, that is done
  };

  void frame(const Frame& frame) override;
  void stage(Stage stage, double fraction) override;
  void event(const Event& event) override;

  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
  /// The frame in which something was handled first; -1 if in none.
  [[nodiscard]] std::int64_t first_impact() const { return first_impact_; }

  /// Table `transitions`: how often each stage followed each other in the whole run.
  void add_transitions(FigureData& data) const;
  /// Table `frame`: the stages of one frame, from its drawing up to the next one's.
  void add_frame(FigureData& data, std::int64_t frame) const;

 private:
  std::vector<Entry> entries_;
  std::int64_t frame_ = 0;
  double time_ = 0.0;
  std::int64_t first_impact_ = -1;
};

}  // namespace kairos::experiments::thesis
