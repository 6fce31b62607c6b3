#pragma once

#include "core/archive.hpp"
#include "core/recorder.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace kairos::experiments {

/// Several listeners of one run; they are called in the order in which they are given.
class Broadcast : public Recorder {
 public:
  explicit Broadcast(std::vector<Recorder*> listeners) : listeners_(std::move(listeners)) {}

  void begin(const Model& model) override {
    for (Recorder* listener : listeners_) {
      listener->begin(model);
    }
  }
  [[nodiscard]] bool wants_motions() const override {
    return std::any_of(listeners_.begin(), listeners_.end(),
                       [](const Recorder* listener) { return listener->wants_motions(); });
  }
  void frame(const Frame& frame) override {
    for (Recorder* listener : listeners_) {
      listener->frame(frame);
    }
  }
  void motion(BodyIndex body, const Motion& motion) override {
    for (Recorder* listener : listeners_) {
      listener->motion(body, motion);
    }
  }
  void event(const Event& event) override {
    for (Recorder* listener : listeners_) {
      listener->event(event);
    }
  }
  void goes_on(Instant t) override {
    for (Recorder* listener : listeners_) {
      listener->goes_on(t);
    }
  }
  void stage(Stage stage, double fraction) override {
    for (Recorder* listener : listeners_) {
      listener->stage(stage, fraction);
    }
  }
  bool persist(Archive& archive) override {
    return std::all_of(listeners_.begin(), listeners_.end(),
                       [&](Recorder* listener) { return listener->persist(archive); });
  }

 private:
  std::vector<Recorder*> listeners_;  ///< not owned
};

}  // namespace kairos::experiments
