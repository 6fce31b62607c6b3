#pragma once

#include "integrators/ode_stepper.hpp"
#include "integrators/step_control.hpp"

namespace kairos::integrators {

/// A library's solver behind the port. One step is n - 1 steps of the solver, each at most an
/// (n - 1)th of what was asked for, and its n ends are the nodes of a Hermite dense output: of
/// order 2n, which no solver's own interpolant offers above order 5.
class CompositeStepper : public OdeStepper {
 public:
  void start(const Island& island, Instant t, std::span<const BodyState> states) override;
  StepResult step(const Island& island, Instant t, double h, std::span<BodyState> states) final;
  /// No, unless a solver says otherwise: most keep a memory of their own.
  bool persist(Archive& /*archive*/) override { return false; }

 protected:
  /// For solvers that have no memory beyond one step.
  bool persist_memoryless(Archive& archive) {
    archive(dense_control_);
    return OdeStepper::persist(archive);
  }

  struct Substep {
    double advanced = 0.0;  ///< s; 0: failed
    double error = 0.0;     ///< in units of the tolerance
  };
  /// Nodes for a dense output of some order.
  static constexpr std::size_t nodes_for(int order) {
    return static_cast<std::size_t>((order + 1) / 2 < 2 ? 2 : (order + 1) / 2);
  }

  /// `failure`: the reason that a failed step gives.
  CompositeStepper(std::size_t nodes, std::string_view failure, const StepperOptions& options)
      : OdeStepper(nodes),
        substeps_(nodes - 1),
        failure_(failure),
        dense_control_(options, 2 * static_cast<int>(nodes)) {}

  /// The solver must forget its last steps, or cannot (it then keeps a dense output that is worse
  /// than the tolerance).
  [[nodiscard]] virtual bool rewind() { return true; }

  /// One step of the solver from local time s, where y has the rate `rate`, by at most h; y1 is
  /// written. Its right-hand side is `ode_.rhs`, in the local time of the composite step.
  virtual Substep substep(double s, double h, const double* y, const double* rate, double* y1) = 0;

 private:
  bool advance(double h);
  [[nodiscard]] double dense_error();

  std::size_t substeps_;
  std::string_view failure_;
  StepControl dense_control_;
  std::vector<double> y_, rate_;
  std::vector<Motion> motions_;
  std::vector<BodyState> between_;
  double reached_ = 0.0;  ///< s, local time of the last node
  double error_ = 0.0;    ///< largest of the substeps
};

}  // namespace kairos::integrators
