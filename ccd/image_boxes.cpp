#include "ccd/image_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace kairos::ccd {
namespace {

/// More than the relative rounding of moving a box by whole periods.
constexpr double rounding = 8.0 * std::numeric_limits<double>::epsilon();

bool is_finite(const Aabb& box, int k) {
  return std::isfinite(box.lower[k]) && std::isfinite(box.upper[k]);
}

}  // namespace

ImageBoxes::ImageBoxes(const Model& model, std::unique_ptr<BroadPhase> boxes)
    : model_(model),
      periodic_(model.scene().periodic ? &*model.scene().periodic : nullptr),
      boxes_(std::move(boxes)),
      kept_(periodic_ != nullptr ? model.size() : 0) {}

Image ImageBoxes::home(const Aabb& box) const {
  Image n{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    if (periodic_->along[k] && is_finite(box, static_cast<int>(k))) {
      const double side = periodic_->highest[axis] - periodic_->lowest[axis];
      const double middle = 0.5 * (box.lower[axis] + box.upper[axis]);
      n[k] = static_cast<std::int32_t>(-std::floor((middle - periodic_->lowest[axis]) / side));
    }
  }
  return n;
}

Aabb ImageBoxes::moved(const Aabb& box, const Image& n) const {
  if (is_zero(n)) {
    return box;
  }
  const Vector3 shift = periodic_->shift(n);
  Aabb result{box.lower + shift, box.upper + shift};
  for (int k = 0; k < 3; ++k) {
    if (is_finite(box, k)) {
      const double lost =
          rounding * (std::abs(box.lower[k]) + std::abs(box.upper[k]) + std::abs(shift[k]));
      result.lower[k] -= lost;
      result.upper[k] += lost;
    }
  }
  return result;
}

void ImageBoxes::update(BodyIndex i, const Aabb& box) {
  if (periodic_ == nullptr) {
    return boxes_->update(i, box);
  }
  kept_[i].image = home(box);
  const Aabb kept = kept_[i].box = moved(box, kept_[i].image);
  for (int k = 0; k < 3; ++k) {
    if (is_finite(kept, k)) {
      greatest_[k] = std::max(greatest_[k], 0.5 * (kept.upper[k] - kept.lower[k]));
    }
  }
  boxes_->update(i, kept);
}

void ImageBoxes::near(BodyIndex i, const Aabb& box, std::vector<Neighbour>& out) {
  if (periodic_ == nullptr) {
    found_.clear();
    boxes_->candidates(i, found_);
    for (const BodyIndex j : found_) {
      out.push_back({j});
    }
    return;
  }
  const std::size_t before = out.size();
  overlapping(box, out);
  const auto first = out.begin() + static_cast<std::ptrdiff_t>(before);
  out.erase(std::remove_if(first, out.end(), [i](const Neighbour& n) { return n.body == i; }),
            out.end());
}

void ImageBoxes::overlapping(const Aabb& box, std::vector<Neighbour>& out) {
  if (periodic_ == nullptr) {
    found_.clear();
    boxes_->overlapping(box, found_);
    for (const BodyIndex j : found_) {
      out.push_back({j});
    }
    return;
  }
  const Image of_box = home(box);
  const Aabb kept = moved(box, of_box);
  Image least{};
  Image most{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    if (periodic_->along[k] && is_finite(box, static_cast<int>(k))) {
      const double side = periodic_->highest[axis] - periodic_->lowest[axis];
      constexpr double more = 1e-9;  // than rounding, in periods
      const double low = (kept.lower[axis] - greatest_[axis] - periodic_->highest[axis]) / side;
      const double high = (kept.upper[axis] + greatest_[axis] - periodic_->lowest[axis]) / side;
      least[k] = static_cast<std::int32_t>(std::ceil(low - more));
      most[k] = static_cast<std::int32_t>(std::floor(high + more));
    }
  }
  for (std::int32_t z = least[2]; z <= most[2]; ++z) {
    for (std::int32_t y = least[1]; y <= most[1]; ++y) {
      for (std::int32_t x = least[0]; x <= most[0]; ++x) {
        look(kept, {x, y, z}, of_box, out);
      }
    }
  }
}

/// Boxes as they are kept, `at` so many periods further.
void ImageBoxes::look(const Aabb& box, const Image& at, const Image& of_box,
                      std::vector<Neighbour>& out) {
  found_.clear();
  const Aabb seen = moved(box, -at);
  boxes_->overlapping(seen, found_);
  for (const BodyIndex j : found_) {
    if (!kept_[j].box.overlaps(seen)) {
      continue;  // a broad phase may report pairs beyond, and would once for each image
    }
    if (std::holds_alternative<HalfSpace>(model_.shape(j))) {
      if (is_zero(at)) {
        out.push_back({j});
      }
      continue;
    }
    Neighbour found{j};
    for (std::size_t k = 0; k < 3; ++k) {
      const bool everywhere = !is_finite(box, static_cast<int>(k));
      found.image[k] = everywhere ? 0 : at[k] + kept_[j].image[k] - of_box[k];
    }
    out.push_back(found);
  }
}

}  // namespace kairos::ccd
