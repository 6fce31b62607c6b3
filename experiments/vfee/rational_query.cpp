#include "ccd/linear/exact_integer.hpp"
#include "core/reading/csv.hpp"
#include "experiments/vfee/vfee_query.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

namespace kairos::experiments {
namespace {

constexpr std::size_t fields_per_row = 7;
constexpr std::array names{"x numerator", "x denominator", "y numerator", "y denominator",
                           "z numerator", "z denominator", "truth"};

using Fields = std::array<std::string_view, fields_per_row>;

/// The fields of a line; nothing if there are more or fewer.
std::optional<Fields> split(std::string_view line) {
  Fields fields;
  for (std::size_t i = 0; i < fields_per_row; ++i) {
    const std::size_t comma = line.find(',');
    if ((comma == std::string_view::npos) != (i + 1 == fields_per_row)) {
      return std::nullopt;
    }
    fields[i] = trimmed(line.substr(0, comma));
    line.remove_prefix(comma == std::string_view::npos ? line.size() : comma + 1);
  }
  return fields;
}

bool is_whole(std::string_view text) {
  if (text.starts_with('-')) {
    text.remove_prefix(1);
  }
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

ccd::ExactInteger whole(std::string_view text) {
  const bool negative = text.starts_with('-');
  text.remove_prefix(negative ? 1 : 0);
  ccd::ExactInteger value;
  while (!text.empty()) {
    const std::string_view part = text.substr(0, 18);
    text.remove_prefix(part.size());
    std::int64_t digits = 0;
    std::from_chars(part.data(), part.data() + part.size(), digits);
    std::int64_t power = 1;
    for (std::size_t i = 0; i < part.size(); ++i) {
      power *= 10;
    }
    value = value * ccd::ExactInteger(power) + ccd::ExactInteger(digits);
  }
  if (negative) {
    value.negate();
  }
  return value;
}

/// The double that is exactly the quotient, if there is one.
std::optional<double> double_of_quotient(const ccd::ExactInteger& numerator,
                                         const ccd::ExactInteger& denominator) {
  if (numerator.is_zero()) {
    return 0.0;
  }
  const int shift = numerator.bit_length() - denominator.bit_length();
  const double near = std::ldexp(
      numerator.scaled(numerator.bit_length()) / denominator.scaled(denominator.bit_length()),
      shift);
  for (const double x : {near, std::nextafter(near, -ccd::LinearImpact::never),
                         std::nextafter(near, ccd::LinearImpact::never)}) {
    if (x == 0.0 || !std::isfinite(x)) {
      continue;
    }
    const int exponent = std::min(0, ccd::ExactInteger::lowest_exponent(x));
    const ccd::ExactInteger product = ccd::ExactInteger::from_double(x, exponent) * denominator;
    if ((product - (numerator << -exponent)).is_zero()) {
      return x;
    }
  }
  return std::nullopt;
}

double read_number(const Fields& fields, std::size_t axis, std::size_t row) {
  const std::string_view numerator = fields[2 * axis];
  const std::string_view denominator = fields[2 * axis + 1];
  constexpr std::size_t most_digits = 1100;  // more than any double has
  for (std::size_t i = 2 * axis; i < 2 * axis + 2; ++i) {
    if (!is_whole(fields[i]) || fields[i].size() > most_digits) {
      throw BadField{names[i],
                     fmt::format("'{}' is not allowed; allowed: whole numbers", fields[i]), row};
    }
  }
  const ccd::ExactInteger divisor = whole(denominator);
  if (divisor.sign() <= 0) {
    throw BadField{names[2 * axis + 1],
                   fmt::format("'{}' is not allowed; allowed: whole numbers > 0", denominator),
                   row};
  }
  const std::optional<double> value = double_of_quotient(whole(numerator), divisor);
  if (!value) {
    throw BadField{names[2 * axis],
                   fmt::format("{}/{} is no double; an exact answer would be one to another "
                               "question",
                               numerator, denominator),
                   row};
  }
  return *value;
}

}  // namespace

bool is_rational_row(std::string_view line) {
  const std::optional<Fields> fields = split(line);
  return fields && std::all_of(fields->begin(), fields->end(), is_whole);
}

RationalQuery read_rational_query(std::span<const std::string_view> rows, ccd::LinearKind kind) {
  RationalQuery result;
  result.query.kind = kind;
  std::string_view truth;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::optional<Fields> fields = split(rows[row]);
    if (!fields) {
      throw BadField{
          "", "has not seven fields; needed: x, y, z as numerator,denominator, and truth", row};
    }
    Vector3& point = (row < 4 ? result.query.start : result.query.end)[row % 4];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      point[static_cast<Eigen::Index>(axis)] = read_number(*fields, axis, row);
    }
    const std::string_view told = fields->back();
    if ((told != "0" && told != "1") || (row > 0 && told != truth)) {
      throw BadField{
          "truth",
          fmt::format("'{}' is not allowed; allowed: 0 or 1, the same in all eight rows", told),
          row};
    }
    truth = told;
  }
  result.meets = truth == "1";
  return result;
}

}  // namespace kairos::experiments
