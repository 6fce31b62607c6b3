#include "core/archive.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>

namespace kairos {
inline namespace core {

void Archive::raw(void* data, std::size_t size) {
  if (!reading_) {
    out_.append(static_cast<const char*>(data), size);
    return;
  }
  if (size > in_.size()) {
    throw ArchiveError("ends too early");
  }
  std::memcpy(data, in_.data(), size);
  in_.remove_prefix(size);
}

void Archive::count(std::size_t& n) {
  auto portable = static_cast<std::uint64_t>(n);
  raw(&portable, sizeof portable);
  if (reading_ && portable > in_.size()) {
    throw ArchiveError("ends too early");
  }
  n = static_cast<std::size_t>(portable);
}

void persist(Archive& archive, bool& value) {
  unsigned char byte = value ? 1 : 0;
  archive.raw(&byte, sizeof byte);
  archive.require(byte <= 1);
  value = byte == 1;
}

void persist(Archive& archive, Quaternion& value) {
  for (int k = 0; k < 4; ++k) {
    archive(value.coeffs()[k]);
  }
}

void persist(Archive& archive, std::string& value) {
  std::size_t n = value.size();
  archive.count(n);
  value.resize(n);
  archive.raw(value.data(), n);
}

void persist(Archive& archive, Instant& value) { archive(value.seconds, value.correction); }
void persist(Archive& archive, Pose& value) { archive(value.position, value.orientation); }
void persist(Archive& archive, Twist& value) { archive(value.linear, value.angular); }
void persist(Archive& archive, BodyState& value) { archive(value.pose, value.twist); }

void persist(Archive& archive, Motion& value) {
  archive(value.start, value.duration, value.position, value.velocity, value.rotation,
          value.quaternion, value.rotation_rate, value.angular_velocity, value.error_radius);
}

std::string fingerprint(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : bytes) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  }
  return fmt::format("{:016x}", hash);
}

}  // namespace core
}  // namespace kairos
