#pragma once

// The room `core`, as a consumer sees it: bodies and scenes, motions, events, and the ports that
// plug-ins implement. `#include <kairos/core.hpp>`; see core/README.md.
#include "core/broad_phase.hpp"
#include "core/compound_body.hpp"
#include "core/contact_detector.hpp"
#include "core/drive.hpp"
#include "core/energy_ledger.hpp"
#include "core/entity.hpp"
#include "core/error.hpp"
#include "core/event.hpp"
#include "core/exact_solution.hpp"
#include "core/force.hpp"
#include "core/frame_times.hpp"
#include "core/gap_function.hpp"
#include "core/impact_law.hpp"
#include "core/instant.hpp"
#include "core/mass_properties.hpp"
#include "core/mesh_body.hpp"
#include "core/mesh_data.hpp"
#include "core/mesh_defects.hpp"
#include "core/mesh_shapes.hpp"
#include "core/model.hpp"
#include "core/motion.hpp"
#include "core/pose.hpp"
#include "core/random.hpp"
#include "core/reading/frame_reader.hpp"
#include "core/reading/mesh_file.hpp"
#include "core/reading/scene_reader.hpp"
#include "core/reading/track_reader.hpp"
#include "core/recorder.hpp"
#include "core/scene.hpp"
#include "core/scheme.hpp"
#include "core/shape.hpp"
#include "core/state.hpp"
#include "core/stepper.hpp"
#include "core/time_of_impact.hpp"
#include "core/trajectory.hpp"

/// What happens between two frames, and what does it cost to know? SI units; y is up.
namespace kairos {}
/// The world and the clock: scenes, models, motions, schemes, and the ports that other rooms
/// implement.
namespace kairos::inline core {}
