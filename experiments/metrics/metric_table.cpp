#include "experiments/metrics/metric_table.hpp"

#include <limits>

namespace kairos::experiments {
namespace {

using O = const Observation&;

constexpr double none = std::numeric_limits<double>::quiet_NaN();  // becomes an empty value

template <EnergyLine line>
double ledger(O o) {
  return o.result.ledger.line(line);
}

template <std::int64_t Cost::*count>
double counted(O o) {
  return static_cast<double>(o.result.cost.*count);
}

template <int axis>
double end_position(O o) {
  return o.subject.pose.position[axis];
}

std::vector<Metric> constraint_metrics() {
  return {
      {{"max_penetration", "m", "deepest overlap of two solids in a drawn frame"},
       [](O o) { return o.frames->in_frames.depth; },
       Needs::frames},
      {{"max_penetration_between", "m", "deepest overlap along the motions between frames"},
       [](O o) { return o.between->max_depth(); },
       Needs::between},
      {{"overlap_time", "s", "how long drawn frames showed an overlap"},
       [](O o) { return o.frames->time_overlapping; },
       Needs::frames},
      {{"overlap_frames", "", "drawn frames that showed an overlap"},
       [](O o) { return static_cast<double>(o.frames->frames_overlapping); },
       Needs::frames},
      {{"tunnelled", "", "1 if a free body ended on the other side of a solid"},
       [](O o) { return o.crossing->tunnelled() ? 1.0 : 0.0; },
       Needs::crossing},
      {{"crossings", "", "how often a centre passed through a solid"},
       [](O o) { return static_cast<double>(o.crossing->crossings()); },
       Needs::crossing},
      {{"joint_drift", "",
        "largest residual of a joint in a drawn frame, relative to the mechanism's size"},
       [](O o) { return o.joints->max_drift(); },
       Needs::joints},
  };
}

std::vector<Metric> energy_metrics() {
  return {
      {{"energy_error", "", "energy that no physics accounts for, relative to the energy there is"},
       [](O o) { return o.frames->relative(energy_error(o.result.ledger)); },
       Needs::frames},
      {{"energy_gain", "J", "energy at the end minus energy at the start"},
       [](O o) { return o.result.ledger.energy() - o.result.ledger.initial_energy(); }},
      {{"energy", "J", "energy at the end"}, [](O o) { return o.result.ledger.energy(); }},
      {{"kinetic", "J", "kinetic energy at the end"},
       [](O o) { return o.result.ledger.kinetic(); }},
      {{"field_work", "J", "ledger: work of fields"}, ledger<EnergyLine::field_work>},
      {{"driven_work", "J", "ledger: work of driven bodies"}, ledger<EnergyLine::driven_work>},
      {{"restitution_loss", "J", "ledger: lost in impacts"}, ledger<EnergyLine::restitution_loss>},
      {{"truncation", "J", "ledger: truncation of the integrator"}, ledger<EnergyLine::truncation>},
      {{"late_impact", "J", "ledger: impacts handled late"}, ledger<EnergyLine::late_impact>},
      {{"position_correction", "J", "ledger: bodies moved out of others"},
       ledger<EnergyLine::position_correction>},
      {{"conveyor_and_hand", "J", "ledger: belts and hands"},
       ledger<EnergyLine::conveyor_and_hand>},
      {{"roundoff", "J", "ledger: roundoff, where it was asked for"}, ledger<EnergyLine::roundoff>},
      {{"friction", "J", "ledger: friction between impacts"}, ledger<EnergyLine::friction>},
      {{"impact_friction", "J", "ledger: friction in impacts"},
       ledger<EnergyLine::impact_friction>},
      {{"zeno_completion", "J", "ledger: accumulations that were completed"},
       ledger<EnergyLine::zeno_completion>},
      {{"projection", "J", "ledger: velocities put back to constraints"},
       ledger<EnergyLine::projection>},
      {{"unexplained", "J", "what no line of the ledger explains"},
       [](O o) { return o.result.ledger.unexplained(); }},
      {{"flow", "J", "sum of the magnitudes of all flows of energy"},
       [](O o) { return o.result.ledger.flow(); }},
  };
}

std::vector<Metric> impact_metrics() {
  return {
      {{"first_apex", "m", "height of the first apex"},
       [](O o) { return o.apex.apexes().empty() ? none : o.apex.apexes().front().height; },
       Needs::apex},
      {{"last_apex", "m", "height of the last apex"},
       [](O o) { return o.apex.apexes().empty() ? none : o.apex.apexes().back().height; },
       Needs::apex},
      {{"first_impact", "s", "time of the first impact of the subject"},
       [](O o) { return o.impacts.first().value_or(none); }},
      {{"last_impact", "s", "time of the last impact of the subject"},
       [](O o) { return o.impacts.last().value_or(none); }},
      {{"rest_time", "s", "when the subject came to rest on a surface"},
       [](O o) { return o.impacts.rest().value_or(none); }},
      {{"separating_impacts", "", "impacts handled although the bodies were moving apart"},
       [](O o) { return static_cast<double>(o.impacts.separating()); }},
      {{"bounces", "", "impacts of bodies that were approaching"},
       [](O o) { return static_cast<double>(o.impacts.approaching()); }},
  };
}

std::vector<Metric> end_metrics() {
  return {
      {{"end_time", "s", "how far the run got"}, [](O o) { return o.result.end.seconds; }},
      {{"end_x", "m", "position of the subject at the end"}, end_position<0>},
      {{"end_y", "m", "position of the subject at the end"}, end_position<1>},
      {{"end_z", "m", "position of the subject at the end"}, end_position<2>},
      {{"position_error", "m",
        "distance of the subject from the scene's exact solution at the end"},
       [](O o) {
         return o.exact == nullptr ? none
                                   : (o.subject.pose.position - o.exact->pose.position).norm();
       },
       Needs::exact},
      {{"end_speed", "m/s", "speed of the subject at the end"},
       [](O o) { return o.subject.twist.linear.norm(); }},
      {{"end_spin", "rad/s", "angular speed of the subject at the end"},
       [](O o) { return o.subject.twist.angular.norm(); }},
  };
}

std::vector<Metric> cost_metrics() {
  return {
      {{"frames", "", "frames"}, counted<&Cost::frames>},
      {{"steps", "", "integrator steps"}, counted<&Cost::steps>},
      {{"right_hand_sides", "", "right-hand sides evaluated"}, counted<&Cost::right_hand_sides>},
      {{"overlap_tests", "", "overlap tests"}, counted<&Cost::overlap_tests>},
      {{"toi_queries", "", "time-of-impact queries"}, counted<&Cost::toi_queries>},
      {{"toi_evaluations", "", "gap evaluations in these"}, counted<&Cost::toi_evaluations>},
      {{"contact_solves", "", "of single contacts, by solvers for contact impulses"},
       counted<&Cost::contact_solves>},
      {{"impacts", "", "impacts handled"}, counted<&Cost::impacts>},
      {{"events", "", "events"}, counted<&Cost::events>},
  };
}

}  // namespace

const std::vector<Metric>& metric_table() {
  static const std::vector<Metric> all = [] {
    std::vector<Metric> table;
    for (const auto& part : {constraint_metrics(), energy_metrics(), impact_metrics(),
                             end_metrics(), cost_metrics()}) {
      table.insert(table.end(), part.begin(), part.end());
    }
    return table;
  }();
  return all;
}

}  // namespace kairos::experiments
