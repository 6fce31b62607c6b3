#pragma once

#include "core/scene.hpp"
#include "experiments/simulation.hpp"

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace kairos::experiments {

/// The options that name a scene: shared by every command that takes one.
class SceneOptions {
 public:
  void add_to(CLI::App& command);
  /// Reads the scene. Throws `InputError`.
  [[nodiscard]] Scene scene() const;
  /// What --set replaces. Throws `InputError`.
  [[nodiscard]] std::vector<Override> overrides() const;

 private:
  std::string scene_;
  std::vector<std::string> settings_;
};

/// The options that name a method: shared by every command that runs one.
class RunOptions {
 public:
  void add_to(CLI::App& command);
  /// Throws `InputError` where a value makes no sense; names are looked up by `simulate`.
  [[nodiscard]] RunChoice choice() const;

 private:
  bool thesis_ = false;
  bool equal_substeps_ = false;
  bool roundoff_ = false;
  std::optional<std::string> scheme_, integrator_, detector_, impact_;
  std::optional<std::string> frame_, duration_, step_;
  std::optional<std::string> threshold_, max_substeps_, tolerance_;
  std::optional<std::string> relative_tolerance_, absolute_tolerance_;
};

}  // namespace kairos::experiments
