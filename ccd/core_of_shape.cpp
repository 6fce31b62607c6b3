#include "ccd/core_of_shape.hpp"

#include <stdexcept>

namespace kairos::ccd {
namespace {

struct MakeCore {
  ConvexCore operator()(const Sphere& s) const { return ConvexCore::point(s.radius); }
  ConvexCore operator()(const Box& box) const { return ConvexCore::box(box.half_extents); }
  ConvexCore operator()(const HalfSpace&) const {
    throw std::invalid_argument("a half-space has no core");
  }
  ConvexCore operator()(const Capsule& c) const {
    return ConvexCore::segment(0.5 * c.length, c.radius);
  }
  ConvexCore operator()(const Cylinder& c) const {
    return ConvexCore::cylinder(c.radius, 0.5 * c.length, 0.0);
  }
  ConvexCore operator()(const Cone& c) const { return ConvexCore::cone(c.radius, c.height, 0.0); }
  ConvexCore operator()(const Hull& hull) const {
    return ConvexCore::of(*hull.core, hull.rounding);
  }
  ConvexCore operator()(const Mesh&) const { throw std::invalid_argument("a mesh is not convex"); }
  ConvexCore operator()(const Compound&) const {
    throw std::invalid_argument("a compound is not convex");
  }
};

}  // namespace

ConvexCore core_of(const Shape& shape) { return std::visit(MakeCore{}, shape); }

ConvexCore core_around(const Shape& shape) {
  return shape_rank(shape) > shape_rank(Hull{}) ? ConvexCore::box(bounding_box(shape).half_extents)
                                                : core_of(shape);
}

bool needs_core(const Shape& shape) {
  const int rank = shape_rank(shape);
  return rank >= shape_rank(Capsule{}) && rank < shape_rank(HalfSpace{});
}

bool is_convex_pair(const Shape& a, const Shape& b) { return needs_core(a) || needs_core(b); }

}  // namespace kairos::ccd
