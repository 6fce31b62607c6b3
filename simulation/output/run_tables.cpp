#include "simulation/output/run_tables.hpp"

#include <string>

namespace kairos {
inline namespace simulation {
namespace {

/// Names of the columns of one body in one event: position, velocity, angular velocity.
std::string state_columns(const std::string& prefix) {
  std::string columns;
  for (const char* name : {"px", "py", "pz", "vx", "vy", "vz", "wx", "wy", "wz"}) {
    columns += "," + prefix + name;
  }
  return columns;
}

void append_state(CsvRow& row, const BodyState& state) {
  row.vector(state.pose.position).vector(state.twist.linear).vector(state.twist.angular);
}

std::string energy_columns() {
  std::string columns = "frame,t,kinetic,potential";
  for (std::size_t i = 0; i < energy_line_count; ++i) {
    columns += "," + std::string(to_string(static_cast<EnergyLine>(i)));
  }
  return columns + ",unexplained,flow\n";
}

}  // namespace

void RunTables::begin(const Model& model) {
  model_ = &model;
  sinks_.trajectory("t,body,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n");
  sinks_.events("t,t_correction,kind,a,b,gap,px,py,pz,nx,ny,nz" + state_columns("a_before_") +
                state_columns("a_after_") + state_columns("b_before_") + state_columns("b_after_") +
                ",grade,bracket,flag\n");
  sinks_.energy(energy_columns());
}

void RunTables::frame(const Frame& frame) {
  for (std::size_t i = 0; i < frame.bodies.size(); ++i) {
    const BodyState& state = frame.bodies[i];
    row_.number(frame.time.seconds).text(model_->body(i).name);
    row_.vector(state.pose.position).quaternion(state.pose.orientation);
    row_.vector(state.twist.linear).vector(state.twist.angular);
    sinks_.trajectory(row_.finish());
  }
  write_energy(frame);
}

void RunTables::write_energy(const Frame& frame) {
  const EnergyLedger& ledger = frame.ledger;
  row_.count(frame.index).number(frame.time.seconds);
  row_.number(ledger.kinetic()).number(ledger.potential());
  for (std::size_t i = 0; i < energy_line_count; ++i) {
    row_.number(ledger.line(static_cast<EnergyLine>(i)));
  }
  row_.number(ledger.unexplained()).number(ledger.flow());
  sinks_.energy(row_.finish());
}

void RunTables::event(const Event& event) {
  row_.number(event.time.seconds).number(event.time.correction).text(to_string(event.kind));
  row_.text(model_->body(event.a).name).text(model_->body(event.b).name);
  row_.number(event.contact.gap).vector(event.contact.point).vector(event.contact.normal);
  append_state(row_, event.before_a);
  append_state(row_, event.after_a);
  append_state(row_, event.before_b);
  append_state(row_, event.after_b);
  row_.text(changes_contact(event.kind) ? to_string(event.grade) : "");
  row_.number(event.bracket).text(to_string(event.flag));
  sinks_.events(row_.finish());
}

}  // namespace simulation
}  // namespace kairos
