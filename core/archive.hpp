#pragma once

#include "core/motion.hpp"
#include "core/state.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace kairos {
inline namespace core {

/// The bytes are no checkpoint: they end too soon, or hold an impossible value.
class ArchiveError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Values in a fixed order, written and read by the same code, so that the two cannot differ:
/// `archive(a, b, c)` writes them, or reads them if the archive was made from bytes.
///
/// Values come back bit for bit, on machines of the same kind. A class archives its members in its
/// function `persist(Archive&)`. The bytes may have been forged: code that archives an index or a
/// count checks it with `require` when reading.
class Archive {
 public:
  /// An archive to write to.
  Archive() = default;
  /// An archive to read from; the bytes must outlive it.
  explicit Archive(std::string_view bytes) : in_(bytes), reading_(true) {}

  [[nodiscard]] bool reading() const { return reading_; }
  /// What was written.
  [[nodiscard]] const std::string& bytes() const { return out_; }
  /// Bytes not read yet.
  [[nodiscard]] std::size_t left() const { return in_.size(); }

  template <typename... T>
  void operator()(T&... values) {
    (persist(*this, values), ...);
  }

  /// Throws `ArchiveError` if a value that was read is not possible. Does nothing when writing.
  void require(bool possible) const {
    if (reading_ && !possible) {
      throw ArchiveError("holds a number that cannot be");
    }
  }
  /// Throws `ArchiveError` where fewer bytes are left.
  void raw(void* data, std::size_t size);
  /// Number of elements that follow, each of at least one byte.
  void count(std::size_t& n);

 private:
  std::string out_;
  std::string_view in_;
  bool reading_ = false;
};

template <typename T>
concept Persistent = requires(T& value, Archive& archive) {
  value.persist(archive);
};

template <typename T>
requires std::is_arithmetic_v<T>
void persist(Archive& archive, T& value) { archive.raw(&value, sizeof value); }
void persist(Archive& archive, bool& value);
constexpr RotationKind last_of(RotationKind) { return RotationKind::polynomial; }
/// An enumeration names its last value, so that bytes beyond it are refused:
/// `constexpr Colour last_of(Colour) { return Colour::blue; }`.
template <typename T>
requires std::is_enum_v<T>
void persist(Archive& archive, T& value) {
  archive.raw(&value, sizeof value);
  if (archive.reading() && !(value >= T{} && value <= last_of(value))) {
    throw ArchiveError("holds a value that does not exist");
  }
}
template <Persistent T>
void persist(Archive& archive, T& value) {
  value.persist(archive);
}
template <int Rows, int Options>
void persist(Archive& archive, Eigen::Matrix<double, Rows, 1, Options>& value) {
  archive.raw(value.data(), sizeof(double) * static_cast<std::size_t>(Rows));
}
void persist(Archive& archive, Quaternion& value);
void persist(Archive& archive, std::string& value);
void persist(Archive& archive, Instant& value);
void persist(Archive& archive, Pose& value);
void persist(Archive& archive, Twist& value);
void persist(Archive& archive, BodyState& value);
void persist(Archive& archive, Motion& value);

template <int Dim>
void persist(Archive& archive, Polynomial<Dim>& value) {
  int degree = value.degree();
  archive(degree);
  if (degree < 0 || degree > Polynomial<Dim>::max_degree) {
    throw ArchiveError("holds a polynomial of an impossible degree");
  }
  value.resize(degree);
  for (int k = 0; k <= degree; ++k) {
    archive(value[k]);
  }
}
template <typename T, std::size_t N>
void persist(Archive& archive, std::array<T, N>& values) {
  for (T& value : values) {
    archive(value);
  }
}
/// A vector that has elements already (one per body, say) must be read with the same number. An
/// empty one grows while it is read, so that forged counts cannot take memory without bytes.
template <typename T>
void persist(Archive& archive, std::vector<T>& values) {
  const std::size_t there = values.size();
  std::size_t n = there;
  archive.count(n);
  if (there > 0 && n != there) {
    throw ArchiveError("holds another number of things than the world has");
  }
  if (there == 0) {
    for (std::size_t k = 0; k < n; ++k) {
      archive(values.emplace_back());
    }
    return;
  }
  for (T& value : values) {
    archive(value);
  }
}
template <typename T>
void persist(Archive& archive, std::optional<T>& value) {
  bool present = value.has_value();
  archive(present);
  if (!present) {
    value.reset();
    return;
  }
  if (!value) {
    value.emplace();
  }
  archive(*value);
}

/// A 64-bit fingerprint of bytes, FNV-1a: finds damage and differences, not forgery.
[[nodiscard]] std::string fingerprint(std::string_view bytes);

}  // namespace core
}  // namespace kairos
