#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace kairos::experiments {

// Commands and their arguments. CLI11 keeps and parses them; its header, which takes seconds to
// compile, is read by `command_line.cpp` and `cli.cpp` alone.

/// What a person may write behind an option.
struct Check {
  std::string range;  ///< for `--help`; may be empty
  /// Why this is not allowed; empty if it is.
  std::function<std::string(const std::string&)> why_not;
};

/// An option, a flag or a positional argument of a command; a handle, valid while the command is.
class Argument {
 public:
  explicit Argument(CLI::Option& option) : option_(&option) {}

  Argument& check(Check check);
  /// One of these words.
  Argument& one_of(std::initializer_list<std::string> words);
  Argument& required();
  /// What `--help` calls the value.
  Argument& type_name(const std::string& name);
  Argument& description(const std::string& text);
  /// `--help` tells the value that it has now as its default.
  Argument& capture_default_str();
  /// Takes one value each time that it is given, and may be given again.
  Argument& one_each_time();
  Argument& excludes(const Argument& other);
  Argument& needs(const Argument& other);

 private:
  CLI::Option* option_;
};

/// A command of the program; a handle, valid while the program's is.
class Command {
 public:
  explicit Command(CLI::App& app) : app_(&app) {}

  [[nodiscard]] Command add_subcommand(const std::string& name, const std::string& what);
  /// `name`: "--NAME" for an option, "NAME" for a positional argument. What a person writes goes to
  /// `value`: a number, a text, or a list of them.
  template <typename Value>
  Argument add_option(const std::string& name, Value& value, const std::string& help);
  Argument add_flag(const std::string& name, bool& value, const std::string& help);
  [[nodiscard]] Argument get_option(const std::string& name) const;
  /// What `--help` ends with.
  void footer(const std::string& text);
  /// Runs when the command is given, after everything was read.
  void callback(std::function<void()> run);

 private:
  CLI::App* app_;
};

/// Refuses the command line as its parser does: `what` (an option, a command) and the reason.
[[noreturn]] void refuse(const std::string& what, const std::string& reason);

}  // namespace kairos::experiments
