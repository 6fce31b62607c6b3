#include "experiments/cli/command_line.hpp"

#include <CLI/CLI.hpp>

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace kairos::experiments {

Argument& Argument::check(Check check) {
  option_->check(CLI::Validator(
      [why_not = std::move(check.why_not)](std::string& text) { return why_not(text); },
      check.range));
  return *this;
}

Argument& Argument::one_of(std::initializer_list<std::string> words) {
  option_->check(CLI::IsMember(words));
  return *this;
}

Argument& Argument::required() {
  option_->required();
  return *this;
}

Argument& Argument::type_name(const std::string& name) {
  option_->type_name(name);
  return *this;
}

Argument& Argument::description(const std::string& text) {
  option_->description(text);
  return *this;
}

Argument& Argument::capture_default_str() {
  option_->capture_default_str();
  return *this;
}

Argument& Argument::one_each_time() {
  option_->expected(1)->take_all()->trigger_on_parse(false);
  return *this;
}

Argument& Argument::excludes(const Argument& other) {
  option_->excludes(other.option_);
  return *this;
}

Argument& Argument::needs(const Argument& other) {
  option_->needs(other.option_);
  return *this;
}

Command Command::add_subcommand(const std::string& name, const std::string& what) {
  return Command(*app_->add_subcommand(name, what));
}

template <typename Value>
Argument Command::add_option(const std::string& name, Value& value, const std::string& help) {
  return Argument(*app_->add_option(name, value, help));
}

template Argument Command::add_option(const std::string&, int&, const std::string&);
template Argument Command::add_option(const std::string&, std::int64_t&, const std::string&);
template Argument Command::add_option(const std::string&, std::uint64_t&, const std::string&);
template Argument Command::add_option(const std::string&, double&, const std::string&);
template Argument Command::add_option(const std::string&, std::string&, const std::string&);
template Argument Command::add_option(const std::string&, std::optional<std::string>&,
                                      const std::string&);
template Argument Command::add_option(const std::string&, std::vector<std::size_t>&,
                                      const std::string&);
template Argument Command::add_option(const std::string&, std::vector<std::string>&,
                                      const std::string&);

Argument Command::add_flag(const std::string& name, bool& value, const std::string& help) {
  return Argument(*app_->add_flag(name, value, help));
}

Argument Command::get_option(const std::string& name) const {
  return Argument(*app_->get_option(name));
}

void Command::footer(const std::string& text) { app_->footer(text); }
void Command::callback(std::function<void()> run) { app_->callback(std::move(run)); }

void refuse(const std::string& what, const std::string& reason) {
  throw CLI::ValidationError(what, reason);
}

}  // namespace kairos::experiments
