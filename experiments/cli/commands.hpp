#pragma once

#include "experiments/cli/command_line.hpp"

namespace kairos::experiments {

/// One function and one file (`command_xxx.cpp`) per subcommand, listed in `cli.cpp`. Each adds its
/// subcommand with options and a callback. A callback writes results to stdout or to files,
/// messages to stderr, and throws `InputError` (exit 2) or `RunError` (exit 1).
void add_run_command(Command& app);
void add_explain_command(Command& app);
void add_list_command(Command& app);
void add_toi_command(Command& app);
void add_vfee_command(Command& app);
void add_collide_command(Command& app);
void add_mesh_command(Command& app);
void add_distance_command(Command& app);
void add_deform_command(Command& app);
void add_sweep_command(Command& app);
void add_experiment_command(Command& app);
void add_reproduce_command(Command& app);
void add_record_command(Command& app);
void add_render_command(Command& app);
void add_plot_command(Command& app);
void add_physworld_command(Command& app);
void add_bench_command(Command& app);
void add_tradeoff_command(Command& app);
void add_recommend_command(Command& app);
void add_view_command(Command& app);
void add_random_scenes_command(Command& app);

}  // namespace kairos::experiments
