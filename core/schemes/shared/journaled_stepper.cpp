#include "core/schemes/shared/journaled_stepper.hpp"

#include "core/archive.hpp"
#include "core/schemes/shared/support.hpp"

#include <utility>
#include <vector>

namespace kairos {
inline namespace core {
namespace {

bool same(const BodyState& x, const BodyState& y) {
  return x.pose.position == y.pose.position &&
         x.pose.orientation.coeffs() == y.pose.orientation.coeffs() &&
         x.twist.linear == y.twist.linear && x.twist.angular == y.twist.angular;
}

class JournaledStepper final : public Stepper {
 public:
  explicit JournaledStepper(std::unique_ptr<Stepper> inner) : inner_(std::move(inner)) {}

  [[nodiscard]] StepperInfo info() const override { return inner_->info(); }
  [[nodiscard]] std::string refuses(const Island& island) const override {
    return inner_->refuses(island);
  }
  [[nodiscard]] std::int64_t evaluations() const override { return inner_->evaluations(); }

  void start(const Island& island, Instant t, std::span<const BodyState> states) override {
    journal_.clear();
    forces_.clear();
    known_.clear();
    island_ = island;
    note({.call = Call::start, .t = t}, island, states);
    inner_->start(island, t, states);
  }

  void restart(const Island& island, Instant t, std::span<const BodyState> states) override {
    note({.call = Call::restart, .t = t}, island, states);
    inner_->restart(island, t, states);
  }

  StepResult step(const Island& island, Instant t, double h, std::span<BodyState> states) override {
    note({.call = Call::step, .t = t, .h = h}, island, states);
    const StepResult result = inner_->step(island, t, h, states);
    known_.assign(states.begin(), states.end());
    return result;
  }

  void dense_output(std::span<Motion> motions) const override { inner_->dense_output(motions); }
  bool replay(const Island& island, double s, std::span<const BodyState> before,
              std::span<ReplayedStep> after) const override {
    return inner_->replay(island, s, before, after);
  }

  bool persist(Archive& archive) override {
    if (archive.reading()) {
      journal_.clear();
    }
    archive(journal_);
    if (archive.reading()) {
      tell_again();
    }
    return true;
  }

 private:
  enum class Call : std::uint8_t { start, restart, step };
  friend constexpr Call last_of(Call) { return Call::step; }
  /// States and forces are noted only if they differ from those after the last call.
  struct Entry {
    Call call = Call::step;
    Instant t{};
    double h = 0.0;
    std::vector<BodyState> states{};
    std::vector<Vector3> forces{};
    std::optional<Vector3> support{};  ///< normal of the surface that it slides on

    void persist(Archive& archive) { archive(call, t, h, states, forces, support); }
  };

  void note(Entry entry, const Island& island, std::span<const BodyState> states) {
    bool changed = known_.size() != states.size();
    for (std::size_t k = 0; !changed && k < states.size(); ++k) {
      changed = !same(known_[k], states[k]);
    }
    if (changed) {
      entry.states.assign(states.begin(), states.end());
      known_ = entry.states;
    }
    if (forces_ != island.constant_force) {
      forces_ = entry.forces = island.constant_force;
    }
    if (island.forces.size() > island_.forces.size()) {
      entry.support = dynamic_cast<const SupportForce&>(*island.forces.back()).normal();
    }
    journal_.push_back(std::move(entry));
  }

  void tell_again() {
    Island island = island_;
    std::vector<BodyState> states;
    for (const Entry& entry : journal_) {
      island.forces = island_.forces;
      const SupportForce support(entry.support.value_or(Vector3::Zero()));
      if (entry.support) {
        island.forces.push_back(&support);
      }
      states = entry.states.empty() ? states : entry.states;
      island.constant_force = entry.forces.empty() ? island.constant_force : entry.forces;
      switch (entry.call) {
        case Call::start:
          inner_->start(island, entry.t, states);
          break;
        case Call::restart:
          inner_->restart(island, entry.t, states);
          break;
        case Call::step:
          inner_->step(island, entry.t, entry.h, states);
          break;
      }
    }
    known_ = states;
    forces_ = island.constant_force;
  }

  std::unique_ptr<Stepper> inner_;
  Island island_;  ///< as it was started
  std::vector<Entry> journal_;
  std::vector<BodyState> known_;  ///< what the last call left
  std::vector<Vector3> forces_;
};

}  // namespace

std::unique_ptr<Stepper> make_persistent(std::unique_ptr<Stepper> stepper) {
  Archive trial;
  return stepper->persist(trial) ? std::move(stepper)
                                 : std::make_unique<JournaledStepper>(std::move(stepper));
}

}  // namespace core
}  // namespace kairos
