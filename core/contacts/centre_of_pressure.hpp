#pragma once

#include "core/contact_manifold.hpp"

namespace kairos {
inline namespace core {

/// Whether x, on the plane of a patch, is among its points, or so near (1e-9 of their extent) that
/// roundoff could have put it beyond: forces at the points may then act together at x.
[[nodiscard]] bool carries_at(const ContactManifold& patch, const Vector3& x);

}  // namespace core
}  // namespace kairos
