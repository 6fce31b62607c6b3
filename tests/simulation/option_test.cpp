#include "simulation/option.hpp"

#include "core/error.hpp"
#include "tests/catch.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <utility>

namespace kairos {
namespace {

RunChoice with_frame() { return {.frames = FixedFrames{0.5}}; }

/// A value that is not the default.
OptionValue another(const Option& option) {
  switch (option.kind) {
    case OptionKind::name:
      return std::string("another");
    case OptionKind::flag:
      return true;
    case OptionKind::frames:
    case OptionKind::duration:
      return std::string("0.25");
    case OptionKind::count:
      return 7.0;
    case OptionKind::number:
      break;
  }
  return option.range.contains(0.125)
             ? 0.125
             : 0.25 * option.range.lowest + 0.75 * std::min(option.range.highest, 3.0);
}

std::string message(std::string_view name, const OptionValue& value) {
  RunChoice choice = with_frame();
  try {
    set_option(choice, name, value);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("every option changes the identity of a run") {
  for (const Option& option : options()) {
    CAPTURE(option.name);
    RunChoice choice = with_frame();
    set_option(choice, option.name, another(option));
    CHECK(identity_of(choice) != identity_of(with_frame()));
  }
}

TEST_CASE("listed frame times are part of the identity, whatever their file is called") {
  RunChoice one{.frames = ListedFrames{.durations = {0.1, 0.2}, .path = "frames.csv"}};
  RunChoice other{.frames = ListedFrames{.durations = {0.1, 0.3}, .path = "frames.csv"}};
  CHECK(identity_of(one) != identity_of(other));
}

TEST_CASE("an option reads back what it tells") {
  for (const Option& option : options()) {
    CAPTURE(option.name);
    RunChoice told = with_frame();
    set_option(told, option.name, another(option));
    RunChoice read = with_frame();
    set_option(read, option.name, option.get(told));
    CHECK(identity_of(read) == identity_of(told));
  }
}

TEST_CASE("names and flags of options are unique, and every option says what it is") {
  std::set<std::string_view> names, flags;
  for (const Option& option : options()) {
    CAPTURE(option.name);
    CHECK(names.insert(option.name).second);
    CHECK(flags.insert(option.flag).second);
    CHECK_FALSE(option.help.empty());
    CHECK(find_option(option.name) == &option);
  }
}

TEST_CASE("numbers outside of an option's range are refused, with the range") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Option& option : options()) {
    if (option.kind != OptionKind::number && option.kind != OptionKind::count) {
      continue;
    }
    CAPTURE(option.name);
    for (const double wrong : {nan, infinity, -infinity, -1.0}) {
      const std::string text = message(option.name, wrong);
      CHECK(text.find(std::string(option.name)) != std::string::npos);
      CHECK(text.find("allowed") != std::string::npos);
    }
    CHECK_FALSE(message(option.name, std::string("nan")).empty());
    CHECK_FALSE(message(option.name, std::string("")).empty());
    CHECK_FALSE(message(option.name, true).empty());
  }
  CHECK(message("frame_jitter", 1.0) == "frame_jitter: is 1; allowed: a number from 0 to 0.999");
  CHECK_FALSE(message("absolute_tolerance", 0.0).empty());
  CHECK_FALSE(message("max_substeps", 2.5).empty());
}

TEST_CASE("names, flags and durations take values of their kind only") {
  CHECK_FALSE(message("scheme", 1.0).empty());
  CHECK_FALSE(message("scheme", true).empty());
  CHECK_FALSE(message("roundoff", 2.0).empty());
  CHECK_FALSE(message("roundoff", std::string("maybe")).empty());
  CHECK_FALSE(message("duration", std::string("long")).empty());
  CHECK_FALSE(message("duration", -1.0).empty());
  CHECK(message("duration", std::string("16ms")).empty());
  CHECK(message("duraton", 1.0).find("duration") != std::string::npos);
}

TEST_CASE("options are set in an order of their own: jitter finds the frame that comes after it") {
  const std::pair<std::string, OptionValue> settings[] = {
      {"frame_jitter", 0.25}, {"frame", std::string("1/64")}, {"frame_seed", 9.0}};
  RunChoice choice;
  set_options(choice, settings);
  REQUIRE(choice.frames.has_value());
  const auto& frames = std::get<JitteredFrames>(*choice.frames);
  CHECK(frames.mean == 1.0 / 64.0);
  CHECK(frames.jitter == 0.25);
  CHECK(frames.seed == 9);
  RunChoice without;
  CHECK_THROWS_AS(set_option(without, "frame_jitter", 0.25), InputError);
}

}  // namespace kairos
