#pragma once

#include "core/shape.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kairos {
inline namespace core {

/// A model as an OFF file lists it: vertices, and faces as indices of vertices. The thesis' objects
/// are drawn from such files (3.3, 5.4.2).
struct OffModel {
  std::vector<Vector3> vertices;
  std::vector<std::vector<std::size_t>> faces;  ///< three indices or more each
};

/// Reads an OFF file: `OFF` (or `COFF`, `NOFF` with a colour or a normal at each vertex), the
/// numbers of vertices, faces and edges, a line per vertex and per face (`3 0 1 2`, a colour may
/// follow). Lines that start with # and blank lines are skipped. Throws `InputError` with file and
/// line for everything else: a count that is not met, an index of no vertex, a number that is none.
[[nodiscard]] OffModel read_off(const std::string& path);
[[nodiscard]] OffModel parse_off(std::string_view text, const std::string& path);

/// What listens to a model that is read, so that it need not be kept as a list of lists.
class OffSink {
 public:
  virtual ~OffSink() = default;
  virtual void vertex(const Vector3& p, int line) = 0;
  /// Three corners or more, each a vertex that was told; `line` of the file.
  virtual void face(std::span<const std::size_t> corners, int line) = 0;
};
void parse_off(std::string_view text, const std::string& path, OffSink& sink);

/// The box of 3.3: half way between the greatest and the least along each axis of the model.
struct FittedBox {
  Vector3 centre = Vector3::Zero();
  Vector3 half_extents = Vector3::Zero();  ///< 0 along an axis where the model is flat
};
[[nodiscard]] FittedBox fit_box(const OffModel& model);

}  // namespace core
}  // namespace kairos
