#include "core/energy_ledger.hpp"

#include "core/archive.hpp"

namespace kairos {
inline namespace core {

std::string_view to_string(EnergyLine line) {
  constexpr std::array<std::string_view, energy_line_count> names{
      "field_work",  "driven_work",         "restitution_loss",  "truncation",
      "late_impact", "position_correction", "conveyor_and_hand", "roundoff",
      "friction",    "impact_friction",     "zeno_completion",   "projection"};
  return names[static_cast<std::size_t>(line)];
}

void EnergyLedger::open(double kinetic, double potential) {
  *this = EnergyLedger{};
  initial_kinetic_ = kinetic;
  initial_potential_ = potential;
  balance(kinetic, potential);
}

double EnergyLedger::unexplained() const {
  CompensatedSum rest;
  rest.add(kinetic_);
  rest.add(-initial_kinetic_);
  rest.add(potential_);
  rest.add(-initial_potential_);
  for (const CompensatedSum& line : lines_) {
    if (const double value = line.value(); value != 0.0) {
      rest.add(-value);
    }
  }
  return rest.value();
}

void CompensatedSum::persist(Archive& archive) { archive(sum_, correction_); }

void EnergyLedger::persist(Archive& archive) {
  archive(initial_kinetic_, initial_potential_, kinetic_, potential_, lines_, flow_);
}

}  // namespace core
}  // namespace kairos
