#include "ccd/cells.hpp"

#include "ccd/cell_grid.hpp"
#include "ccd/dynamic_tree.hpp"
#include "ccd/rounding/roundoff.hpp"
#include "ccd/swept_windows.hpp"
#include "core/archive.hpp"
#include "core/large_pages.hpp"
#include "core/looks_ahead.hpp"
#include "core/prefetch.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace kairos::ccd {
namespace {

/// First time u > 0 at which x + v u + a u^2 is above `rise`; x = 0 and rise > 0. Infinite: never.
double time_to_rise(double v, double a, double rise) {
  if (a == 0.0) {
    return v > 0.0 ? rise / v : infinity;
  }
  const double square = v * v + 4.0 * a * rise;
  if (!(square >= 0.0)) {
    return infinity;
  }
  const double sum = v + std::sqrt(square);
  return sum > 0.0 ? 2.0 * rise / sum : infinity;
}

/// The way of a body as cells need it: from a motion, or from the flight of a ball.
struct MotionWay {
  const Motion& motion;

  [[nodiscard]] Instant start() const { return motion.start; }
  [[nodiscard]] int degree() const { return motion.position.degree(); }
  [[nodiscard]] Vector3 at(double s) const { return motion.position(s); }
  [[nodiscard]] double error() const { return motion.error_radius; }
  /// Half of the acceleration, and the velocity at local time s, of a parabola.
  [[nodiscard]] double half_acceleration(int k) const {
    return degree() == 2 ? motion.position[2][k] : 0.0;
  }
  [[nodiscard]] double velocity(int k, double s) const {
    return degree() >= 1 ? motion.position[1][k] + 2.0 * half_acceleration(k) * s : 0.0;
  }
  /// Of the coordinates at local time s, from above.
  [[nodiscard]] double size(double s) const {
    const Polynomial<3>& p = motion.position;
    double size = p[p.degree()].lpNorm<Eigen::Infinity>();
    for (int k = p.degree() - 1; k >= 0; --k) {
      size = size * s + p[k].lpNorm<Eigen::Infinity>();
    }
    return size;
  }
  /// For how long it goes at most so far from where it is at local time s.
  [[nodiscard]] double time_within(double least, double s) const {
    const double left = motion.duration - s;
    double stays = left;
    while (stays > 0.0 && !(motion.displacement_bound(s, s + stays) <= least)) {
      stays *= 0.5;
    }
    // To its end, which rounding may put a little after now for ever.
    return stays == left ? infinity : stays;
  }
};

struct FlightWay {
  const BallFlight& flight;

  [[nodiscard]] Instant start() const { return flight.start; }
  [[nodiscard]] static int degree() { return 2; }
  [[nodiscard]] Vector3 at(double s) const {
    return (0.5 * flight.acceleration * s + flight.velocity) * s + flight.position;
  }
  [[nodiscard]] static double error() { return 0.0; }
  [[nodiscard]] double half_acceleration(int k) const { return 0.5 * flight.acceleration[k]; }
  [[nodiscard]] double velocity(int k, double s) const {
    return flight.velocity[k] + 2.0 * half_acceleration(k) * s;
  }
  [[nodiscard]] double size(double s) const {
    return (0.5 * flight.acceleration.lpNorm<Eigen::Infinity>() * s +
            flight.velocity.lpNorm<Eigen::Infinity>()) *
               s +
           flight.position.lpNorm<Eigen::Infinity>();
  }
  [[nodiscard]] static double time_within(double /*least*/, double /*s*/) { return infinity; }
};

class Cells final : public Neighbourhood, public LooksAhead {
 public:
  Cells(const Model& model, double tolerance, const CellSize& size)
      : layout_(model, tolerance, size),
        grid_(layout_.counts, layout_.first),
        large_(model, make_dynamic_tree(model.size()), tolerance),
        places_(scattered<Place>(model.size())) {
    for (BodyIndex i = 0; i < model.size(); ++i) {
      places_[i].usual =
          layout_.fits && model.is_free(i) && bounding_radius(model.shape(i)) <= layout_.radius;
    }
    if (const auto& periodic = model.scene().periodic) {
      periodic_ = &*periodic;
    }
  }

  Instant enter(BodyIndex i, const MovingShape& moving, Instant t, Instant until) override {
    if (const auto crosses = enter_along(i, MotionWay{moving.motion}, t, until)) {
      return *crosses;
    }
    if (places_[i].at == Place::in_cell) {
      leave(i);
    }
    places_[i].at = Place::in_box;
    const Instant crosses = large_.enter(i, moving, t, until);
    mark(i);
    return crosses;
  }

  std::optional<Instant> enter(BodyIndex i, const BallFlight& flight, Instant t,
                               Instant until) override {
    return enter_along(i, FlightWay{flight}, t, until);
  }

  void near(BodyIndex i, std::vector<Neighbour>& out) override {
    found_.clear();
    near_apart(i, found_, out);
    tell_themselves(i, found_, out);
  }

  void near_apart(BodyIndex i, std::vector<CellGrid::Id>& themselves,
                  std::vector<Neighbour>& out) override {
    if (places_[i].at == Place::in_cell) {
      const CellIndex cell = places_[i].cell();
      if (periodic_ == nullptr) {
        grid_.around(cell, themselves);
      } else {
        images_.clear();
        grid_.around(cell, images_);
        tell_images(i, images_, out);
      }
      if (may_be_reached(cell)) {
        large_.boxes().overlapping(reach(cell), out);
      }
    } else if (places_[i].at == Place::in_box) {
      large_.near(i, out);
      near_box(large_.swept(i), out);
    }
  }

  Instant cross(BodyIndex i, const MovingShape& moving, Instant t, Instant until,
                std::vector<Neighbour>& out) override {
    found_.clear();
    if (const auto crosses = cross_along(i, MotionWay{moving.motion}, t, until, found_, out)) {
      tell_themselves(i, found_, out);
      return *crosses;
    }
    const Instant crosses = enter(i, moving, t, until);
    near(i, out);
    return crosses;
  }

  std::optional<Instant> cross(BodyIndex i, const BallFlight& flight, Instant t, Instant until,
                               std::vector<CellGrid::Id>& themselves,
                               std::vector<Neighbour>& out) override {
    return cross_along(i, FlightWay{flight}, t, until, themselves, out);
  }

  void go_on_as(BodyIndex i, const Image& n) override {
    if (places_[i].at == Place::in_cell) {  // the same one on the torus
      for (std::size_t k = 0; k < 3; ++k) {
        places_[i].along[k] += n[k] * static_cast<std::int32_t>(grid_.count(k));
      }
    } else if (places_[i].at == Place::in_box) {
      large_.go_on_as(i, n);
    }
  }

  void look_up(BodyIndex i) const override { prefetch(places_[i]); }
  void look_around(BodyIndex i) const override {
    if (places_[i].at == Place::in_cell) {
      grid_.look_around(places_[i].cell());
    }
  }

  void persist(Archive& archive) override {
    large_.persist(archive);
    archive(places_);
    if (archive.reading()) {
      for (BodyIndex i = 0; i < places_.size(); ++i) {
        archive.require(places_[i].at != Place::in_box || large_.is_known(i));
        if (places_[i].at == Place::in_cell) {
          grid_.insert(places_[i].cell(), i);
        } else if (places_[i].at == Place::in_box) {
          mark(i);
        }
      }
    }
  }

 private:
  struct Place {
    enum At : std::uint8_t { nowhere, in_cell, in_box };
    std::array<std::int32_t, 3> along{};
    At at = nowhere;
    bool usual = false;  ///< of a size for cells

    [[nodiscard]] CellIndex cell() const { return {along[0], along[1], along[2]}; }

    void persist(Archive& archive) {
      archive(along);
      auto where = static_cast<std::uint8_t>(at);
      archive(where);
      archive.require(where <= in_box);
      at = static_cast<At>(where);
    }
  };

  /// Nothing: it is in no cell.
  template <typename Way>
  std::optional<Instant> enter_along(BodyIndex i, const Way& way, Instant t, Instant until) {
    const double s = t - way.start();
    if (!fits(i, way, s)) {
      return std::nullopt;
    }
    const Vector3 p = way.at(s);
    if (places_[i].at != Place::in_cell || !inside(places_[i].cell(), p)) {
      move(i, cell_of(p));
    }
    return exit(i, way, p, t, until);
  }

  /// Nothing: it was in no cell, or is in none any more.
  template <typename Way>
  std::optional<Instant> cross_along(BodyIndex i, const Way& way, Instant t, Instant until,
                                     std::vector<CellGrid::Id>& themselves,
                                     std::vector<Neighbour>& out) {
    const double s = t - way.start();
    if (places_[i].at != Place::in_cell || !fits(i, way, s)) {
      return std::nullopt;
    }
    const Vector3 p = way.at(s);
    const CellIndex before = places_[i].cell();
    const CellIndex now = cell_of(p);
    if (now != before) {
      move(i, now);
      if (periodic_ == nullptr) {
        grid_.entered(before, now, themselves);
      } else {
        images_.clear();
        grid_.entered(before, now, images_);
        tell_images(i, images_, out);
      }
      if (!may_be_reached(now)) {
        return exit(i, way, p, t, until);
      }
      const Aabb known = reach(before);
      boxes_.clear();
      large_.boxes().overlapping(reach(now), boxes_);
      for (const Neighbour& j : boxes_) {
        const Aabb& swept = large_.swept(j.body);
        const Vector3 shift =
            periodic_ == nullptr ? Vector3(Vector3::Zero()) : periodic_->shift(j.image);
        if (!known.overlaps({swept.lower + shift, swept.upper + shift})) {
          out.push_back(j);
        }
      }
    }
    return exit(i, way, p, t, until);
  }

  /// Whether its coordinates resolve a cell, and its motion is known as well as a cell allows.
  template <typename Way>
  [[nodiscard]] bool fits(BodyIndex i, const Way& way, double s) const {
    return places_[i].usual && way.error() <= layout_.slack && way.size(s) <= layout_.farthest;
  }

  [[nodiscard]] CellIndex cell_of(const Vector3& p) const {
    CellIndex cell;
    for (int k = 0; k < 3; ++k) {
      // The floor; coordinates of bodies in cells are small enough.
      const double x = p[k] * layout_.per_width[k];
      const auto towards_zero = static_cast<std::int64_t>(x);
      cell[static_cast<std::size_t>(k)] =
          towards_zero - (static_cast<double>(towards_zero) > x ? 1 : 0);
    }
    return cell;
  }
  [[nodiscard]] double corner(const CellIndex& cell, int k) const {
    return static_cast<double>(cell[static_cast<std::size_t>(k)]) * layout_.width[k];
  }
  /// Whether p is in the cell: where it is beyond, its next crossing would come sooner.
  [[nodiscard]] bool inside(const CellIndex& cell, const Vector3& p) const {
    for (int k = 0; k < 3; ++k) {
      const double x = p[k] - corner(cell, k);
      if (!(x >= 0.0 && x <= layout_.width[k])) {
        return false;
      }
    }
    return true;
  }

  /// All that a body in the cell could touch.
  [[nodiscard]] Aabb reach(const CellIndex& cell) const {
    Aabb box;
    for (int k = 0; k < 3; ++k) {
      std::tie(box.lower[k], box.upper[k]) = reach_along(k, corner(cell, k));
    }
    return box;
  }
  /// The same along an axis, of a cell that begins there.
  [[nodiscard]] std::pair<double, double> reach_along(int k, double from) const {
    const double beyond = layout_.margin + layout_.radius + layout_.slack;
    return {from - beyond, from + layout_.width[k] + beyond};
  }

  /// When a body at p leaves the surroundings of its cell, at most 15/16 of the margin beyond it:
  /// the rest is more than rounding takes.
  template <typename Way>
  [[nodiscard]] Instant exit(BodyIndex i, const Way& way, const Vector3& p, Instant t,
                             Instant until) const {
    const double allowed = 15.0 / 16.0 * layout_.margin;
    const double s = t - way.start();
    const bool bends = way.degree() > 2;
    const CellIndex cell = places_[i].cell();
    double stays = infinity;
    double least = infinity;
    for (int k = 0; k < 3; ++k) {
      const double below = p[k] - (corner(cell, k) - allowed);
      const double above = layout_.width[k] + 2.0 * allowed - below;
      least = std::min({least, below, above});
      if (bends) {
        continue;
      }
      const double c = way.half_acceleration(k);
      const double v = way.velocity(k, s);
      if (c == 0.0) {
        const double leaves = (v > 0.0 ? above : below) / std::abs(v);
        stays = v != 0.0 ? std::min(stays, leaves) : stays;
      } else {
        stays = std::min({stays, time_to_rise(v, c, above), time_to_rise(-v, -c, below)});
      }
    }
    if (bends) {
      stays = way.time_within(least, s);
    }
    const Instant crosses = t + stays;
    return crosses < until ? crosses : Instant::never();
  }

  void leave(BodyIndex i) {
    if (places_[i].at == Place::in_cell) {
      grid_.remove(places_[i].cell(), i);
    } else if (places_[i].at == Place::in_box) {
      large_.leave(i);
    }
    places_[i].at = Place::nowhere;
  }
  void move(BodyIndex i, const CellIndex& to) {
    leave(i);
    grid_.insert(to, i);
    places_[i].at = Place::in_cell;
    for (std::size_t k = 0; k < 3; ++k) {
      places_[i].along[k] = static_cast<std::int32_t>(to[k]);
    }
  }

  /// Whether the tree may hold something near a body in the cell.
  [[nodiscard]] bool may_be_reached(const CellIndex& cell) const {
    return periodic_ != nullptr || grid_.may_be_reached(cell);
  }
  /// Body i is in the tree: the cells that it reaches.
  void mark(BodyIndex i) {
    CellIndex low{};
    CellIndex high{};
    const Aabb& swept = large_.swept(i);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [first, last] = cells_near(swept, k);
      const std::int64_t end = layout_.first[k] + grid_.count(k) - 1;
      low[k] = layout_.first[k];
      if (first > static_cast<double>(low[k])) {
        low[k] = first < static_cast<double>(end) ? static_cast<std::int64_t>(first) : end;
      }
      high[k] = last < static_cast<double>(end)
                    ? static_cast<std::int64_t>(std::max(last, static_cast<double>(low[k])))
                    : end;
      // These are rounded outwards; who asks in a cell asks for what its reach overlaps.
      const auto axis = static_cast<int>(k);
      const auto is_reached = [&](std::int64_t c) {
        const auto [from, to] = reach_along(axis, static_cast<double>(c) * layout_.width[axis]);
        return from <= swept.upper[axis] && swept.lower[axis] <= to;
      };
      while (low[k] <= high[k] && !is_reached(low[k])) {
        ++low[k];
      }
      while (low[k] <= high[k] && !is_reached(high[k])) {
        --high[k];
      }
    }
    grid_.mark(low, high);
  }

  /// Appends these bodies but i.
  static void tell_themselves(BodyIndex i, const std::vector<CellGrid::Id>& found,
                              std::vector<Neighbour>& out) {
    for (const CellGrid::Id j : found) {
      if (j != i) {
        out.push_back({j});
      }
    }
  }
  /// Appends these bodies but i, each as its image around the cell of i: bodies fewer than four
  /// cells apart on the torus have one.
  void tell_images(BodyIndex i, const std::vector<CellGrid::Id>& found_there,
                   std::vector<Neighbour>& out) const {
    const CellIndex cell = places_[i].cell();
    for (const CellGrid::Id j : found_there) {
      if (j == i) {
        continue;
      }
      Neighbour found{j};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int64_t apart = cell[k] - places_[j].along[k];
        if (periodic_->along[k] && (apart < -1 || apart > 1)) {
          // A whole number of turns and one cell at most.
          found.image[k] =
              static_cast<std::int32_t>((apart + (apart > 0 ? 1 : -1)) / grid_.count(k));
        }
      }
      out.push_back(found);
    }
  }

  /// Numbers of the cells along an axis whose surroundings a box reaches, and one more on both
  /// sides, as these quotients are rounded: perhaps infinite.
  [[nodiscard]] std::pair<double, double> cells_near(const Aabb& swept, std::size_t k) const {
    const double beyond = layout_.margin + layout_.radius + layout_.slack;
    const auto axis = static_cast<Eigen::Index>(k);
    const double per_width = layout_.per_width[axis];
    return {std::floor((swept.lower[axis] - beyond) * per_width) - 1.0,
            std::floor((swept.upper[axis] + beyond) * per_width) + 1.0};
  }

  /// Bodies in the cells whose surroundings a box reaches.
  void near_box(const Aabb& swept, std::vector<Neighbour>& out) {
    CellIndex low{};
    CellIndex high{};
    std::array<bool, 3> everywhere{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [first, last] = cells_near(swept, k);
      constexpr double countable = 0x1p60;
      everywhere[k] = !(std::abs(first) < countable && std::abs(last) < countable);
      if (!everywhere[k]) {
        low[k] = static_cast<std::int64_t>(first);
        high[k] = static_cast<std::int64_t>(last);
      }
    }
    CellIndex from = low;
    CellIndex to = high;
    for (std::size_t k = 0; k < 3; ++k) {
      if (everywhere[k] || high[k] - low[k] >= grid_.count(k)) {
        from[k] = 0;
        to[k] = grid_.count(k) - 1;
      }
    }
    images_.clear();
    grid_.within(from, to, images_);
    for (const BodyIndex j : images_) {
      tell_within(j, low, high, everywhere, out);
    }
  }

  /// Body j as every image of it in the cells from `low` to `high`.
  void tell_within(BodyIndex j, const CellIndex& low, const CellIndex& high,
                   const std::array<bool, 3>& everywhere, std::vector<Neighbour>& out) const {
    Image least{};
    Image most{};
    for (std::size_t k = 0; k < 3; ++k) {
      if (periodic_ != nullptr && periodic_->along[k] && !everywhere[k]) {
        const auto turns = static_cast<double>(grid_.count(k));
        const std::int64_t cell = places_[j].along[k];
        least[k] = static_cast<std::int32_t>(std::ceil(static_cast<double>(low[k] - cell) / turns));
        most[k] =
            static_cast<std::int32_t>(std::floor(static_cast<double>(high[k] - cell) / turns));
      }
    }
    for (std::int32_t z = least[2]; z <= most[2]; ++z) {
      for (std::int32_t y = least[1]; y <= most[1]; ++y) {
        for (std::int32_t x = least[0]; x <= most[0]; ++x) {
          out.push_back({j, {x, y, z}});
        }
      }
    }
  }

  CellLayout layout_;
  CellGrid grid_;
  SweptWindows large_;
  std::vector<Place> places_;
  const PeriodicBox* periodic_ = nullptr;
  std::vector<Neighbour> boxes_;  ///< scratch
  std::vector<CellGrid::Id> found_;
  std::vector<CellGrid::Id> images_;
};

}  // namespace

std::unique_ptr<Neighbourhood> make_cells(const Model& model, double tolerance) {
  return std::make_unique<Cells>(model, tolerance, CellSize{});
}

NeighbourhoodFactory cells_of(const CellSize& size) {
  return [size](const Model& model, double tolerance) {
    return std::make_unique<Cells>(model, tolerance, size);
  };
}

}  // namespace kairos::ccd
