#include "simulation/cold_restarts.hpp"

#include <utility>

namespace kairos {
inline namespace simulation {
namespace {

class ColdRestarts final : public Stepper {
 public:
  explicit ColdRestarts(std::unique_ptr<Stepper> inner) : inner_(std::move(inner)) {}

  [[nodiscard]] StepperInfo info() const override { return inner_->info(); }
  [[nodiscard]] std::string refuses(const Island& island) const override {
    return inner_->refuses(island);
  }
  void start(const Island& island, Instant t, std::span<const BodyState> states) override {
    inner_->start(island, t, states);
  }
  void restart(const Island& island, Instant t, std::span<const BodyState> states) override {
    inner_->start(island, t, states);
  }
  StepResult step(const Island& island, Instant t, double h, std::span<BodyState> states) override {
    return inner_->step(island, t, h, states);
  }
  void dense_output(std::span<Motion> motions) const override { inner_->dense_output(motions); }
  bool replay(const Island& island, double s, std::span<const BodyState> before,
              std::span<ReplayedStep> after) const override {
    return inner_->replay(island, s, before, after);
  }
  bool watch(std::shared_ptr<const GapFunction> gaps) override {
    return inner_->watch(std::move(gaps));
  }
  [[nodiscard]] std::int64_t evaluations() const override { return inner_->evaluations(); }
  bool persist(Archive& archive) override { return inner_->persist(archive); }

 private:
  std::unique_ptr<Stepper> inner_;
};

}  // namespace

std::unique_ptr<Stepper> with_cold_restarts(std::unique_ptr<Stepper> stepper) {
  return stepper == nullptr ? nullptr : std::make_unique<ColdRestarts>(std::move(stepper));
}

}  // namespace simulation
}  // namespace kairos
