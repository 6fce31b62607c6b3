#pragma once

#include "core/reading/csv.hpp"
#include "experiments/accuracy/query.hpp"
#include "tests/locations.hpp"

#include <fstream>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

/// Queries that once were answered wrongly, in the format of `kairos toi`, from
/// `tests/ccd/queries`.
namespace kairos::reference {

struct QueryRow {
  std::string id;
  Query query;
};

/// One body of a row: the values of its columns by name.
class RowBody {
 public:
  RowBody(const std::unordered_map<std::string, std::string>& fields, std::string prefix)
      : fields_(fields), prefix_(std::move(prefix)) {}

  [[nodiscard]] Shape shape() const {
    const std::string& kind = fields_.at(prefix_ + "shape");
    if (kind == "sphere") {
      return Sphere{number("hx")};
    }
    if (kind == "half-space") {
      return HalfSpace{};
    }
    return Box{vector("h")};
  }
  [[nodiscard]] Motion motion(double duration) const {
    const Quaternion q(number("qw"), number("qx"), number("qy"), number("qz"));
    return Motion::ballistic({}, duration, {vector("p"), q.normalized()},
                             {vector("v"), vector("w")}, vector("a"));
  }

 private:
  [[nodiscard]] double number(const std::string& name) const {
    return parse_number(fields_.at(prefix_ + name)).value();
  }
  [[nodiscard]] Vector3 vector(const std::string& name) const {
    return {number(name + "x"), number(name + "y"), number(name + "z")};
  }

  const std::unordered_map<std::string, std::string>& fields_;
  std::string prefix_;
};

inline std::vector<QueryRow> query_rows(const std::string& file) {
  std::ifstream in(tests::source_path("tests/ccd/queries/" + file));
  std::string line;
  if (!std::getline(in, line)) {
    throw std::runtime_error(file + " cannot be read");
  }
  const auto fields_of = [](const std::string& row) {
    std::vector<std::string_view> fields;
    if (!split_fields(row, fields)) {
      throw std::runtime_error("a quote that does not end: " + row);
    }
    return std::vector<std::string>(fields.begin(), fields.end());
  };
  const std::vector<std::string> names = fields_of(line);
  std::vector<QueryRow> rows;
  while (std::getline(in, line)) {
    const std::vector<std::string> values = fields_of(line);
    std::unordered_map<std::string, std::string> fields;
    for (std::size_t i = 0; i < names.size(); ++i) {
      fields[names[i]] = values.at(i);
    }
    const double duration = parse_number(fields.at("duration")).value();
    const RowBody a(fields, "a_");
    const RowBody b(fields, "b_");
    rows.push_back({fields.at("id"),
                    {a.shape(), b.shape(), a.motion(duration), b.motion(duration), duration}});
  }
  return rows;
}

}  // namespace kairos::reference
