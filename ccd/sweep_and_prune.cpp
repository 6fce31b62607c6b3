#include "ccd/sweep_and_prune.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kairos::ccd {
namespace {

class SweepAndPrune final : public BroadPhase {
 public:
  explicit SweepAndPrune(std::size_t bodies) : boxes_(bodies), place_(bodies, absent) {
    order_.reserve(bodies);
    unbounded_.reserve(bodies);
  }

  [[nodiscard]] std::string_view name() const override { return "sweep-and-prune"; }

  void update(BodyIndex body, const Aabb& swept) override {
    const bool bounded = std::isfinite(swept.lower.x()) && std::isfinite(swept.upper.x());
    if (place_[body] == unbounded || (place_[body] != absent && !bounded)) {
      take_out(body);
    }
    boxes_[body] = swept;
    if (!bounded) {
      unbounded_.insert(std::lower_bound(unbounded_.begin(), unbounded_.end(), body), body);
      place_[body] = unbounded;
      return;
    }
    widest_ = std::max(widest_, swept.upper.x() - swept.lower.x());
    if (place_[body] == absent) {
      place_[body] = order_.size();
      order_.push_back(body);
    }
    settle(place_[body]);
    if (++updates_ > 8 * order_.size()) {  // the widest box may be long gone
      updates_ = 0;
      widest_ = 0.0;
      for (const BodyIndex other : order_) {
        widest_ = std::max(widest_, boxes_[other].upper.x() - boxes_[other].lower.x());
      }
    }
  }

  void candidates(BodyIndex body, std::vector<BodyIndex>& out) const override {
    if (place_[body] == absent) {
      return;
    }
    const auto begin = static_cast<std::ptrdiff_t>(out.size());
    collect(boxes_[body], body, out);
    std::sort(out.begin() + begin, out.end());
  }
  void overlapping(const Aabb& box, std::vector<BodyIndex>& out) const override {
    collect(box, place_.size(), out);
  }
  void remove(BodyIndex body) override {
    if (place_[body] != absent) {
      take_out(body);
    }
  }

 private:
  static constexpr std::size_t absent = static_cast<std::size_t>(-1);
  static constexpr std::size_t unbounded = static_cast<std::size_t>(-2);

  void collect(const Aabb& box, BodyIndex body, std::vector<BodyIndex>& out) const {
    // A box that starts further left than the widest is wide cannot reach this one.
    const auto first = std::partition_point(order_.begin(), order_.end(), [&](BodyIndex other) {
      return boxes_[other].lower.x() + widest_ * (1.0 + 1e-9) < box.lower.x();
    });
    for (auto i = first; i != order_.end() && boxes_[*i].lower.x() <= box.upper.x(); ++i) {
      if (*i != body && boxes_[*i].overlaps(box)) {
        out.push_back(*i);
      }
    }
    for (const BodyIndex other : unbounded_) {
      if (other != body && boxes_[other].overlaps(box)) {
        out.push_back(other);
      }
    }
  }

  bool before(std::size_t i, std::size_t j) const {
    return boxes_[order_[i]].lower.x() < boxes_[order_[j]].lower.x();
  }
  void exchange(std::size_t i, std::size_t j) {
    std::swap(order_[i], order_[j]);
    place_[order_[i]] = i;
    place_[order_[j]] = j;
  }
  /// Insertion sort of one entry.
  void settle(std::size_t i) {
    for (; i > 0 && before(i, i - 1); --i) {
      exchange(i, i - 1);
    }
    for (; i + 1 < order_.size() && before(i + 1, i); ++i) {
      exchange(i, i + 1);
    }
  }
  void take_out(BodyIndex body) {
    if (place_[body] == unbounded) {
      unbounded_.erase(std::find(unbounded_.begin(), unbounded_.end(), body));
    } else {
      for (std::size_t i = place_[body]; i + 1 < order_.size(); ++i) {
        exchange(i, i + 1);
      }
      order_.pop_back();
    }
    place_[body] = absent;
  }

  std::vector<Aabb> boxes_;
  std::vector<std::size_t> place_;    ///< of a body in `order_`
  std::vector<BodyIndex> order_;      ///< by lower x
  std::vector<BodyIndex> unbounded_;  ///< ascending
  double widest_ = 0.0;               ///< no box in `order_` is wider along x, m
  std::size_t updates_ = 0;
};

}  // namespace

std::unique_ptr<BroadPhase> make_sweep_and_prune(std::size_t bodies) {
  return std::make_unique<SweepAndPrune>(bodies);
}

}  // namespace kairos::ccd
