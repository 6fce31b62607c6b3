#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kairos {
inline namespace simulation {

/// Named arrays of numbers in one block of bytes, little-endian, each aligned to 8 bytes, so that a
/// page reads them as typed arrays without copying.
class PackedArrays {
 public:
  struct Entry {
    std::string name;
    std::string_view type;   ///< f64, u32, u8
    std::size_t offset = 0;  ///< bytes
    std::size_t length = 0;  ///< numbers
  };

  void add(std::string_view name, std::span<const double> values) { append(name, "f64", values); }
  void add(std::string_view name, std::span<const std::uint32_t> values) {
    append(name, "u32", values);
  }
  void add(std::string_view name, std::span<const std::uint8_t> values) {
    append(name, "u8", values);
  }

  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  template <typename T>
  void append(std::string_view name, std::string_view type, std::span<const T> values) {
    static_assert(std::endian::native == std::endian::little);
    bytes_.resize((bytes_.size() + 7) / 8 * 8);
    entries_.push_back({std::string(name), type, bytes_.size(), values.size()});
    const auto raw = std::as_bytes(values);
    bytes_.insert(bytes_.end(), raw.begin(), raw.end());
  }

  std::vector<Entry> entries_;
  std::vector<std::byte> bytes_;
};

/// RFC 4648, padded: no character of it means anything in HTML.
[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

}  // namespace simulation
}  // namespace kairos
