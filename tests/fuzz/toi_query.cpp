// The query itself: two shapes and two motions from any bytes, judged by the long double reference
// against everything that `certified` promises.
#include "ccd/certified.hpp"
#include "experiments/accuracy/query.hpp"
#include "tests/fuzz/fuzz_target.hpp"

#include <cstring>
#include <span>

using namespace kairos;
using namespace kairos::reference;
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
  int below(int n) { return byte() % n; }
  /// A short number (touching, parallel and equal happen), and sometimes a few ulp beside it.
  double number() {
    const int high = static_cast<std::int8_t>(byte());
    const int low = byte();
    double value = (high * 256 + low) * 0x1p-11;  // within 16, steps of 1/2048
    const int nudge = byte();
    if (nudge > 240) {
      value *= 1.0 + (nudge - 248) * 0x1p-52;
    } else if (nudge > 224) {
      value *= 0x1p-20;
    }
    return value;
  }
  double extent() { return std::max(0x1p-11, std::abs(number())); }
  Vector3 vector(double scale = 1.0) {
    const double x = number();
    const double y = number();
    return scale * Vector3(x, y, number());
  }
  Quaternion orientation() {
    const int kind = below(4);
    if (kind == 0) {
      return Quaternion::Identity();
    }
    const Vector3 axis = kind == 1   ? Vector3(Vector3::UnitX())
                         : kind == 2 ? Vector3(Vector3::UnitZ())
                                     : vector();
    return rotate(axis * (number() * 0.39269908169872414), Quaternion::Identity());  // pi / 8
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

Shape read_shape(Bytes& bytes, double scale) {
  switch (bytes.below(5)) {
    case 0:
    case 1:
      return Sphere{scale * bytes.extent()};
    case 2:
      return HalfSpace{};
    default: {
      const double x = bytes.extent();
      const double y = bytes.extent();
      return Box{scale * Vector3(x, y, bytes.extent())};
    }
  }
}

Motion read_motion(Bytes& bytes, double scale, const Vector3& offset) {
  const int kind = bytes.byte();
  const Pose at{offset + bytes.vector(scale), bytes.orientation()};
  const Vector3 velocity = (kind & 1) != 0 ? bytes.vector(scale) : Vector3(Vector3::Zero());
  const Vector3 angular = (kind & 2) != 0 ? bytes.vector() : Vector3(Vector3::Zero());
  const Vector3 acceleration = (kind & 4) != 0 ? bytes.vector(scale) : Vector3(Vector3::Zero());
  Motion motion = moving(at, velocity, angular, acceleration);
  if ((kind & 8) != 0) {
    const int degree = 3 + bytes.below(3);
    motion.position.resize(degree);
    for (int k = 3; k <= degree; ++k) {
      motion.position[k] = bytes.vector(scale);
    }
    motion.velocity = motion.position.differentiated();
  }
  if ((kind & 16) != 0) {
    motion.rotation = RotationKind::polynomial;
    motion.quaternion.resize(1 + bytes.below(3));
    for (int k = 1; k <= motion.quaternion.degree(); ++k) {
      const Vector3 x = bytes.vector(0.0625);
      motion.quaternion[k] = Vector4(x.x(), x.y(), x.z(), 0.0625 * bytes.number());
    }
  }
  if ((kind & 32) != 0) {
    motion.error_radius = scale * 0x1p-10 * bytes.extent();
  }
  return motion;
}

/// A quaternion polynomial that comes near zero is no motion: its rounding has no bound.
bool keeps_its_length(const Motion& motion) {
  double least = 1.0;
  for (int i = 0; i <= 64 && motion.rotation == RotationKind::polynomial; ++i) {
    least = std::min(least, motion.quaternion(i / 64.0).norm());
  }
  return least > 0.25 && std::isfinite(motion.angular_speed_bound(0.0, 1.0));
}

/// False where the bytes are no query.
bool decode_query(std::span<const std::uint8_t> data, Query& q) {
  Bytes bytes(data);
  static constexpr double scales[] = {1.0, 1e-9, 1e9, 1.0, 1e-3, 1.0, 1e3, 1.0};
  const double scale = scales[bytes.below(8)];
  const Vector3 offset = bytes.below(4) == 3 ? Vector3(1e6, -5e5, 2.5e5) : Vector3(Vector3::Zero());
  q.a = read_shape(bytes, scale);
  q.b = read_shape(bytes, scale);
  if (std::holds_alternative<HalfSpace>(q.a) && std::holds_alternative<HalfSpace>(q.b)) {
    return false;
  }
  q.motion_a = read_motion(bytes, scale, offset);
  q.motion_b = read_motion(bytes, scale, offset);
  return keeps_its_length(q.motion_a) && keeps_its_length(q.motion_b);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Query q;
  if (!decode_query({data, size}, q)) {
    return 0;
  }
  static const auto certified = ccd::make_certified();
  const TimeOfImpact toi = q.ask(*certified);
  require(broken_promise(q, toi).empty(), broken_promise(q, toi));
  const TimeOfImpact again = q.ask(*certified);
  require(std::memcmp(&again.t_lo, &toi.t_lo, sizeof toi.t_lo) == 0 && again.t_hi == toi.t_hi &&
              again.evaluations == toi.evaluations,
          "the same query twice, other bits");
  const TimeOfImpact other = q.exchanged().ask(*certified);
  require(broken_promise(q.exchanged(), other).empty(),
          "exchanged: " + broken_promise(q.exchanged(), other));
  require(toi.status == ToiStatus::separated ||
              certified->swept_overlap(q.moving_a(), q.moving_b(), q.window()),
          "the swept boxes exclude a contact that is there");
  return 0;
}
