#include "experiments/sweeps/sweep_method.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

namespace kairos::experiments {
namespace {

constexpr std::array<std::string_view, 4> text_options = {"scheme", "integrator", "detector",
                                                          "impact"};

struct NumberOption {
  std::string_view name;
  double least;
  bool least_included;
  double most;
};
constexpr double large = 1e300;
constexpr std::array<NumberOption, 15> number_options = {{
    {"frame", 0.0, false, large},
    {"frame_jitter", 0.0, true, 0.999},
    {"spike_probability", 0.0, true, 1.0},
    {"spike_factor", 1.0, true, 1e6},
    {"duration", 0.0, false, large},
    {"step", 0.0, false, large},
    {"threshold", 0.0, false, large},
    {"equal_substeps", 0.0, true, 1.0},
    {"max_substeps", 1.0, true, 1e15},
    {"toi_tolerance", 0.0, true, large},
    {"relative_tolerance", 0.0, false, 1.0},
    {"absolute_tolerance", 0.0, false, large},
    {"fixed_step", 0.0, true, 1.0},
    {"cold_restarts", 0.0, true, 1.0},
    {"roundoff", 0.0, true, 1.0},
}};

}  // namespace

bool is_text_option(std::string_view name) {
  return std::find(text_options.begin(), text_options.end(), name) != text_options.end();
}

bool is_method_option(std::string_view name) {
  return is_text_option(name) ||
         std::any_of(number_options.begin(), number_options.end(),
                     [name](const NumberOption& option) { return option.name == name; });
}

std::string method_option_names() {
  std::string out = fmt::format("{}", fmt::join(text_options, ", "));
  for (const NumberOption& option : number_options) {
    out += fmt::format(", {}", option.name);
  }
  return out;
}

void MethodOptions::set_text(std::string_view name, const std::string& value) {
  MethodChoice& method = choice_.method;
  std::string* const members[] = {&method.scheme, &method.integrator, &method.detector,
                                  &method.impact};
  for (std::size_t i = 0; i < text_options.size(); ++i) {
    if (text_options[i] == name) {
      *members[i] = value;
      return;
    }
  }
  throw std::invalid_argument(fmt::format("'{}' takes a number, not a name", name));
}

void MethodOptions::set_number(std::string_view name, double value) {
  const auto* option =
      std::find_if(number_options.begin(), number_options.end(),
                   [name](const NumberOption& known) { return known.name == name; });
  if (option == number_options.end()) {
    throw std::invalid_argument(fmt::format("'{}' takes a name in quotes, not a number", name));
  }
  if (!(value > option->least || (option->least_included && value == option->least)) ||
      value > option->most) {
    throw std::invalid_argument(fmt::format("{} = {} is out of range; allowed: {} {} to {}", name,
                                            value, option->least_included ? "from" : "above",
                                            option->least, option->most));
  }
  const bool flag = value != 0.0;
  if (name == "frame") {
    frame_ = value;
  } else if (name == "frame_jitter") {
    jitter_ = value;
  } else if (name == "spike_probability") {
    spike_probability_ = value;
  } else if (name == "spike_factor") {
    spike_factor_ = value;
  } else if (name == "duration") {
    choice_.duration = value;
  } else if (name == "step") {
    choice_.step = value;
  } else if (name == "threshold") {
    choice_.threshold = value;
  } else if (name == "equal_substeps") {
    choice_.equal_substeps = flag;
  } else if (name == "max_substeps") {
    choice_.max_substeps = static_cast<std::int64_t>(value);
  } else if (name == "toi_tolerance") {
    choice_.toi_tolerance = value;
  } else if (name == "relative_tolerance") {
    choice_.stepper.relative_tolerance = value;
  } else if (name == "absolute_tolerance") {
    choice_.stepper.absolute_tolerance = value;
  } else if (name == "fixed_step") {
    const double off = std::numeric_limits<double>::infinity();  // see StepperOptions
    choice_.stepper = flag ? StepperOptions{off, off} : StepperOptions{};
  } else if (name == "cold_restarts") {
    choice_.cold_restarts = flag;
  } else {
    choice_.roundoff = flag;
  }
}

RunChoice MethodOptions::choice(std::uint64_t seed) const {
  RunChoice choice = choice_;
  if (!frame_) {
    if (jitter_ > 0.0 || spike_probability_ > 0.0) {
      throw std::invalid_argument("frame_jitter and spike_probability need a frame");
    }
    return choice;
  }
  if (jitter_ > 0.0 || spike_probability_ > 0.0) {
    choice.frames = JitteredFrames{*frame_, jitter_, spike_probability_, spike_factor_, seed};
  } else {
    choice.frames = FixedFrames{*frame_};
  }
  return choice;
}

}  // namespace kairos::experiments
