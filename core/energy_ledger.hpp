#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace kairos {
inline namespace core {

class Archive;

/// Where energy came from or went to. Each line has a formula of its own; none is the remainder.
enum class EnergyLine : std::size_t {
  field_work,   ///< fields that have no potential (pad, drag): integral of F dp along the Motion
  driven_work,  ///< bats and other driven bodies: impulse times their velocity
  restitution_loss,  ///< (e^2 - 1)/2 m_eff v_n^2 at the moment of contact; <= 0
  truncation,        ///< the step in exact arithmetic minus the work of the forces along the Motion
  late_impact,       ///< restitution loss where it was handled minus where contact was
  position_correction,  ///< bodies pushed out of others, or nudged: work against gravity
  conveyor_and_hand,    ///< belts and hands
  roundoff,             ///< steps as computed minus steps in double-double, impacts as computed
                        ///< minus impacts in extended precision; on request
  friction,             ///< between impacts: minus the integral of mu N |v_t| dt; <= 0
  impact_friction,      ///< tangential impulses p_t of impacts: sum of p_t.(u- + u+)/2, u relative
  zeno_completion,      ///< the impacts left of an accumulation that is completed: p.(u- + u+)/2
  projection,           ///< impulses that put velocities back to constraints: p.(u- + u+)/2
};
inline constexpr std::size_t energy_line_count = 12;
/// The word for it in the columns of `energy.csv`.
[[nodiscard]] std::string_view to_string(EnergyLine line);

/// Sum that does not lose its small terms [Neumaier1974].
class CompensatedSum {
 public:
  /// Adds a term.
  void add(double x) {
    const double t = sum_ + x;
    correction_ += std::abs(sum_) >= std::abs(x) ? (sum_ - t) + x : (x - t) + sum_;
    sum_ = t;
  }
  /// a b, its rounding included.
  void add_product(double a, double b) {
    const double product = a * b;
    add(product);
    correction_ += std::fma(a, b, -product);
  }
  /// The sum so far.
  [[nodiscard]] double value() const { return sum_ + correction_; }
  /// Writes it to a checkpoint, or reads it back.
  void persist(Archive& archive);

 private:
  double sum_ = 0.0;
  double correction_ = 0.0;
};

/// Where every joule went. All lines are energy that entered the bodies, J; losses are negative.
class EnergyLedger {
 public:
  /// Sets the energy that everything is compared with.
  void open(double kinetic, double potential);
  /// Tells the energy as it is now.
  void balance(double kinetic, double potential) {
    kinetic_ = kinetic;
    potential_ = potential;
  }
  /// Books energy that entered the bodies, J; a loss is negative.
  void add(EnergyLine line, double joules) {
    lines_[static_cast<std::size_t>(line)].add(joules);
    flow_.add(std::abs(joules));
  }
  /// Counts energy that only changed its form (kinetic to potential and back) or was taken up and
  /// given back, for the scale of roundoff.
  void exchange(double joules) { flow_.add(std::abs(joules)); }

  /// As last told, J.
  [[nodiscard]] double kinetic() const { return kinetic_; }
  /// As last told, J.
  [[nodiscard]] double potential() const { return potential_; }
  /// As last told, kinetic and potential, J.
  [[nodiscard]] double energy() const { return kinetic_ + potential_; }
  /// With which the ledger was opened, J.
  [[nodiscard]] double initial_energy() const { return initial_kinetic_ + initial_potential_; }
  /// What has been booked on a line, J.
  [[nodiscard]] double line(EnergyLine line) const {
    return lines_[static_cast<std::size_t>(line)].value();
  }
  /// Sum of the magnitudes of all flows so far, J: what the bodies brought with them; all that
  /// forces and impacts turned from one form into another; and of each velocity and height that a
  /// step or an impact replaced by another the energy that it held, which is rounded anew. A ball
  /// that a wall sends back has given up all its energy and got it back.
  [[nodiscard]] double flow() const { return flow_.value(); }
  /// What no line explains; a test holds it below 8 eps of `flow()`.
  [[nodiscard]] double unexplained() const;
  /// Writes it to a checkpoint, or reads it back.
  void persist(Archive& archive);

 private:
  double initial_kinetic_ = 0.0;
  double initial_potential_ = 0.0;
  double kinetic_ = 0.0;
  double potential_ = 0.0;
  std::array<CompensatedSum, energy_line_count> lines_{};
  CompensatedSum flow_;
};

}  // namespace core
}  // namespace kairos
