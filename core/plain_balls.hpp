#pragma once

#include "core/model.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

namespace kairos {
inline namespace core {

/// Balls that are alike, as far as it matters to what becomes of two of them that meet.
struct PlainBall {
  double radius = 0.0;  ///< m
  double mass = 0.0;    ///< kg
  double restitution = 1.0;
  Vector3 weight = Vector3::Zero();  ///< the uniform force, N
};

/// The bodies of a model that meet each other as points with a radius: balls that nothing turns,
/// that have no friction, that no joint, hand or other body's force holds, and on which nothing but
/// a uniform force acts. Many of them are alike: kinds are few, and stay in the cache.
class PlainBalls {
 public:
  /// Looks at every body once.
  explicit PlainBalls(const Model& model);

  /// What body i is as one; null: it is none.
  [[nodiscard]] const PlainBall* find(BodyIndex i) const {
    return kind_of_[i] == none ? nullptr : &kinds_[kind_of_[i]];
  }
  /// `Model::restitution` of two of them.
  [[nodiscard]] double restitution(const PlainBall& a, const PlainBall& b) const {
    return combine(combine_, a.restitution, b.restitution);
  }
  /// How many bodies are one.
  [[nodiscard]] std::size_t count() const { return count_; }

  /// The same in words, for who asks why.
  static constexpr std::string_view reason =
      "they do not turn and have no friction, nothing holds them, and nothing but a uniform force "
      "acts on them";

 private:
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  Combine combine_;
  std::vector<PlainBall> kinds_;        ///< each once
  std::vector<std::uint32_t> kind_of_;  ///< by body
  std::size_t count_ = 0;
};

}  // namespace core
}  // namespace kairos
