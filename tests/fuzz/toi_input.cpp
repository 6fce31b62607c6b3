// The input of `kairos toi`: any text is either refused with a reason, or answered with a bracket
// that is finite and within the window.
#include "ccd/certified.hpp"
#include "core/error.hpp"
#include "experiments/toi/toi_query.hpp"
#include "tests/fuzz/fuzz_target.hpp"

#include <cmath>
#include <string_view>

using namespace kairos;
using namespace kairos::experiments;
using kairos::fuzz::require;

namespace {

constexpr int most_rows = 4;

std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

void answer(const ToiQuery& query) {
  static const auto detector = ccd::make_certified();
  // What takes long is bounded, and tested elsewhere; here a turn of 1e3 rad is enough.
  if ((query.motion_a.rotation_rate.norm() + query.motion_b.rotation_rate.norm()) * query.duration >
      1e3) {
    return;
  }
  const TimeOfImpact toi =
      detector->time_of_impact({query.shape_a, query.motion_a}, {query.shape_b, query.motion_b},
                               {Instant{}, query.duration}, 0.0);
  require(std::isfinite(toi.t_lo) && toi.t_lo >= 0.0, "t_lo is no time of the window");
  require(toi.t_hi >= toi.t_lo && toi.t_hi <= query.duration,
          "t_hi is before t_lo or beyond the window");
  require(toi.gap >= 0.0, "the gap is no distance");
}

void read(std::string_view text) {
  const ToiQueryFormat format(take_line(text), 1, "input");
  ToiQueryFormat::Scratch scratch;
  for (int row = 0; row < most_rows && !text.empty(); ++row) {
    const std::string_view line = take_line(text);
    try {
      answer(format.read(line, scratch));
    } catch (const BadField& bad) {
      require(!bad.reason.empty(), "a row is refused without a reason");
      static_cast<void>(format.id(line, scratch));
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    read({reinterpret_cast<const char*>(data), size});
  } catch (const InputError& error) {
    require(!error.reason().empty(), "a header is refused without a reason");
  }
  return 0;
}
