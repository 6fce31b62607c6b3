#include "simulation/output/json_writer.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace kairos {
inline namespace simulation {
namespace {

std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

}  // namespace

JsonWriter::JsonWriter() : out_("{") {}

void JsonWriter::member(std::string_view key) {
  out_ += first_ ? "\n" : ",\n";
  out_.append(2 * static_cast<std::size_t>(depth_), ' ');
  out_ += quoted(key) + ": ";
  first_ = false;
}

void JsonWriter::open(std::string_view key) {
  member(key);
  out_ += '{';
  ++depth_;
  first_ = true;
}

void JsonWriter::close() {
  --depth_;
  if (!first_) {
    out_ += '\n';
    out_.append(2 * static_cast<std::size_t>(depth_), ' ');
  }
  out_ += '}';
  first_ = false;
}

void JsonWriter::text(std::string_view key, std::string_view value) {
  member(key);
  out_ += quoted(value);
}

void JsonWriter::number(std::string_view key, double value) {
  member(key);
  out_ += std::isfinite(value) ? fmt::format("{}", value) : "null";
}

void JsonWriter::count(std::string_view key, std::int64_t value) {
  member(key);
  out_ += fmt::format("{}", value);
}

void JsonWriter::flag(std::string_view key, bool value) {
  member(key);
  out_ += value ? "true" : "false";
}

std::string JsonWriter::finish() {
  while (depth_ > 0) {
    close();
  }
  return std::move(out_) + '\n';
}

}  // namespace simulation
}  // namespace kairos
