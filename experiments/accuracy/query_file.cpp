#include "experiments/accuracy/query_file.hpp"

#include "simulation/output/csv_row.hpp"

namespace kairos::experiments {
namespace {

void add(CsvRow& row, const Shape& shape, const Motion& motion) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    row.vector(Vector3::Constant(sphere->radius));
  } else if (const auto* box = std::get_if<Box>(&shape)) {
    row.vector(box->half_extents);
  } else {
    row.vector(Vector3::Ones());
  }
  const auto coefficient = [&motion](int k) {
    return k <= motion.position.degree() ? Vector3(motion.position[k]) : Vector3(Vector3::Zero());
  };
  row.vector(coefficient(0));
  const Vector4& q = motion.quaternion[0];
  row.quaternion(Quaternion(q[0], q[1], q[2], q[3]));
  row.vector(coefficient(1)).vector(2.0 * coefficient(2));
  row.vector(motion.rotation_rate);
}

}  // namespace

std::string query_file_header() {
  CsvRow row;
  row.text("id");
  for (const std::string body : {"a_", "b_"}) {
    for (const char* name : {"hx", "hy", "hz", "px", "py", "pz", "qw", "qx", "qy", "qz", "vx", "vy",
                             "vz", "ax", "ay", "az", "wx", "wy", "wz"}) {
      row.text(body + name);
    }
  }
  row.text("duration").text("a_shape").text("b_shape");
  return std::string(row.finish());
}

std::string query_file_row(std::size_t id, const reference::Query& query) {
  CsvRow row;
  row.count(static_cast<std::int64_t>(id));
  add(row, query.a, query.motion_a);
  add(row, query.b, query.motion_b);
  row.number(query.duration).text(shape_name(query.a)).text(shape_name(query.b));
  return std::string(row.finish());
}

}  // namespace kairos::experiments
