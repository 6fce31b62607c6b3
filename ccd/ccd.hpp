#pragma once

// The room `ccd`, as a consumer sees it: detectors, swept boxes, broad phases, questions about one
// instant, vertices and edges on straight lines, meshes that deform. `#include <kairos/ccd.hpp>`;
// see ccd/README.md.
#include "ccd/all_pairs.hpp"
#include "ccd/bisection.hpp"
#include "ccd/box_batch.hpp"
#include "ccd/certified.hpp"
#include "ccd/collision_world.hpp"
#include "ccd/conservative_advancement.hpp"
#include "ccd/contact_patch.hpp"
#include "ccd/deforming/deforming_mesh.hpp"
#include "ccd/deforming/deforming_pair.hpp"
#include "ccd/dynamic_tree.hpp"
#include "ccd/linear/linear_impact.hpp"
#include "ccd/mesh/mesh_queries.hpp"
#include "ccd/nearest_points.hpp"
#include "ccd/pair_overlap.hpp"
#include "ccd/placed_cores.hpp"
#include "ccd/sat.hpp"
#include "ccd/step_ends.hpp"
#include "ccd/sweep_and_prune.hpp"
#include "ccd/swept_box.hpp"
#include "ccd/toi_batch.hpp"

/// Geometry in time: overlap, distance, swept volumes, time of impact.
namespace kairos::ccd {}
