#pragma once

#include "experiments/sweeps/expression.hpp"
#include "experiments/sweeps/spec_section.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kairos::experiments {

/// One value on an axis.
struct AxisValue {
  std::string text;              ///< as written in the table
  std::string toml;              ///< as written in the scene it overrides
  std::optional<double> number;  ///< for expressions; empty for text
};

/// One direction of a sweep: values that are walked through, or drawn anew for each repeat.
struct Axis {
  enum class Kind {
    listed,      ///< list, linear, log: every value
    random,      ///< uniform in [from, to), one independent draw per repeat
    stratified,  ///< from + (to - from) (k + u)/n for repeat k of n, one shared u per point: the
                 ///< fraction of repeats that falls into any interval is right within 1/n
  };
  std::string name;  ///< column of the table, name in expressions
  std::string unit;
  std::string label;  ///< on figures
  std::string key;    ///< scene key or `method.option` it sets; empty: used in expressions only
  Kind kind = Kind::listed;
  bool logarithmic = false;  ///< drawn on a logarithmic scale
  std::vector<AxisValue> values;
  double from = 0.0;
  double to = 1.0;
  int line = 0;
};

/// A scene value or method option: literal TOML, or expressions over axes and constants.
struct Setting {
  struct Part {
    std::string text;
    bool expression = false;
  };
  std::string key;
  std::vector<Part> parts;
  bool array = false;
  int line = 0;
};

/// One way of simulating, under the name it has in tables and figures.
struct MethodSpec {
  std::string name;
  std::vector<Setting> options;  ///< scheme, integrator, detector, impact, frame, ...
  std::vector<Setting> set;      ///< scene values that belong to this method (bounds, gravity)
  std::string mark;              ///< of its line in the generic figure; empty: its usual one
};

/// A column computed from axes, constants and metrics: predictions.
struct Derived {
  std::string name;
  std::string unit;
  std::string expression;
  int line = 0;
};

/// Every combination of axis values, methods and repeats of one scene.
struct SweepSpec {
  std::string file;  ///< where it was written, for messages
  int line = 0;
  std::string name;
  std::string caption;
  std::string scene;    ///< name of a scene, or path relative to the spec
  std::string subject;  ///< body that metrics follow; empty: the first free one
  std::uint64_t seed = 1;
  std::int64_t repeats = 1;
  std::vector<std::string> metrics;
  Values constants;
  std::vector<Axis> axes;
  std::vector<MethodSpec> methods;
  std::vector<Setting> options;  ///< of all methods; a method's own come after them
  std::vector<Setting> set;      ///< scene values of all methods
  std::vector<Derived> derived;
  std::string reference;     ///< method that others are compared with: adds `METRIC_error` columns
  bool series = false;       ///< also writes energy over time and apex heights
  std::int64_t samples = 0;  ///< of a series, per run
  std::string x;             ///< for the generic figure: axis
  std::string y;             ///< and metric
  bool logarithmic = false;  ///< metrics are drawn on logarithmic scales
};

/// What a spec file says: the sweeps and how to present them.
struct ExperimentSpec {
  std::string path;
  std::string name;
  std::string title;
  std::string asks;      ///< the question
  std::string how;       ///< the method of the experiment
  std::string finding;   ///< what to look at
  std::string figure;    ///< script in `experiments/figures`; empty: the generic one
  std::string program;   ///< what is run instead of sweeps (`run_experiment`); empty: the sweeps
  int program_line = 0;  ///< where it was written
  std::vector<std::string> scenes;  ///< of a program
  std::vector<double> durations;    ///< of these, s; empty: their own
  std::vector<SweepSpec> sweeps;
};

/// Reads a spec. Throws `InputError` with file, line and key.
[[nodiscard]] ExperimentSpec read_experiment(const std::string& path, Size size);
[[nodiscard]] ExperimentSpec parse_experiment(std::string_view text, const std::string& path,
                                              Size size);

}  // namespace kairos::experiments
