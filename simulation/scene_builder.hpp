#pragma once

#include "core/reading/document.hpp"
#include "core/scene.hpp"

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace kairos {
inline namespace simulation {

/// A value of a scene key, made from what C++ writes it as: a truth value, a number, a text, a list
/// of numbers or vector, a table of keys.
class KeyValue {
 public:
  /// A table, as C++ writes it: {{"key", value}, ...}.
  using Keys = std::initializer_list<std::pair<std::string_view, KeyValue>>;

  /// true or false.
  KeyValue(bool value) : data_(value) {}
  /// A whole number or a number.
  template <typename Number>
  requires std::is_arithmetic_v<Number> KeyValue(Number value) {
    if constexpr (std::is_integral_v<Number>) {
      data_ = static_cast<std::int64_t>(value);
    } else {
      data_ = static_cast<double>(value);
    }
  }
  /// A text.
  KeyValue(const char* text) : data_(std::string(text)) {}
  /// A text.
  KeyValue(std::string text) : data_(std::move(text)) {}
  /// A vector of three, as any expression of Eigen's.
  template <typename Expression>
  KeyValue(const Eigen::MatrixBase<Expression>& v)
      : KeyValue(std::vector<double>{v[0], v[1], v[2]}) {}
  /// A quaternion as (w, x, y, z).
  KeyValue(const Quaternion& q) : KeyValue(std::vector<double>{q.w(), q.x(), q.y(), q.z()}) {}
  /// A list of numbers.
  KeyValue(const std::vector<double>& numbers);
  /// A list of texts.
  KeyValue(const std::vector<std::string>& texts);
  /// A table.
  KeyValue(Keys keys);

  /// As a value of a document without a file.
  [[nodiscard]] Value document() const;

 private:
  friend class SceneBuilder;
  decltype(Value::data) data_;
};

/// A scene written in C++: the keys of a scene file (scenes/README.md), with the checks and
/// messages of its reader. Nothing is checked before `scene` is called.
///
///     const Scene scene = SceneBuilder("drop")
///                             .set("duration", 2.0)
///                             .body("floor", {{"entity", "wall"}, {"shape", "half-space"}})
///                             .body("ball", {{"entity", "ball"}, {"radius", 0.1}, {"mass", 1},
///                                            {"position", Vector3(0.0, 5.0, 0.0)}})
///                             .scene();
class SceneBuilder {
 public:
  /// `folder`: where the paths of tracks and meshes begin.
  explicit SceneBuilder(std::string name, std::string folder = {});

  /// A key of the scene itself: duration (s), frame, G, gravity, bounds, summary, exact. The last
  /// value of a key counts.
  SceneBuilder& set(std::string_view key, const KeyValue& value);
  /// A body, after those there are: order is the order of creation.
  SceneBuilder& body(std::string_view name, KeyValue::Keys keys);
  /// An element of another list of the scene: `force`, `joint`.
  SceneBuilder& add(std::string_view list, KeyValue::Keys keys);

  /// The scene, as its reader makes it. Throws `InputError` with the key (`body.ball.radius`).
  [[nodiscard]] Scene scene() const;
  /// The same as the text of a scene file.
  [[nodiscard]] std::string toml() const;

 private:
  void append(std::string_view list, Table element);

  std::string folder_;
  Table root_;
};

}  // namespace simulation
}  // namespace kairos
