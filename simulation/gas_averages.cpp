#include "simulation/gas_averages.hpp"

#include "core/exponential.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace kairos {
inline namespace simulation {
namespace {

/// Bodies by cells at least as wide as the greatest distance that is asked for.
class PairCells {
 public:
  PairCells(const std::vector<Vector3>& at, double distance, const PeriodicBox* box)
      : at_(at), box_(box), next_(at.size(), none) {
    low_ = high_ = at.front();
    for (const Vector3& p : at) {
      low_ = low_.cwiseMin(p);
      high_ = high_.cwiseMax(p);
    }
    std::size_t cells = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      turns_[k] = box != nullptr && box->along[k];
      if (turns_[k]) {
        low_[axis] = box->lowest[axis];
        high_[axis] = box->highest[axis];
      }
      const double most = cube_root(static_cast<double>(at.size())) + 1.0;
      const double side = high_[axis] - low_[axis];
      count_[k] = static_cast<long>(std::clamp(std::floor(side / distance), 1.0, most));
      width_[axis] = std::max(side / static_cast<double>(count_[k]), distance * 1e-9);
      cells *= static_cast<std::size_t>(count_[k]);
    }
    first_.assign(cells, none);
    for (std::size_t i = 0; i < at.size(); ++i) {
      std::size_t& first = first_[index(cell(at[i]))];
      next_[i] = first;
      first = i;
    }
  }

  /// Calls visit(distance) once for each pair that may be as near as asked.
  template <typename Visit>
  void for_each_pair(const Visit& visit) const {
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const std::array<long, 3> c = cell(at_[i]);
      std::array<long, 3> near{};
      for (near[0] = low(c, 0); near[0] <= high(c, 0); ++near[0]) {
        for (near[1] = low(c, 1); near[1] <= high(c, 1); ++near[1]) {
          for (near[2] = low(c, 2); near[2] <= high(c, 2); ++near[2]) {
            for (std::size_t j = first_[index(turned(near))]; j != none; j = next_[j]) {
              if (j < i) {
                visit(distance(i, j));
              }
            }
          }
        }
      }
    }
  }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  /// Cells to look through along an axis: all of them where there are fewer than three.
  [[nodiscard]] long low(const std::array<long, 3>& c, std::size_t k) const {
    if (count_[k] < 3) {
      return 0;
    }
    return turns_[k] ? c[k] - 1 : std::max(c[k] - 1, 0L);
  }
  [[nodiscard]] long high(const std::array<long, 3>& c, std::size_t k) const {
    if (count_[k] < 3) {
      return count_[k] - 1;
    }
    return turns_[k] ? c[k] + 1 : std::min(c[k] + 1, count_[k] - 1);
  }
  [[nodiscard]] std::array<long, 3> turned(std::array<long, 3> c) const {
    for (std::size_t k = 0; k < 3; ++k) {
      c[k] = (c[k] + count_[k]) % count_[k];
    }
    return c;
  }
  [[nodiscard]] std::array<long, 3> cell(const Vector3& p) const {
    std::array<long, 3> c{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      c[k] =
          std::clamp(static_cast<long>((p[axis] - low_[axis]) / width_[axis]), 0L, count_[k] - 1);
    }
    return c;
  }
  [[nodiscard]] std::size_t index(const std::array<long, 3>& c) const {
    return static_cast<std::size_t>((c[2] * count_[1] + c[1]) * count_[0] + c[0]);
  }
  [[nodiscard]] double distance(std::size_t i, std::size_t j) const {
    Vector3 d = at_[j] - at_[i];
    if (box_ != nullptr) {
      d += box_->shift(box_->nearest(d));
    }
    return d.norm();
  }

  const std::vector<Vector3>& at_;
  const PeriodicBox* box_;
  Vector3 low_;
  Vector3 high_;
  Vector3 width_ = Vector3::Ones();
  std::array<bool, 3> turns_{};
  std::array<long, 3> count_{};
  std::vector<std::size_t> first_;
  std::vector<std::size_t> next_;
};

}  // namespace

void GasAverages::begin(const Model& model) {
  model_ = &model;
  for (BodyIndex i = 0; i < model.size(); ++i) {
    if (model.is_free(i)) {
      free_.push_back(i);
      mass_ += model.inertia(i).mass;
    }
  }
  origin_.resize(free_.size());
  pairs_.assign(options_.greatest_distance > 0.0 ? options_.distances : 0, 0);
}

void GasAverages::frame(const Frame& frame) {
  if (free_.empty() || frame.index < options_.skipped_frames) {
    return;
  }
  if (!open_) {
    return open_block(frame);
  }
  look(frame);
  if (looks_ == options_.frames_a_block) {
    close_block(frame);
    open_block(frame);
  }
}

void GasAverages::event(const Event& event) {
  if (!open_ || event.kind != EventKind::impact) {
    return;
  }
  const bool both = model_->is_free(event.a) && model_->is_free(event.b);
  const BodyIndex hit = model_->is_free(event.b) ? event.b : event.a;
  const bool is_b = hit == event.b;
  const Vector3 change = is_b ? event.after_b.twist.linear - event.before_b.twist.linear
                              : event.after_a.twist.linear - event.before_a.twist.linear;
  const Vector3 impulse = model_->inertia(hit).mass * change;
  if (!both) {
    ++open_->wall_impacts;
    open_->wall_impulse += impulse.norm();
    return;
  }
  Vector3 d = event.before_b.pose.position - event.before_a.pose.position;
  if (const auto& box = model_->scene().periodic) {
    d += box->shift(box->nearest(d));
  }
  ++open_->impacts;
  open_->virial += impulse.dot(d);
}

namespace {

struct Centre {
  Vector3 position = Vector3::Zero();
  Vector3 velocity = Vector3::Zero();
};

Centre centre_of(const Model& model, const std::vector<BodyIndex>& free, double mass,
                 std::span<const BodyState> bodies) {
  Centre centre;
  for (const BodyIndex i : free) {
    const double share = model.inertia(i).mass / mass;
    centre.position += share * bodies[i].pose.position;
    centre.velocity += share * bodies[i].twist.linear;
  }
  return centre;
}

}  // namespace

void GasAverages::open_block(const Frame& frame) {
  open_.emplace();
  start_ = frame.time.seconds;
  looks_ = 0;
  const Centre centre = centre_of(*model_, free_, mass_, frame.bodies);
  for (std::size_t k = 0; k < free_.size(); ++k) {
    origin_[k] = frame.bodies[free_[k]].pose.position - centre.position;
  }
}

void GasAverages::look(const Frame& frame) {
  const Centre centre = centre_of(*model_, free_, mass_, frame.bodies);
  double way = 0.0;
  for (std::size_t k = 0; k < free_.size(); ++k) {
    const BodyState& state = frame.bodies[free_[k]];
    const BodyInertia& inertia = model_->inertia(free_[k]);
    way += (state.pose.position - centre.position - origin_[k]).squaredNorm();
    open_->kinetic += 0.5 * inertia.mass * (state.twist.linear - centre.velocity).squaredNorm();
    if (inertia.rotates) {
      const Vector3 w =
          inertia.principal_axes(state.pose.orientation).conjugate() * state.twist.angular;
      open_->spin += 0.5 * inertia.principal.cwiseProduct(w.cwiseAbs2());
    }
  }
  open_->way.push_back(way / static_cast<double>(free_.size()));
  ++looks_;
  if (blocks_.empty()) {
    times_.push_back(frame.time.seconds - start_);
  }
}

void GasAverages::close_block(const Frame& frame) {
  const auto looks = static_cast<double>(looks_);
  open_->duration = frame.time.seconds - start_;
  open_->kinetic /= looks;
  open_->spin /= looks;
  blocks_.push_back(std::move(*open_));
  open_.reset();
  if (!pairs_.empty()) {
    count_pairs(frame);
  }
}

void GasAverages::count_pairs(const Frame& frame) {
  const auto& periodic = model_->scene().periodic;
  const PeriodicBox* box = periodic ? &*periodic : nullptr;
  std::vector<Vector3> at;
  at.reserve(free_.size());
  for (const BodyIndex i : free_) {
    const Vector3& p = frame.bodies[i].pose.position;
    at.push_back(box != nullptr ? box->wrapped(p) : p);
  }
  const double per_interval = static_cast<double>(options_.distances) / options_.greatest_distance;
  PairCells(at, options_.greatest_distance, box).for_each_pair([&](double distance) {
    const double interval = distance * per_interval;
    if (interval < static_cast<double>(options_.distances)) {
      ++pairs_[static_cast<std::size_t>(interval)];
    }
  });
}

BlockMean block_mean(const std::vector<double>& of_blocks) {
  BlockMean result;
  const auto n = static_cast<double>(of_blocks.size());
  for (const double x : of_blocks) {
    result.mean += x / n;
  }
  for (const double x : of_blocks) {
    result.error += (x - result.mean) * (x - result.mean);
  }
  result.error = n > 1.0 ? std::sqrt(result.error / (n * (n - 1.0))) : 0.0;
  return result;
}

}  // namespace simulation
}  // namespace kairos
