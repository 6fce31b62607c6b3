#include "python/bindings/arrays.hpp"

namespace py = pybind11;

namespace kairos::python {

py::array states_view(const std::vector<BodyState>& states, std::size_t bodies, py::ssize_t offset,
                      const py::handle& owner) {
  const auto columns = static_cast<py::ssize_t>(bodies);
  const auto rows = bodies == 0 ? 0 : static_cast<py::ssize_t>(states.size() / bodies);
  const auto* first = reinterpret_cast<const char*>(states.data()) + offset;
  py::array view(py::dtype::of<double>(), {rows, columns, py::ssize_t{3}},
                 {columns * StateLayout::stride, StateLayout::stride,
                  static_cast<py::ssize_t>(sizeof(double))},
                 states.empty() ? nullptr : first, owner);
  view.attr("flags").attr("writeable") = false;
  return view;
}

py::array orientations_of(const std::vector<BodyState>& states, std::size_t bodies) {
  const std::size_t rows = bodies == 0 ? 0 : states.size() / bodies;
  py::array_t<double> copy({rows, bodies, std::size_t{4}});
  double* out = copy.mutable_data();
  for (const BodyState& state : states) {
    const Quaternion& q = state.pose.orientation;
    for (const double x : {q.w(), q.x(), q.y(), q.z()}) {
      *out++ = x;
    }
  }
  return copy;
}

RecordType& RecordType::field(const std::string& name, const std::string& format) {
  fields_.append(py::make_tuple(name, format));
  return *this;
}

py::dtype RecordType::dtype() const { return py::dtype::from_args(fields_); }

}  // namespace kairos::python
