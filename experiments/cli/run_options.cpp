#include "experiments/cli/run_options.hpp"

#include "core/error.hpp"
#include "core/reading/scene_reader.hpp"
#include "simulation/option.hpp"
#include "simulation/registry.hpp"
#include "simulation/scene_library.hpp"

#include <fmt/format.h>

#include <span>
#include <vector>

namespace kairos::experiments {
namespace {

template <typename Port>
std::string names_of(std::span<const std::shared_ptr<const Port>> entries) {
  std::vector<std::string_view> names;
  for (const auto& entry : entries) {
    names.push_back(entry->info().name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Help of an option: its allowed names or its meaning, with its default.
std::string help_of(const Option& option) {
  std::string help(option.help);
  if (option.name == "scheme") {
    help = names_of(schemes());
  } else if (option.name == "detector") {
    help = names_of(detectors());
  } else if (option.name == "impact") {
    help = names_of(impact_laws());
  } else if (option.name == "integrator") {
    help = "a name of `kairos list integrators`; auto: the scene decides";
  }
  if (!option.range.unit.empty() && option.kind == OptionKind::number) {
    help += fmt::format(", {}", option.range.unit);
  }
  const std::string usual = option.default_text();
  return usual.empty() || option.kind == OptionKind::flag
             ? help
             : fmt::format("{} (default {})", help, usual);
}

std::string_view placeholder(OptionKind kind) {
  switch (kind) {
    case OptionKind::name:
      return "NAME";
    case OptionKind::count:
      return "N";
    case OptionKind::duration:
      return "T";
    case OptionKind::frames:
      return "H";
    default:
      return "X";
  }
}

/// Scene values that a person sets on the command line.
Override parse_setting(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InputError("", 0, "--set",
                     fmt::format("'{}' sets nothing; needed: KEY=VALUE, such as "
                                 "body.ball.radius=0.2",
                                 text));
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

}  // namespace

void SceneOptions::add_to(Command& command) {
  command.add_option("scene", scene_, "a scene file, or the name of a shipped scene")
      .required()
      .type_name("SCENE");
  command
      .add_option("--set", settings_,
                  "replace a value of the scene, such as body.ball.radius=0.2; repeatable")
      .type_name("KEY=VALUE")
      .one_each_time();
}

Scene SceneOptions::scene() const { return read_scene(find_scene(scene_), overrides()); }

std::vector<Override> SceneOptions::overrides() const {
  std::vector<Override> overrides;
  for (const std::string& setting : settings_) {
    overrides.push_back(parse_setting(setting));
  }
  return overrides;
}

std::string shell_word(const std::string& text) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
  if (!text.empty() && text.find_first_not_of(plain) == std::string::npos) {
    return text;
  }
  std::string quoted = "'";
  for (const char c : text) {
    quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return quoted + '\'';
}

std::string SceneOptions::arguments() const {
  std::string text = shell_word(scene_);
  for (const std::string& setting : settings_) {
    text += " --set " + shell_word(setting);
  }
  return text;
}

void RunOptions::add_to(Command& command) {
  for (const Option& option : options()) {
    const std::string flag = "--" + std::string(option.flag);
    if (option.kind == OptionKind::flag) {
      command.add_flag(flag, flags_[option.name], help_of(option));
    } else {
      command.add_option(flag, texts_[option.name], help_of(option))
          .type_name(std::string(placeholder(option.kind)));
    }
  }
  command.add_flag("--thesis", thesis_,
                   "the thesis' own method, where no other option says otherwise: original, "
                   "thesis-euler, sat, thesis");
}

RunChoice RunOptions::choice() const {
  RunChoice choice;
  if (thesis_) {
    choice.method = MethodChoice::thesis();
  }
  std::vector<OptionSetting> settings;
  for (const auto& [name, text] : texts_) {
    if (text) {
      settings.emplace_back(name, *text);
    }
  }
  for (const auto& [name, on] : flags_) {
    if (on) {
      settings.emplace_back(name, true);
    }
  }
  try {
    set_options(choice, settings);
  } catch (const InputError& error) {
    const Option* option = find_option(error.key());
    throw InputError(error.file(), error.line(),
                     option == nullptr ? error.key() : "--" + std::string(option->flag),
                     error.reason());
  }
  return choice;
}

}  // namespace kairos::experiments
