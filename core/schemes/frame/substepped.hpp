#pragma once

#include "core/scheme.hpp"

#include <memory>

namespace kairos {
inline namespace core {

/// `substepped`: the second cure as drawn (9.1.1.2.2, fig. 15). Movements beyond a threshold are
/// scaled back to it, which lets a fraction of the frame pass; contacts are detected there; and so
/// on until the fractions make a frame. Literally, the last substep can be short, and a reflected
/// ball that is still inside is turned back; `equal_substeps` mends that.
[[nodiscard]] std::unique_ptr<Scheme> make_substepped();

}  // namespace core
}  // namespace kairos
