#include "core/contacts/contact_graph.hpp"

#include "core/archive.hpp"

#include <algorithm>

namespace kairos {
inline namespace core {

Patch* ContactGraph::find(BodyIndex i, BodyIndex j) {
  auto found = patches_.find({i, j});
  if (found == patches_.end()) {
    found = patches_.find({j, i});
  }
  return found == patches_.end() ? nullptr : &found->second;
}

Patch& ContactGraph::join(BodyIndex a, BodyIndex b) {
  const auto [place, is_new] = patches_.try_emplace({a, b});
  if (is_new) {
    place->second.a = a;
    place->second.b = b;
    touch(a, b);
    touch(b, a);
  }
  return place->second;
}

void ContactGraph::touch(BodyIndex i, BodyIndex j) {
  std::vector<BodyIndex>& partners = partners_[i];
  const auto place =
      std::upper_bound(partners.begin(), partners.end(), j,
                       [&](BodyIndex x, BodyIndex y) { return rank_[x] < rank_[y]; });
  partners.insert(place, j);
}

void ContactGraph::part(BodyIndex i, BodyIndex j) {
  if (patches_.erase({i, j}) + patches_.erase({j, i}) > 0) {
    leave(i, j);
    leave(j, i);
  }
}

void ContactGraph::leave(BodyIndex i, BodyIndex j) {
  const auto found = partners_.find(i);
  std::erase(found->second, j);
  if (found->second.empty()) {
    partners_.erase(found);
  }
}

void Patch::persist(Archive& archive) {
  archive(a, b, manifold.normal, manifold.size, manifold.face_of_a, manifold.face_of_b, begins,
          told, slip, turns, grade, step, short_steps, implicit_steps, stretch, force);
  archive.require(manifold.size <= ContactManifold::most_points);
  for (ContactManifold::Point& point : manifold.points) {
    archive(point.position, point.gap);
  }
}

void ContactGraph::persist(Archive& archive) {
  std::size_t n = patches_.size();
  archive.count(n);
  if (!archive.reading()) {
    for (auto& [pair, patch] : patches_) {
      archive(patch);
    }
    return;
  }
  for (std::size_t k = 0; k < n; ++k) {
    Patch patch;
    archive(patch);
    archive.require(patch.a < rank_.size() && patch.b < rank_.size() && patch.a != patch.b &&
                    !joins(patch.a, patch.b));
    join(patch.a, patch.b) = patch;
  }
}

}  // namespace core
}  // namespace kairos
