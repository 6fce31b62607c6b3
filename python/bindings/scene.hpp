#pragma once

#include "core/reading/document.hpp"
#include "core/reading/scene_reader.hpp"

#include "python/bindings/callables.hpp"
#include <map>
#include <string>
#include <vector>

namespace kairos::python {

/// A scene while it is written in Python: a document, as a scene file is one, and callables that no
/// file can hold. Nothing is checked before `build`, which is the reader of scene files.
class SceneDraft {
 public:
  explicit SceneDraft(const std::string& name);
  [[nodiscard]] static SceneDraft read(const std::string& path);
  [[nodiscard]] static SceneDraft parse(const std::string& text, const std::string& path);

  void set(const pybind11::dict& keys);
  void body(const std::string& name, const pybind11::dict& keys);
  /// An element of a list of tables of scene files, `[[list]]`.
  void add(const std::string& list, const pybind11::dict& keys);
  void force(const pybind11::dict& keys);
  void own_force(ForceChoices choices, std::vector<std::string> bodies);
  void override_key(const std::string& key, const pybind11::handle& value);

  /// Throws `InputError`.
  [[nodiscard]] Scene build() const;
  [[nodiscard]] std::string toml() const;
  /// Whether callables of the user's are part of it: such a scene runs under the interpreter's
  /// lock.
  [[nodiscard]] bool has_callables() const { return !forces_.empty() || !drives_.empty(); }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::string name() const;

 private:
  struct OwnForce {
    ForceChoices choices;
    std::vector<std::string> bodies;
  };

  void append(const std::string& list, Table element);
  Table& root();
  void add_forces(Scene& scene) const;

  Value root_;
  std::string path_;
  bool written_elsewhere_ = false;  ///< a .def file, which is no document
  std::vector<Override> overrides_;
  std::vector<OwnForce> forces_;
  std::map<std::string, pybind11::object> drives_;
};

}  // namespace kairos::python
