#pragma once

#include "core/polynomial.hpp"

#include <array>
#include <cassert>
#include <span>

namespace kairos::integrators {

/// What is known of a curve at one local time: its value and, for `conditions` 2 and 3, its first
/// and second derivative.
template <int Dim>
struct HermiteNode {
  double s = 0.0;
  int conditions = 1;
  std::array<typename Polynomial<Dim>::Value, 3> derivatives;
};

/// The polynomial of least degree through the nodes, by confluent divided differences
/// [Hairer1993, II.6], [Stoer2002, 2.1.5]. The first node must be at s = 0: its data are then the
/// first coefficients bit for bit. With n conditions of a smooth curve the error is O(h^n).
template <int Dim>
Polynomial<Dim> hermite(std::span<const HermiteNode<Dim>> nodes) {
  using Value = typename Polynomial<Dim>::Value;
  constexpr std::size_t capacity = Polynomial<Dim>::max_degree + 1;
  assert(!nodes.empty() && nodes.front().s == 0.0);

  std::array<const HermiteNode<Dim>*, capacity> at{};
  std::array<Value, capacity> difference;
  std::size_t size = 0;
  for (const HermiteNode<Dim>& node : nodes) {
    for (int k = 0; k < node.conditions; ++k, ++size) {
      assert(size < capacity);
      at[size] = &node;
      difference[size] = node.derivatives[0];
    }
  }
  for (std::size_t order = 1; order < size; ++order) {
    for (std::size_t i = size - 1; i >= order; --i) {
      if (at[i] == at[i - order]) {
        difference[i] = order == 2 ? Value(at[i]->derivatives[2] * 0.5) : at[i]->derivatives[1];
      } else {
        difference[i] = (difference[i] - difference[i - 1]) / (at[i]->s - at[i - order]->s);
      }
    }
  }

  Polynomial<Dim> result;
  result.resize(static_cast<int>(size) - 1);
  result[0] = difference[size - 1];
  for (std::size_t used = 1; used < size; ++used) {  // result <- result (s - s_i) + difference_i
    const std::size_t i = size - 1 - used;
    for (int k = static_cast<int>(used); k >= 1; --k) {
      result[k] = result[k - 1] - result[k] * at[i]->s;
    }
    result[0] = difference[i] - result[0] * at[i]->s;
  }
  return result;
}

}  // namespace kairos::integrators
