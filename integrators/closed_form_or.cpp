#include "integrators/closed_form_or.hpp"

#include "core/archive.hpp"
#include "integrators/closed_form.hpp"

#include <algorithm>
#include <utility>

namespace kairos::integrators {
namespace {

class ClosedFormOr final : public Stepper {
 public:
  explicit ClosedFormOr(std::unique_ptr<Stepper> otherwise)
      : closed_form_(make_closed_form({})), otherwise_(std::move(otherwise)) {}

  [[nodiscard]] StepperInfo info() const override { return now().info(); }
  [[nodiscard]] std::int64_t evaluations() const override {
    return closed_form_->evaluations() + otherwise_->evaluations();
  }
  [[nodiscard]] std::string refuses(const Island& island) const override {
    return closed_form_->refuses(island);
  }
  void start(const Island& island, Instant t, std::span<const BodyState> states) override {
    closed_form_->start(island, t, states);
    otherwise_->start(island, t, states);
    gave_up_ = false;
  }
  void restart(const Island& island, Instant t, std::span<const BodyState> states) override {
    closed_form_->restart(island, t, states);
    gave_up_ = false;
  }

  StepResult step(const Island& island, Instant t, double h, std::span<BodyState> states) override {
    if (!gave_up_) {
      const StepResult result = closed_form_->step(island, t, h, states);
      if (result.ok) {
        return result;
      }
      gave_up_ = true;
      otherwise_->restart(island, t, states);
    }
    // Who is asked for a closed form may be asked for an endless step: a radian will do.
    for (const BodyState& state : states) {
      h = std::min(h, 1.0 / state.twist.angular.norm());
    }
    return otherwise_->step(island, t, h, states);
  }

  void dense_output(std::span<Motion> motions) const override { now().dense_output(motions); }
  bool replay(const Island& island, double s, std::span<const BodyState> before,
              std::span<ReplayedStep> after) const override {
    return now().replay(island, s, before, after);
  }
  bool persist(Archive& archive) override {
    archive(gave_up_);
    return closed_form_->persist(archive) && otherwise_->persist(archive);
  }

 private:
  [[nodiscard]] const Stepper& now() const { return gave_up_ ? *otherwise_ : *closed_form_; }

  std::unique_ptr<Stepper> closed_form_;
  std::unique_ptr<Stepper> otherwise_;
  bool gave_up_ = false;
};

}  // namespace

std::unique_ptr<Stepper> make_closed_form_or(std::unique_ptr<Stepper> otherwise) {
  return std::make_unique<ClosedFormOr>(std::move(otherwise));
}

}  // namespace kairos::integrators
