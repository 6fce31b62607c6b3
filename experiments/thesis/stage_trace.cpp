#include "experiments/thesis/stage_trace.hpp"

#include <map>
#include <string>
#include <utility>

namespace kairos::experiments::thesis {

void StageTrace::frame(const Frame& frame) {
  frame_ = frame.index;
  time_ = frame.time.seconds;
  if (!entries_.empty() && entries_.back().stage == Stage::draw) {
    entries_.back().frame = frame_;
    entries_.back().time = time_;
  }
}

void StageTrace::stage(Stage stage, double fraction) {
  entries_.push_back({frame_, time_, stage, fraction});
}

void StageTrace::event(const Event& event) {
  if (first_impact_ < 0 && event.kind == EventKind::impact) {
    first_impact_ = frame_;
  }
}

void StageTrace::add_transitions(FigureData& data) const {
  std::map<std::pair<Stage, Stage>, std::int64_t> counts;
  for (std::size_t i = 1; i < entries_.size(); ++i) {
    ++counts[{entries_[i - 1].stage, entries_[i].stage}];
  }
  Table& table = data.table("transitions", {{"from", "", "a stage"},
                                            {"to", "", "the stage that followed"},
                                            {"count", "", "how often in the run"}});
  for (const auto& [pair, count] : counts) {
    table.rows.push_back(
        {std::string(to_string(pair.first)), std::string(to_string(pair.second)), count});
  }
}

void StageTrace::add_frame(FigureData& data, std::int64_t frame) const {
  Table& table = data.table("frame", {{"step", "", "order"},
                                      {"stage", "", "what the scheme did"},
                                      {"fraction", "", "of the frame, done"}});
  std::int64_t step = 0;
  for (const Entry& entry : entries_) {
    if (entry.frame == frame) {
      table.rows.push_back({++step, std::string(to_string(entry.stage)), entry.fraction});
    }
  }
}

}  // namespace kairos::experiments::thesis
