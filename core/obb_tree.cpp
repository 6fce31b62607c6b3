#include "core/obb_tree.hpp"

#include "core/error.hpp"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

namespace kairos {
inline namespace core {
namespace {

constexpr double unit_roundoff = 0.5 * std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double largest_coordinate = 1e12;

float rounded_up(double x) {
  const auto near = static_cast<float>(x);
  return static_cast<double>(near) < x ? std::nextafter(near, std::numeric_limits<float>::max())
                                       : near;
}

void check(const MeshData& mesh) {
  const auto refuse = [](const std::string& reason) { throw InputError("", 0, "mesh", reason); };
  if (mesh.triangles.empty() || mesh.triangles.size() > most_triangles) {
    refuse(
        fmt::format("has {} triangles; allowed: 1 to {}", mesh.triangles.size(), most_triangles));
  }
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    for (const std::uint32_t corner : mesh.triangles[k]) {
      if (corner >= mesh.vertices.size()) {
        refuse(fmt::format("triangle {} has the corner {}; there are {} vertices", k, corner,
                           mesh.vertices.size()));
      }
      if (!(mesh.vertices[corner].cwiseAbs().maxCoeff() <= largest_coordinate)) {
        refuse(fmt::format("vertex {} is not finite or beyond {} m", corner, largest_coordinate));
      }
    }
  }
}

class Builder {
 public:
  explicit Builder(const MeshData& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    middles_.reserve(order_.size());
    for (const Triangle& t : mesh.triangles) {
      middles_.push_back((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0);
      for (const std::uint32_t corner : t) {
        tree_.reach = std::max(tree_.reach, mesh.vertices[corner].lpNorm<1>());
      }
    }
    tree_.nodes.reserve(order_.size() - 1);
  }

  ObbTree build() {
    tree_.root = add(order_, 1);
    tree_.reach *= 1.0 + 4.0 * unit_roundoff;
    return std::move(tree_);
  }

 private:
  ObbChild add(std::span<std::uint32_t> triangles, int depth) {
    if (triangles.size() == 1) {
      return ObbChild::triangle(triangles.front());
    }
    tree_.depth = std::max(tree_.depth, depth);
    const auto here = static_cast<std::uint32_t>(tree_.nodes.size());
    tree_.nodes.push_back(fit(triangles));
    const std::size_t half = divide(triangles, tree_.nodes[here], depth);
    const ObbChild first = add(triangles.first(half), depth + 1);
    const ObbChild second = add(triangles.subspan(half), depth + 1);
    tree_.nodes[here].children = {first, second};
    return ObbChild::node(here);
  }

  /// The covariance of points spread evenly over the triangles; of their corners where they have no
  /// area.
  [[nodiscard]] Matrix3 covariance(std::span<const std::uint32_t> triangles) const {
    const Vector3 origin = middles_[triangles.front()];
    Matrix3 second = Matrix3::Zero();
    Vector3 first = Vector3::Zero();
    double weight = 0.0;
    Matrix3 corners = Matrix3::Zero();
    for (const std::uint32_t k : triangles) {
      const Triangle& t = mesh_.triangles[k];
      const Vector3 a = mesh_.vertices[t[0]] - origin, b = mesh_.vertices[t[1]] - origin,
                    c = mesh_.vertices[t[2]] - origin;
      const Vector3 m = (a + b + c) / 3.0;
      const double area = (b - a).cross(c - a).norm();
      const Matrix3 own = a * a.transpose() + b * b.transpose() + c * c.transpose();
      second += area / 12.0 * (9.0 * m * m.transpose() + own);
      first += area * m;
      weight += area;
      corners += own;
    }
    return weight > 0.0 ? Matrix3(second / weight - (first / weight) * (first / weight).transpose())
                        : corners;
  }

  /// The quaternion of the principal axes, in whole numbers.
  [[nodiscard]] std::array<std::int16_t, 4> turn_of(
      std::span<const std::uint32_t> triangles) const {
    Matrix3 spread = covariance(triangles);
    const double size = spread.cwiseAbs().maxCoeff();
    if (!(size > 0.0) || !std::isfinite(size)) {
      return {1, 0, 0, 0};
    }
    spread /= size;
    const Eigen::SelfAdjointEigenSolver<Matrix3> solver(spread);
    Matrix3 axes = solver.eigenvectors();
    if (axes.determinant() < 0.0) {
      axes.col(0) = -axes.col(0);
    }
    const Quaternion q(axes);
    constexpr double most = 32767.0;
    const auto whole = [&](double x) { return static_cast<std::int16_t>(std::lround(most * x)); };
    return {whole(q.w()), whole(q.x()), whole(q.y()), whole(q.z())};
  }

  template <typename Visit>
  void each_corner(std::span<const std::uint32_t> triangles, const Visit& visit) const {
    for (const std::uint32_t k : triangles) {
      for (const std::uint32_t corner : mesh_.triangles[k]) {
        visit(mesh_.vertices[corner]);
      }
    }
  }

  [[nodiscard]] ObbNode fit(std::span<const std::uint32_t> triangles) {
    ObbNode node{};
    node.turn = turn_of(triangles);
    const Matrix3 axes = box_of(node).axes;
    const Vector3 origin = middles_[triangles.front()];
    Vector3 least = Vector3::Constant(infinity);
    Vector3 greatest = -least;
    each_corner(triangles, [&](const Vector3& v) {
      const Vector3 y = axes.transpose() * (v - origin);
      least = least.cwiseMin(y);
      greatest = greatest.cwiseMax(y);
    });
    const Vector3 middle = origin + axes * (0.5 * (least + greatest));
    for (std::size_t k = 0; k < 3; ++k) {
      node.centre[k] = static_cast<float>(middle[static_cast<Eigen::Index>(k)]);
    }
    // The extents are taken about the centre as it was rounded, so that the box holds everything.
    const Vector3 centre = box_of(node).centre;
    Vector3 half = Vector3::Zero();
    each_corner(triangles, [&](const Vector3& v) {
      const Vector3 from = v - centre;
      // One rounding in each axis, difference and product, two sums: 8 u with room.
      const double error = 8.0 * unit_roundoff * from.lpNorm<1>();
      half = half.cwiseMax(Vector3((axes.transpose() * from).cwiseAbs().array() + error));
    });
    for (std::size_t k = 0; k < 3; ++k) {
      node.half_extents[k] = rounded_up(half[static_cast<Eigen::Index>(k)]);
    }
    tree_.reach = std::max(tree_.reach, centre.lpNorm<1>());
    return node;
  }

  /// Puts the triangles of the first child in front and returns how many they are. Their middles
  /// are cut at the mean across the longest axis where it parts them, and at the median where a
  /// branch becomes long. The order is fixed here and left to no library, so that trees are the
  /// same everywhere.
  std::size_t divide(std::span<std::uint32_t> triangles, const ObbNode& node, int depth) const {
    constexpr int mean_until = 64;
    const ObbBox box = box_of(node);
    std::array<int, 3> by_length{0, 1, 2};
    std::stable_sort(by_length.begin(), by_length.end(),
                     [&](int i, int j) { return box.half_extents[i] > box.half_extents[j]; });
    if (depth < mean_until) {
      for (const int k : by_length) {
        const Vector3 axis = box.axes.col(k);
        double mean = 0.0;
        for (const std::uint32_t t : triangles) {
          mean += axis.dot(middles_[t] - box.centre) / static_cast<double>(triangles.size());
        }
        const auto cut = std::stable_partition(
            triangles.begin(), triangles.end(),
            [&](std::uint32_t t) { return axis.dot(middles_[t] - box.centre) <= mean; });
        if (cut != triangles.begin() && cut != triangles.end()) {
          return static_cast<std::size_t>(cut - triangles.begin());
        }
      }
    }
    const Vector3 axis = box.axes.col(by_length[0]);
    const std::size_t half = triangles.size() / 2;
    std::stable_sort(triangles.begin(), triangles.end(), [&](std::uint32_t s, std::uint32_t t) {
      return axis.dot(middles_[s]) < axis.dot(middles_[t]);
    });
    return half;
  }

  const MeshData& mesh_;
  std::vector<std::uint32_t> order_;
  std::vector<Vector3> middles_;
  ObbTree tree_;
};

}  // namespace

ObbBox box_of(const ObbNode& node) {
  // Sums of products of 16 bits: whole numbers, so only the division rounds.
  const double w = node.turn[0], x = node.turn[1], y = node.turn[2], z = node.turn[3];
  const double n = w * w + x * x + y * y + z * z;
  ObbBox box;
  box.axes << (w * w + x * x - y * y - z * z) / n, 2.0 * (x * y - w * z) / n,
      2.0 * (x * z + w * y) / n,  //
      2.0 * (x * y + w * z) / n, (w * w - x * x + y * y - z * z) / n, 2.0 * (y * z - w * x) / n,
      2.0 * (x * z - w * y) / n, 2.0 * (y * z + w * x) / n, (w * w - x * x - y * y + z * z) / n;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    box.centre[i] = node.centre[k];
    box.half_extents[i] = node.half_extents[k];
  }
  return box;
}

ObbTree build_obb_tree(const MeshData& mesh) {
  check(mesh);
  return Builder(mesh).build();
}

}  // namespace core
}  // namespace kairos
