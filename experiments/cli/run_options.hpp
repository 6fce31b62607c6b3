#pragma once

#include "core/reading/scene_reader.hpp"
#include "core/scene.hpp"
#include "experiments/cli/command_line.hpp"
#include "simulation/simulate.hpp"

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments {

/// The options that name a scene: shared by every command that takes one.
class SceneOptions {
 public:
  void add_to(Command& command);
  /// The scene as it was named.
  [[nodiscard]] const std::string& name() const { return scene_; }
  /// Reads the scene. Throws `InputError`.
  [[nodiscard]] Scene scene() const;
  /// What --set replaces. Throws `InputError`.
  [[nodiscard]] std::vector<Override> overrides() const;
  /// The scene and its --set as they were given, for a shell: a command to be copied.
  [[nodiscard]] std::string arguments() const;

 private:
  std::string scene_;
  std::vector<std::string> settings_;
};

/// A word as a shell takes it verbatim, in quotes where it must be.
[[nodiscard]] std::string shell_word(const std::string& text);

/// The options that name a method: shared by every command that runs one.
class RunOptions {
 public:
  void add_to(Command& command);
  /// Throws `InputError` where a value makes no sense; names are looked up by `simulate`.
  [[nodiscard]] RunChoice choice() const;

 private:
  bool thesis_ = false;
  std::map<std::string_view, std::optional<std::string>>
      texts_;  ///< as given, by the name of the option
  std::map<std::string_view, bool> flags_;
};

}  // namespace kairos::experiments
