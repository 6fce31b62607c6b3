#pragma once

#include "core/drive.hpp"
#include "core/reading/table_reader.hpp"
#include "core/scene.hpp"

#include <memory>
#include <string>

namespace kairos {
inline namespace core {

/// Reads `[body.drive]`: a recorded track or a sinusoid about the pose that the body is given.
/// `directory`: what a track's path is relative to. Throws `InputError`.
[[nodiscard]] std::shared_ptr<const Drive> read_drive(const Item& item, const Body& body,
                                                      const std::string& directory);

}  // namespace core
}  // namespace kairos
