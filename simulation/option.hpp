#pragma once

#include "core/reading/table_reader.hpp"
#include "simulation/simulate.hpp"

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace kairos {
inline namespace simulation {

/// What a value of an option is.
enum class OptionKind {
  name,      ///< of a plug-in, see `kairos list`
  number,    ///< finite, within the option's range
  count,     ///< a whole number
  flag,      ///< true or false
  duration,  ///< seconds: a number, "16ms", "1/60"
  frames,    ///< a duration, or the path of a CSV of frame times
};

/// A value as a person gives it: text as on a command line, or a typed value as in a spec.
using OptionValue = std::variant<std::string, double, bool>;

/// One option of a run. The table of them is the one place that knows its name, unit, range,
/// default and meaning: the command line, sweep specs, summaries, checkpoints, the identity of a
/// run and bindings read it from here.
struct Option {
  std::string_view name;  ///< in specs, summaries and bindings
  std::string_view flag;  ///< on the command line, without the leading --
  OptionKind kind = OptionKind::number;
  Range range = {};  ///< of numbers and counts, with the unit
  std::string_view help;
  /// The value as text that `set_option` takes; "" where the scene or the method decides.
  std::string (*get)(const RunChoice& choice) = nullptr;
  /// Sets a value that was checked: `text` for names and frames, `number` for the rest.
  void (*put)(RunChoice& choice, double number, const std::string& text) = nullptr;

  /// The default, as text.
  [[nodiscard]] std::string default_text() const { return get(RunChoice{}); }
};

/// All options, in the order in which they are set: what others build on comes first.
[[nodiscard]] std::span<const Option> options();
/// nullptr if there is none of that name.
[[nodiscard]] const Option* find_option(std::string_view name);
/// "scheme, integrator, ...": for messages.
[[nodiscard]] std::string option_names();

/// Sets one option. Throws `InputError` with the option as key and what is allowed: an unknown
/// name, a value of the wrong kind or out of range, frame jitter without a frame.
void set_option(RunChoice& choice, std::string_view name, const OptionValue& value);

/// The name of an option and what it is set to.
using OptionSetting = std::pair<std::string, OptionValue>;
/// Sets several, whatever their order: of one name the last counts.
void set_options(RunChoice& choice, std::span<const OptionSetting> settings);

/// Everything that tells one choice from another: names and values of all options, and what listed
/// frame times are. Two choices with the same identity give the same run of a scene.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> identity_of(const RunChoice& choice);

}  // namespace simulation
}  // namespace kairos
