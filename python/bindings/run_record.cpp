#include "python/bindings/run_record.hpp"

#include "python/bindings/arrays.hpp"

namespace py = pybind11;

namespace kairos::python {
namespace {

/// A method of the listener; None where it has none.
py::object method_of(const py::object& listener, const char* name) {
  return listener.is_none() ? py::object(py::none())
                            : py::object(py::getattr(listener, name, py::none()));
}

LedgerRow row_of(const Frame& frame) {
  LedgerRow row{.frame = frame.index, .time = frame.time.seconds};
  row.kinetic = frame.ledger.kinetic();
  row.potential = frame.ledger.potential();
  for (std::size_t i = 0; i < energy_line_count; ++i) {
    row.lines[i] = frame.ledger.line(static_cast<EnergyLine>(i));
  }
  row.unexplained = frame.ledger.unexplained();
  row.flow = frame.ledger.flow();
  return row;
}

}  // namespace

RunKeeper::RunKeeper(bool keep_motions, const py::object& listener)
    : keep_motions_(keep_motions),
      frame_listener_(method_of(listener, "frame")),
      event_listener_(method_of(listener, "event")) {}

void RunKeeper::begin(const Model& model) {
  model_ = &model;
  trajectory_.begin(model);
  metrics_.begin(model);
}

void RunKeeper::frame(const Frame& frame) {
  interrupts_.look();
  times_.push_back(frame.time.seconds);
  states_.insert(states_.end(), frame.bodies.begin(), frame.bodies.end());
  ledger_.push_back(row_of(frame));
  metrics_.frame(frame);
  if (!frame_listener_.is_none()) {
    tell_frame(frame);
  }
}

void RunKeeper::tell_frame(const Frame& frame) {
  const py::gil_scoped_acquire lock;
  const std::vector<BodyState> now(frame.bodies.begin(), frame.bodies.end());
  const auto copy_of = [&](py::ssize_t offset) -> py::object {
    const py::array view = states_view(now, now.size(), offset, py::none());
    return view.attr("copy")().attr("__getitem__")(0);
  };
  const py::object states =
      py::module_::import("kairos.states")
          .attr("States")(copy_of(StateLayout::position),
                          orientations_of(now, now.size())[py::int_(0)],
                          copy_of(StateLayout::linear), copy_of(StateLayout::angular));
  frame_listener_(frame.index, frame.time.seconds, states);
}

void RunKeeper::motion(BodyIndex body, const Motion& motion) { trajectory_.motion(body, motion); }

void RunKeeper::event(const Event& event) {
  interrupts_.look();
  trajectory_.event(event);
  metrics_.event(event);
  if (!event_listener_.is_none()) {
    const py::gil_scoped_acquire lock;
    event_listener_(events_array(*model_, {event})[py::int_(0)]);
  }
}

}  // namespace kairos::python
