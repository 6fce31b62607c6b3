#pragma once

#include "core/archive.hpp"
#include "core/checkpoint.hpp"
#include "core/recorder.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace kairos::tests {

/// Every bit of every event, bodies by name; and the world at 1 s.
class EventDigest : public Recorder, public CheckpointKeeper {
 public:
  void begin(const Model& model) override { model_ = &model; }
  void event(const Event& event) override {
    Archive bits;
    std::string names = model_->body(event.a).name + " and " + model_->body(event.b).name;
    Event copy = event;
    bits(text_, names, copy.time, copy.after_a, copy.after_b);
    text_ = fingerprint(bits.bytes());
    ++events;
  }
  bool persist(Archive& archive) override {
    archive(text_, events);
    return true;
  }
  [[nodiscard]] bool wants(Instant t, bool last) override { return !last && t.seconds < 1.01; }
  void keep(Instant, std::string_view world) override { kept = std::string(world); }
  [[nodiscard]] const std::string& text() const { return text_; }

  std::int64_t events = 0;
  std::string kept;

 private:
  const Model* model_ = nullptr;
  std::string text_;
};

}  // namespace kairos::tests
