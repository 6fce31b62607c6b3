// The input of `kairos vfee`, in both formats: any text is refused with a reason, or answered.
#include "core/error.hpp"
#include "experiments/vfee/vfee_query.hpp"
#include "tests/fuzz/fuzz_target.hpp"

#include <cmath>
#include <string_view>
#include <vector>

using namespace kairos;
using namespace kairos::experiments;
using kairos::fuzz::require;

namespace {

constexpr std::size_t most_rows = 8;

std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

/// What takes long, a separation and exponents far apart, is bounded and tested elsewhere.
void answer(ccd::LinearQuery query) {
  query.separation = 0.0;
  const ccd::LinearImpact impact = ccd::linear_impact(query);
  require(impact.hit == std::isfinite(impact.t_lo), "a hit without a time, or a time without one");
}

void read_columns(std::string_view text) {
  const VfeeFormat format(take_line(text), 1, "input");
  std::vector<std::string_view> fields;
  for (std::size_t row = 0; row < most_rows && !text.empty(); ++row) {
    const std::string_view line = take_line(text);
    try {
      answer(format.read(line, fields).query);
    } catch (const BadField& bad) {
      require(!bad.reason.empty(), "a row is refused without a reason");
      static_cast<void>(format.id(line, fields));
    }
  }
}

void read_rationals(std::string_view text) {
  std::vector<std::string_view> rows;
  while (rows.size() < most_rows && !text.empty()) {
    rows.push_back(take_line(text));
  }
  if (rows.size() < most_rows) {
    return;
  }
  try {
    answer(read_rational_query(rows, ccd::LinearKind::edge_edge).query);
  } catch (const BadField& bad) {
    require(!bad.reason.empty() && bad.row < most_rows, "a row is refused without a reason");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (is_rational_row(text.substr(0, text.find('\n')))) {
    read_rationals(text);
    return 0;
  }
  try {
    read_columns(text);
  } catch (const InputError& error) {
    require(!error.reason().empty(), "a header is refused without a reason");
  }
  return 0;
}
