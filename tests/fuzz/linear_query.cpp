// Vertex and face, edge and edge from any bytes: the stages agree with the integers, and what may
// not matter does not.
#include "ccd/linear/exact_motion.hpp"
#include "ccd/linear/linear_impact.hpp"
#include "tests/fuzz/fuzz_target.hpp"

#include <cmath>
#include <cstring>
#include <span>
#include <utility>

using namespace kairos;
using namespace kairos::ccd;
using kairos::fuzz::require;

namespace {

/// Numbers out of bytes; zeros when these are used up.
class Bytes {
 public:
  explicit Bytes(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  int byte() {
    if (bytes_.empty()) {
      return 0;
    }
    const int value = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return value;
  }
  /// Mostly a short number, so that points coincide; a few ulp beside it; or any double at all.
  double number() {
    const int kind = byte();
    const int value = static_cast<std::int8_t>(byte());
    if (kind < 160) {
      return value * 0.25;
    }
    if (kind < 220) {
      return value * 0.25 * (1.0 + (kind - 190) * 0x1p-52);
    }
    if (kind < 254) {
      return std::ldexp(value, (kind - 235) * 8);
    }
    std::uint64_t bits = static_cast<std::uint64_t>(value & 0xFF);
    for (int i = 1; i < 8; ++i) {
      bits = bits << 8 | static_cast<std::uint64_t>(byte());
    }
    double any = 0.0;
    std::memcpy(&any, &bits, sizeof any);
    return std::isfinite(any) ? any : 1.0;
  }
  Vector3 vector() {
    const double x = number();
    const double y = number();
    return {x, y, number()};
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

bool same(const LinearImpact& a, const LinearImpact& b) {
  return a.hit == b.hit && a.t_lo == b.t_lo && a.t_hi == b.t_hi;
}

/// Exponents so far apart take seconds with a separation, and belong to the reference.
bool is_moderate(const LinearQuery& query) {
  double largest = query.separation;
  double least = query.separation > 0.0 ? query.separation : 1.0;
  for (const FourPoints* points : {&query.start, &query.end}) {
    for (const Vector3& p : *points) {
      for (const double x : {p.x(), p.y(), p.z()}) {
        largest = std::max(largest, std::abs(x));
        least = x == 0.0 ? least : std::min(least, std::abs(x));
      }
    }
  }
  return largest < least * 0x1p80;
}

LinearQuery read_query(Bytes& bytes) {
  LinearQuery query;
  const int flags = bytes.byte();
  query.kind = (flags & 1) != 0 ? LinearKind::edge_edge : LinearKind::vertex_face;
  for (std::size_t i = 0; i < 4; ++i) {
    query.start[i] = bytes.vector();
    query.end[i] = query.start[i];
    if ((flags & (2 << i)) == 0) {
      query.end[i] += (flags & 32) != 0 ? bytes.vector() : Vector3(bytes.number(), 0.0, 0.0);
    }
    if (!query.end[i].allFinite()) {
      query.end[i] = query.start[i];
    }
  }
  if ((flags & 192) == 192) {
    query.separation = std::abs(bytes.number());
  }
  return query;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes({data, size});
  LinearQuery query = read_query(bytes);
  if (query.separation > 0.0 && !is_moderate(query)) {
    query.separation = 0.0;
  }
  const LinearImpact impact = linear_impact(query);
  require(impact.hit ? impact.t_lo >= 0.0 && impact.t_hi <= 1.0 : impact.t_lo == impact.t_hi,
          "the time is not within the step");
  require(
      !impact.hit || impact.t_lo == impact.t_hi || std::nextafter(impact.t_lo, 2.0) == impact.t_hi,
      "the bracket is wider than two adjacent doubles");
  const LinearImpact exact =
      query.separation > 0.0 ? exact_impact_at_distance(query) : exact_impact(query);
  require(same(impact, exact), "the integers say something else");
  LinearQuery other = query;
  for (FourPoints* points : {&other.start, &other.end}) {
    std::swap((*points)[2], (*points)[3]);
    for (Vector3& p : *points) {
      p = Vector3(-p.z(), p.x(), p.y());
    }
  }
  require(same(impact, linear_impact(other)), "the order of points or axes matters");
  std::swap(other.start, other.end);
  require(impact.hit == linear_impact(other).hit, "backwards they do not meet as well");
  return 0;
}
