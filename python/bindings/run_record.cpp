#include "python/bindings/run_record.hpp"

#include "simulation/view/view_page.hpp"

#include <fmt/format.h>

#include "python/bindings/arrays.hpp"
#include <stdexcept>

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
      event_listener_(method_of(listener, "event")) {
  if (keep_motions) {
    viewer_.emplace();
  }
}

template <typename Tell>
void RunKeeper::view(const Tell& tell) {
  if (viewer_) {
    try {
      tell(*viewer_);
    } catch (const std::length_error&) {
      viewer_.reset();  // the run goes on without a page
    }
  }
}

void RunKeeper::begin(const Model& model) {
  model_ = &model;
  view([&](ViewRecorder& viewer) { viewer.begin(model); });
  trajectory_.begin(model);
  metrics_.begin(model);
}

void RunKeeper::frame(const Frame& frame) {
  interrupts_.look();
  times_.push_back(frame.time.seconds);
  states_.insert(states_.end(), frame.bodies.begin(), frame.bodies.end());
  ledger_.push_back(row_of(frame));
  metrics_.frame(frame);
  view([&](ViewRecorder& viewer) { viewer.frame(frame); });
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

void RunKeeper::motion(BodyIndex body, const Motion& motion) {
  trajectory_.motion(body, motion);
  view([&](ViewRecorder& viewer) { viewer.motion(body, motion); });
}

void RunKeeper::event(const Event& event) {
  interrupts_.look();
  trajectory_.event(event);
  metrics_.event(event);
  view([&](ViewRecorder& viewer) { viewer.event(event); });
  if (!event_listener_.is_none()) {
    const py::gil_scoped_acquire lock;
    event_listener_(events_array(*model_, {event})[py::int_(0)]);
  }
}

std::optional<ViewRun> RunKeeper::finish_view() {
  std::optional<ViewRun> run;
  if (viewer_) {
    run = std::move(*viewer_).finish();
    viewer_.reset();
  }
  return run;
}

std::string page_of(const std::string& page_template, const std::vector<const RunRecord*>& runs) {
  std::vector<ViewRun> shown;
  for (const RunRecord* run : runs) {
    if (!run->view) {
      throw std::invalid_argument(
          fmt::format("the run of '{}' kept no motions, or more than a page can hold; run with "
                      "motions=True, or for a shorter time",
                      run->model->scene().name));
    }
    shown.push_back(*run->view);
    const MethodChoice& method = run->choice.method;
    shown.back().method = fmt::format("{} + {} + {} + {}", method.scheme, method.integrator,
                                      method.detector, method.impact);
    if (run->result.status == RunStatus::stopped) {
      shown.back().reason = run->result.reason;
    }
  }
  return view_page(page_template, shown);
}

}  // namespace kairos::python
