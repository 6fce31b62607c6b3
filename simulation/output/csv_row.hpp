#pragma once

#include "core/pose.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace kairos {
inline namespace simulation {

/// One line of a CSV file, built in a buffer that is used again and again. Numbers are written in
/// the shortest form that reads back the same, NaN and infinity as an empty field; text is quoted
/// where it must be (RFC 4180).
class CsvRow {
 public:
  CsvRow& text(std::string_view value);
  /// A field of another CSV file, quotes included.
  CsvRow& field(std::string_view value);
  CsvRow& number(double value);
  CsvRow& count(std::int64_t value);
  CsvRow& vector(const Vector3& value);
  /// As w, x, y, z.
  CsvRow& quaternion(const Quaternion& value);

  /// Ends the line and returns it; valid until the next call of any other function.
  [[nodiscard]] std::string_view finish();

 private:
  void separate();

  std::string line_;
  bool finished_ = true;
};

}  // namespace simulation
}  // namespace kairos
