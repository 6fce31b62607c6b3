#include "ccd/dynamic_tree.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace kairos::ccd {
namespace {

Aabb merged(const Aabb& a, const Aabb& b) {
  return {a.lower.cwiseMin(b.lower), a.upper.cwiseMax(b.upper)};
}

double surface(const Aabb& box) {
  const Vector3 e = box.upper - box.lower;
  return e.x() * e.y() + e.y() * e.z() + e.z() * e.x();
}

using NodeIndex = std::int32_t;
constexpr NodeIndex none = -1;
constexpr NodeIndex unbounded = -2;

struct Node {
  Aabb box;
  NodeIndex parent = none;
  NodeIndex left = none;  ///< none: a leaf
  NodeIndex right = none;
  int height = 0;
  BodyIndex body = 0;
  [[nodiscard]] bool leaf() const { return left == none; }
};

class DynamicTree final : public BroadPhase {
 public:
  explicit DynamicTree(std::size_t bodies) : leaf_(bodies, none) {}

  [[nodiscard]] std::string_view name() const override { return "dynamic-tree"; }

  void update(BodyIndex body, const Aabb& swept) override {
    remove(body);
    if (swept.lower.allFinite() && swept.upper.allFinite()) {
      leaf_[body] = insert(body, swept);
    } else {
      leaf_[body] = unbounded;
      unbounded_.push_back({body, swept});
    }
  }

  void candidates(BodyIndex body, std::vector<BodyIndex>& out) const override {
    if (leaf_[body] == none) {
      return;
    }
    const auto begin = static_cast<std::ptrdiff_t>(out.size());
    collect(leaf_[body] == unbounded ? place_of(body)->box : at(leaf_[body]).box, body, out);
    std::sort(out.begin() + begin, out.end());
  }

  void overlapping(const Aabb& box, std::vector<BodyIndex>& out) const override {
    collect(box, leaf_.size(), out);
  }

  void remove(BodyIndex body) override {
    if (leaf_[body] == unbounded) {
      unbounded_.erase(place_of(body));
    } else if (leaf_[body] != none) {
      take_out(leaf_[body]);
    }
    leaf_[body] = none;
  }

 private:
  /// A box that reaches to infinity is in no leaf.
  struct Unbounded {
    BodyIndex body = 0;
    Aabb box;
  };
  [[nodiscard]] std::vector<Unbounded>::const_iterator place_of(BodyIndex body) const {
    return std::find_if(unbounded_.begin(), unbounded_.end(),
                        [body](const Unbounded& u) { return u.body == body; });
  }

  Node& at(NodeIndex i) { return nodes_[static_cast<std::size_t>(i)]; }
  const Node& at(NodeIndex i) const { return nodes_[static_cast<std::size_t>(i)]; }

  void collect(const Aabb& box, BodyIndex body, std::vector<BodyIndex>& out) const {
    collect(root_, box, body, out);
    for (const Unbounded& other : unbounded_) {
      if (other.body != body && other.box.overlaps(box)) {
        out.push_back(other.body);
      }
    }
  }

  /// Depth is the logarithm of the number of bodies: rotations keep the tree balanced.
  void collect(NodeIndex i, const Aabb& box, BodyIndex body, std::vector<BodyIndex>& out) const {
    if (i == none || !at(i).box.overlaps(box)) {
      return;
    }
    if (at(i).leaf()) {
      if (at(i).body != body) {
        out.push_back(at(i).body);
      }
      return;
    }
    collect(at(i).left, box, body, out);
    collect(at(i).right, box, body, out);
  }

  NodeIndex allocate() {
    if (free_ == none) {
      nodes_.emplace_back();
      return static_cast<NodeIndex>(nodes_.size()) - 1;
    }
    const NodeIndex i = free_;
    free_ = at(i).parent;
    at(i) = Node{};
    return i;
  }
  void release(NodeIndex i) {
    at(i).parent = free_;
    free_ = i;
  }

  /// Goes down the side whose box grows least, while that costs less than a new parent here.
  NodeIndex sibling_for(const Aabb& box) const {
    NodeIndex i = root_;
    while (!at(i).leaf()) {
      const double together = surface(merged(at(i).box, box));
      const double inherited = together - surface(at(i).box);
      const auto cost = [&](NodeIndex child) {
        const double grown = surface(merged(at(child).box, box));
        return inherited + (at(child).leaf() ? grown : grown - surface(at(child).box));
      };
      const double left = cost(at(i).left);
      const double right = cost(at(i).right);
      if (together < left && together < right) {
        break;
      }
      i = left <= right ? at(i).left : at(i).right;
    }
    return i;
  }

  NodeIndex insert(BodyIndex body, const Aabb& box) {
    const NodeIndex leaf = allocate();
    at(leaf).box = box;
    at(leaf).body = body;
    if (root_ == none) {
      root_ = leaf;
      return leaf;
    }
    const NodeIndex sibling = sibling_for(box);
    const NodeIndex above = at(sibling).parent;
    const NodeIndex parent = allocate();
    at(parent).parent = above;
    at(parent).left = sibling;
    at(parent).right = leaf;
    at(sibling).parent = parent;
    at(leaf).parent = parent;
    replace_child(above, sibling, parent);
    refit_from(parent);
    return leaf;
  }

  void take_out(NodeIndex leaf) {
    const NodeIndex parent = at(leaf).parent;
    if (parent == none) {
      root_ = none;
    } else {
      const NodeIndex sibling = at(parent).left == leaf ? at(parent).right : at(parent).left;
      const NodeIndex above = at(parent).parent;
      at(sibling).parent = above;
      replace_child(above, parent, sibling);
      release(parent);
      refit_from(above);
    }
    release(leaf);
  }

  void replace_child(NodeIndex parent, NodeIndex before, NodeIndex after) {
    if (parent == none) {
      root_ = after;
    } else if (at(parent).left == before) {
      at(parent).left = after;
    } else {
      at(parent).right = after;
    }
  }

  void refit(NodeIndex i) {
    const Node& left = at(at(i).left);
    const Node& right = at(at(i).right);
    at(i).box = merged(left.box, right.box);
    at(i).height = 1 + std::max(left.height, right.height);
  }

  void refit_from(NodeIndex i) {
    while (i != none) {
      refit(i);
      i = at(balanced(i)).parent;
    }
  }

  /// The AVL rotation: where one child is two levels higher, it takes the place of node i, and node
  /// i takes the lower of its children. Returns the node that is now on top.
  NodeIndex balanced(NodeIndex i) {
    const NodeIndex left = at(i).left;
    const NodeIndex right = at(i).right;
    const int lean = at(right).height - at(left).height;
    if (lean >= -1 && lean <= 1) {
      return i;
    }
    const NodeIndex up = lean > 0 ? right : left;
    NodeIndex high = at(up).left;
    NodeIndex low = at(up).right;
    if (at(high).height < at(low).height) {
      std::swap(high, low);
    }
    const NodeIndex above = at(i).parent;
    at(up).parent = above;
    replace_child(above, i, up);
    at(up).left = i;
    at(up).right = high;
    at(i).parent = up;
    at(high).parent = up;
    (lean > 0 ? at(i).right : at(i).left) = low;
    at(low).parent = i;
    refit(i);
    refit(up);
    return up;
  }

  std::vector<NodeIndex> leaf_;  ///< by body
  std::vector<Unbounded> unbounded_;
  std::vector<Node> nodes_;
  NodeIndex root_ = none;
  NodeIndex free_ = none;
};

}  // namespace

std::unique_ptr<BroadPhase> make_dynamic_tree(std::size_t bodies) {
  return std::make_unique<DynamicTree>(bodies);
}

}  // namespace kairos::ccd
