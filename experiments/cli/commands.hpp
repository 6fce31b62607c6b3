#pragma once

namespace CLI {
class App;
}

namespace kairos::experiments {

/// One function and one file (`command_xxx.cpp`) per subcommand, listed in `cli.cpp`. Each adds its
/// subcommand with options and a callback. A callback writes results to stdout or to files,
/// messages to stderr, and throws `InputError` (exit 2) or `RunError` (exit 1).
void add_run_command(CLI::App& app);
void add_explain_command(CLI::App& app);
void add_list_command(CLI::App& app);
void add_toi_command(CLI::App& app);
void add_vfee_command(CLI::App& app);
void add_collide_command(CLI::App& app);
void add_mesh_command(CLI::App& app);
void add_distance_command(CLI::App& app);
void add_sweep_command(CLI::App& app);
void add_experiment_command(CLI::App& app);
void add_reproduce_command(CLI::App& app);
void add_record_command(CLI::App& app);
void add_render_command(CLI::App& app);
void add_plot_command(CLI::App& app);
void add_physworld_command(CLI::App& app);
void add_bench_command(CLI::App& app);
void add_tradeoff_command(CLI::App& app);
void add_recommend_command(CLI::App& app);
void add_view_command(CLI::App& app);
void add_random_scenes_command(CLI::App& app);

}  // namespace kairos::experiments
