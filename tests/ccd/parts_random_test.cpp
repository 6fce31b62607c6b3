// Random queries over meshes and compounds against every kind of shape. KAIROS_PARTS_QUERIES=N asks
// N of each pair and course, KAIROS_PARTS_SEED others.

#include "ccd/certified.hpp"
#include "tests/catch.hpp"
#include "tests/ccd/parts_query.hpp"

#include <fmt/format.h>

#include <cstdlib>

using namespace kairos;
using namespace kairos::convex;

namespace {

std::uint64_t number(const char* name, std::uint64_t fallback) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::strtoull(text, nullptr, 10) : fallback;
}

constexpr std::uint64_t compound_kind = 5;
std::string first_name(std::uint64_t kind) {
  return kind == compound_kind ? "compound" : fmt::format("{} mesh", mesh_names[kind]);
}

/// 0 to 6: convex ones and a half-space; then another mesh, a compound.
constexpr int mesh_partner = 7;
constexpr int compound_partner = 8;
Shape partner(Random& random, int kind) {
  if (kind == mesh_partner) {
    return random_mesh(random, random.below(5));
  }
  return kind == compound_partner ? random_compound(random) : random_shape(random, kind);
}
std::string partner_name(int kind) {
  return kind == mesh_partner       ? "mesh"
         : kind == compound_partner ? "compound"
                                    : shape_names[static_cast<std::size_t>(kind)];
}

}  // namespace

TEST_CASE("meshes and compounds keep their promises against every shape", "[parts][random][slow]") {
  const auto certified = ccd::make_certified();
  const std::uint64_t queries = number("KAIROS_PARTS_QUERIES", 1);
  const std::uint64_t seed = number("KAIROS_PARTS_SEED", 1);
  const bool table = queries > 20;
  if (table) {
    fmt::print("{:<32}{:>8}{:>8}{:>8}{:>10}{:>10}{:>8}\n", "pair", "impact", "inside", "undec.",
               "median w", "worst w", "looks");
  }
  for (std::uint64_t a = 0; a <= compound_kind; ++a) {
    for (int b = 0; b <= compound_partner; ++b) {
      std::vector<double> widths;
      std::uint64_t undecided = 0;
      std::uint64_t inside = 0;
      double looks = 0.0;
      for (std::uint64_t i = 0; i < 5 * queries; ++i) {
        Random random(seed, a * 9 + static_cast<std::uint64_t>(b), 1'000'000 * i);
        const Shape shape_a = a == compound_kind ? random_compound(random) : random_mesh(random, a);
        const Shape shape_b = partner(random, b);
        const PartsQuery q =
            random_parts_query(random, shape_a, shape_b, static_cast<Course>(i % 5));
        const Query& w = q.whole;
        const TimeOfImpact toi = certified->time_of_impact({w.a, w.motion_a}, {w.b, w.motion_b},
                                                           {Instant{}, w.duration}, 0.0);
        looks += toi.evaluations;
        if (toi.status == ToiStatus::impact && toi.t_lo > 0.0) {
          widths.push_back(toi.t_hi - toi.t_lo);
        }
        undecided += toi.status == ToiStatus::undecided ? 1 : 0;
        inside += toi.status == ToiStatus::overlapping ? 1 : 0;
        const std::string promise = broken(q, toi, 8, random);
        if (!promise.empty()) {
          FAIL_CHECK(fmt::format(
              "{}-{} {} {}: seed {}, {}: {} t [{:.17g}, {:.17g}] gap {} made to touch at {}, {} "
              "looks",
              first_name(a), partner_name(b), w.family, i, seed, promise, to_string(toi.status),
              toi.t_lo, toi.t_hi, toi.gap, w.touch, toi.evaluations));
        }
      }
      if (table) {
        std::sort(widths.begin(), widths.end());
        fmt::print("{:<32}{:>8}{:>8}{:>8}{:>10.1e}{:>10.1e}{:>8.0f}\n",
                   fmt::format("{}-{}", first_name(a), partner_name(b)), widths.size(), inside,
                   undecided, widths.empty() ? 0.0 : widths[widths.size() / 2],
                   widths.empty() ? 0.0 : widths.back(),
                   looks / (5.0 * static_cast<double>(queries)));
      }
    }
  }
}

TEST_CASE("25: a box asked as a box, a hull and a mesh gives brackets that intersect",
          "[parts][random][slow]") {
  const auto certified = ccd::make_certified();
  const std::uint64_t queries = number("KAIROS_PARTS_QUERIES", 20);
  const auto as_mesh = [](const Shape& box) {
    return Mesh{solid_body(box_mesh(std::get<Box>(box).half_extents)).body};
  };
  const auto as_hull = [](const Shape& box) {
    return Hull{convex_hull(box_mesh(std::get<Box>(box).half_extents).vertices).polytope};
  };
  std::uint64_t undecided = 0;
  for (const int kind_b : {0, 1, 2, 6}) {
    for (std::uint64_t i = 0; i < queries; ++i) {
      Random random(number("KAIROS_PARTS_SEED", 1), 99, 1'000'000 * i);
      const Query q = random_query(random, 1, kind_b, Course::hit);
      const auto ask = [&](const Shape& a, const Shape& b) {
        return certified->time_of_impact({a, q.motion_a}, {b, q.motion_b}, {Instant{}, q.duration},
                                         0.0);
      };
      const TimeOfImpact box = ask(q.a, q.b);
      std::vector<TimeOfImpact> others{ask(as_mesh(q.a), q.b)};
      if (kind_b == 1) {
        others.push_back(ask(as_mesh(q.a), as_mesh(q.b)));
        others.push_back(ask(as_hull(q.a), as_mesh(q.b)));
      }
      for (const TimeOfImpact& mesh : others) {
        CAPTURE(kind_b, i, box.t_lo, box.t_hi, mesh.t_lo, mesh.t_hi, q.closing);
        // Where the parts that touch lie at the rim of each other rounding may hide it for longer.
        CHECK((mesh.status == box.status || mesh.status == ToiStatus::undecided));
        undecided += mesh.status != box.status ? 1 : 0;
        // The corners of the hull are off by the roundoff of the centroid, which they cover so
        // fast; those of the mesh are the box's.
        const double slack = 1e-15 / std::abs(q.closing);
        CHECK(mesh.t_lo <= box.t_hi + slack);
        // Undecided it may be sooner, at a gap that is within the tolerance.
        CHECK((mesh.status == ToiStatus::undecided || box.t_lo <= mesh.t_hi + slack));
      }
    }
  }
  CHECK(undecided <= queries / 4);
}

TEST_CASE("a part that is left out is missed", "[parts][mutation]") {
  // Of a mesh without one of its triangles the answer is later where that one is hit: what the
  // reference of the tests above would tell of a tree that dropped a child, or a leaf.
  const auto certified = ccd::make_certified();
  int later = 0;
  int seen = 0;
  for (std::uint64_t i = 0; i < 40; ++i) {
    Random random(5, i);
    MeshData whole = soup(random);
    while (whole.triangles.size() < 2) {
      whole = soup(random);
    }
    MeshData open = whole;
    open.triangles.erase(open.triangles.begin() +
                         static_cast<std::ptrdiff_t>(random.below(open.triangles.size())));
    using Kind = CollisionMesh::Kind;
    const Shape all = Mesh{mesh_in_place(whole, Kind::surface)};
    const Shape less = Mesh{mesh_in_place(open, Kind::surface)};
    const PartsQuery q = random_parts_query(random, all, Sphere{0.3}, Course::hit);
    const auto ask = [&](const Shape& shape) {
      return certified->time_of_impact({shape, q.whole.motion_a}, {q.whole.b, q.whole.motion_b},
                                       {Instant{}, q.whole.duration}, 0.0);
    };
    const TimeOfImpact of_all = ask(all);
    const TimeOfImpact of_less = ask(less);
    CHECK(broken(q, of_all, 8, random).empty());
    if (of_less.t_lo > of_all.t_hi) {
      ++later;
      seen += broken(q, of_less, 200, random).empty() ? 0 : 1;
    }
  }
  CHECK(later > 4);
  CHECK(2 * seen > later);  // some touch for too short a time to be sampled
}
