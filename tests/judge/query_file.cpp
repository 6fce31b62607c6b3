#include "tests/judge/query_file.hpp"

#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

namespace kairos::judge {
namespace {

using Row = std::map<std::string, std::string>;

std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> all;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) {
    all.push_back(field);
  }
  return all;
}

double number(const Row& row, const std::string& column, double otherwise) {
  const auto found = row.find(column);
  if (found == row.end() || found->second.empty()) {
    return otherwise;
  }
  std::size_t used = 0;
  const double value = std::stod(found->second, &used);
  if (used != found->second.size()) {
    throw std::runtime_error(column + ": not a number: " + found->second);
  }
  return value;
}

Vector3 vector(const Row& row, const std::string& prefix, const char* names) {
  Vector3 v;
  for (int i = 0; i < 3; ++i) {
    v[i] = number(row, prefix + names + static_cast<char>('x' + i), 0.0);
  }
  return v;
}

Body body_of(const Row& row, const std::string& prefix) {
  Body body;
  const auto shape = row.find(prefix + "shape");
  if (shape != row.end()) {
    body.kind = shape->second == "sphere"       ? Kind::sphere
                : shape->second == "half-space" ? Kind::half_space
                                                : Kind::box;
  }
  body.half_extents = vector(row, prefix, "h");
  body.position = vector(row, prefix, "p");
  body.orientation = Quaternion(number(row, prefix + "qw", 1), number(row, prefix + "qx", 0),
                                number(row, prefix + "qy", 0), number(row, prefix + "qz", 0));
  body.velocity = vector(row, prefix, "v");
  body.acceleration = vector(row, prefix, "a");
  body.spin = vector(row, prefix, "w");
  const Vector3 normal = vector(row, prefix, "n");
  if (normal.squaredNorm() > 0.0) {
    body.normal = normal;
  }
  body.error_radius = number(row, prefix + "error", 0.0);
  body.age = number(row, prefix + "age", 0.0);
  return body;
}

}  // namespace

std::vector<Query> read_queries(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) {
    throw std::runtime_error(path + ": cannot be read");
  }
  const std::vector<std::string> header = fields(line);
  std::vector<Query> queries;
  while (std::getline(file, line)) {
    const std::vector<std::string> values = fields(line);
    Row row;
    for (std::size_t i = 0; i < header.size() && i < values.size(); ++i) {
      row[header[i]] = values[i];
    }
    Query query;
    query.id = row["id"];
    query.family = row["class"].empty() ? "file" : row["class"];
    query.a = body_of(row, "a_");
    query.b = body_of(row, "b_");
    query.duration = number(row, "duration", 1.0);
    query.tolerance = number(row, "tolerance", 0.0);
    query.start = Instant{} + number(row, "start", 0.0);
    queries.push_back(query);
  }
  return queries;
}

}  // namespace kairos::judge
