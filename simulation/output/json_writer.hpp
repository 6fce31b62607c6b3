#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace kairos {
inline namespace simulation {

/// Builds a JSON text with one member a line. NaN and infinity, which JSON has not, become null.
class JsonWriter {
 public:
  JsonWriter();

  void open(std::string_view key);
  void close();
  void text(std::string_view key, std::string_view value);
  void number(std::string_view key, double value);
  void count(std::string_view key, std::int64_t value);
  void flag(std::string_view key, bool value);

  /// Closes the whole and returns it.
  [[nodiscard]] std::string finish();

 private:
  void member(std::string_view key);

  std::string out_;
  int depth_ = 1;
  bool first_ = true;  ///< of its object
};

}  // namespace simulation
}  // namespace kairos
