#include "integrators/composite_stepper.hpp"

#include <algorithm>

namespace kairos::integrators {

void CompositeStepper::start(const Island& island, Instant t, std::span<const BodyState> states) {
  OdeStepper::start(island, t, states);
  y_.assign(ode_.size(), 0.0);
  rate_.assign(ode_.size(), 0.0);
  motions_.assign(states.size(), {});
  between_.assign(states.begin(), states.end());
  dense_control_.forget();
  dense_control_.propose(std::numeric_limits<double>::max());
}

StepResult CompositeStepper::step(const Island& island, Instant t, double h,
                                  std::span<BodyState> states) {
  begin_step(island, t, states);
  for (double trial = dense_control_.first_trial(h); trial > 0.0;) {
    dense_.truncate(1);
    if (!advance(trial)) {
      return {.advanced = 0.0, .error = error_, .ok = false, .reason = failure_};
    }
    const double error = dense_control_.active() ? dense_error() : 0.0;
    if (error <= 1.0 || !rewind()) {
      dense_control_.accept(reached_, std::min(error, 1.0));
      end_step(states);
      return {.advanced = reached_, .error = error_, .ok = true, .reason = {}};
    }
    dense_control_.cut(reached_);  // a solver's first step may be some eps of what was asked for
    trial = dense_control_.shorter(reached_, error);
  }
  return {.advanced = 0.0, .error = 0.0, .ok = false, .reason = failure_};
}

// The solver's steps from the first node, by at most h in all.
bool CompositeStepper::advance(double h) {
  HermiteMotion::Node node = dense_.node(0);
  double s = 0.0;
  error_ = 0.0;
  bool full = true;  // every part as long as asked for
  for (std::size_t k = 1; k <= substeps_ && s < h; ++k) {
    const double target =
        k == substeps_ ? h : h * static_cast<double>(k) / static_cast<double>(substeps_);
    const double part = full ? target - s : std::min(h / static_cast<double>(substeps_), h - s);
    const Substep made = substep(s, part, node.y, node.rate, y_.data());
    if (!(made.advanced > 0.0)) {
      return false;
    }
    full = full && made.advanced == part;
    s = full ? target : std::min(s + made.advanced, h);
    error_ = std::max(error_, made.error);
    node = dense_.add(s);
    std::copy(y_.begin(), y_.end(), node.y);
    finish_node(s, node);
  }
  reached_ = s;
  return true;
}

// The error of the dense velocities, in units of the tolerance, from their defect a quarter into
// the widest gap between nodes: there an error e ~ (s - s_i)^2 (s - s_j)^2 changes fastest, at a
// rate of about 5 max|e| per gap.
double CompositeStepper::dense_error() {
  double gap = 0.0, s = 0.0;
  for (std::size_t k = 1; k < dense_.nodes(); ++k) {
    const double width = dense_.time(k) - dense_.time(k - 1);
    if (width > gap) {
      gap = width;
      s = dense_.time(k - 1) + 0.25 * width;
    }
  }
  dense_output(motions_);
  for (std::size_t i = 0; i < between_.size(); ++i) {
    between_[i] = {motions_[i].pose(s), motions_[i].twist(s)};
  }
  ode_.pack(between_, y_.data());
  ode_.rhs(s, y_.data(), rate_.data());
  double worst = 0.0;
  for (std::size_t i = 0; i < between_.size(); ++i) {
    const IslandOde::Slot& slot = ode_.slots()[i];
    const auto compare = [&](const Polynomial<3>& polynomial, std::size_t offset) {
      const Vector3 slope = polynomial.derivative(s);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t n = slot.offset + offset + axis;
        const double defect = slope[static_cast<int>(axis)] - rate_[n];
        worst = std::max(worst, dense_control_.scaled(0.2 * gap * defect, y_[n], y_[n]));
      }
    };
    compare(motions_[i].velocity, IslandOde::velocity);
    if (slot.rotates) {
      compare(motions_[i].angular_velocity, IslandOde::angular);
    }
  }
  return worst;
}

}  // namespace kairos::integrators
