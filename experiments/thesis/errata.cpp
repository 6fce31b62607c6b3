#include "experiments/thesis/errata.hpp"

#include "experiments/output/atomic_file.hpp"
#include "experiments/parallel_for.hpp"
#include "experiments/thesis/thesis_figure.hpp"

#include <fmt/format.h>

#include <cmath>

namespace kairos::experiments::thesis {

// A new item is a function in errata_*.cpp, its declaration here and its entry below.
std::vector<Check> energy_gain(Size);
std::vector<Check> energy_of_other_integrators(Size);
std::vector<Check> roundoff_share(Size);
std::vector<Check> pushed_out(Size);
std::vector<Check> jiggle(Size);
std::vector<Check> knife_edge(Size);
std::vector<Check> tunnelling(Size);
std::vector<Check> gravity_as_a_force(Size);
std::vector<Check> swallowing_conveyor(Size);
std::vector<Check> whole_vector_exchange(Size);
std::vector<Check> one_collision_a_frame(Size);
std::vector<Check> box_of_a_ball(Size);
std::vector<Check> box_or_sphere(Size);
std::vector<Check> kinds_of_pairs(Size);
std::vector<Check> literal_substeps(Size);
std::vector<Check> one_contact_a_frame(Size);
std::vector<Check> cure_of_the_bat(Size);
std::vector<Check> corner_tests(Size);
std::vector<Check> velocity_from_positions(Size);
std::vector<Check> energy_proves_nothing(Size);

bool Check::confirmed() const {
  switch (agreement) {
    case Agreement::equal:
      return std::abs(measured - predicted) <= tolerance;
    case Agreement::at_most:
      return measured <= predicted;
    case Agreement::more_than:
      break;
  }
  return measured > predicted;
}

std::span<const Erratum> errata() {
  static const Erratum all[] = {
      {"1", "9.1.2", "balls gain energy by floating point and by handling collisions with velocity",
       "G²h²/(2m) a frame once the acceleration is set, whatever the bounces",
       "prediction 1: the original scheme gains G^2 h^2/(2m) a frame, whatever the bounces",
       energy_gain},
      {"1a", "9.1.2", "—",
       "symplectic Euler loses as much; integrators of order 2 and more gain nothing in flight",
       "prediction 1: symplectic Euler loses as much, orders of 2 and more gain nothing",
       energy_of_other_integrators},
      {"1b", "9.1.2", "floating point precision is a cause",
       "roundoff stays near 1e-15 of the energy; an impact changes none",
       "roundoff is all that differs between double and long double, and is no cause",
       roundoff_share},
      {"1c", "7.4", "moving the ball out of the bat reduces penetrations",
       "and adds m g d to its energy, for each move of d upwards",
       "pushing a ball out of the bat adds m g d to its energy", pushed_out},
      {"2", "9", "the ball penetrates the wall and jiggles around",
       "a reflection without an approach test turns a ball back inwards: never at a fixed frame "
       "time, with probability E[max(0, 1 - h2/h1)] under jitter",
       "prediction 2: no jiggle at a fixed frame time; about j/3 with jitter", jiggle},
      {"3", "—", "—", "whether the last frame lands in the wall can hang on roundoff",
       "prediction 3: whether the last frame lands in the wall can hang on roundoff", knife_edge},
      {"4", "9.1.1.1", "the interval between frames is too large: balls penetrate",
       "and miss: a fraction max(0, 1 - (w+2r)/(v h)) goes through",
       "prediction 4: the tunnelled fraction is max(0, 1 - (w+2r)/(v h))", tunnelling},
      {"5", "5.4.1", "gravity pulls with 9.8",
       "as a force, so that a ball of mass m falls with G/m",
       "prediction 5: gravity is a force, so a ball of mass m falls with G/m", gravity_as_a_force},
      {"6", "6.3.3", "the conveyor reflects a ball and pushes it sideways",
       "not one lighter than its belt of 10 kg: each frame inside, the exchange turns it outwards "
       "and the reflection back in, and it sinks through the belt at (10-m) G h/(2m); seconds for "
       "3 kg, minutes for 9.9",
       "prediction 6: the conveyor swallows a ball lighter than its belt", swallowing_conveyor},
      {"7", "6.4", "conservation of momentum and energy gives the velocities",
       "whole vectors are exchanged: at an angle θ off the centre line the direction is wrong by θ "
       "for a target at rest, by 2θ in the centre-of-mass frame",
       "prediction 7: ball on ball, the direction is wrong by the angle off the centre line",
       whole_vector_exchange},
      {"8", "13.1", "every object is tested against every other",
       "one collision for each object as `current` and frame; a second body on the same wall waits",
       "prediction 8: one collision per object as `current` in a frame, and the old-next guard",
       one_collision_a_frame},
      {"9", "3.5.2", "a ball collides as its box", "up to (√3 - 1) r early, at a corner",
       "prediction 9: a ball's box touches up to (sqrt 3 - 1) r early", box_of_a_ball},
      {"10", "3.2", "a box encloses a ball more tightly than a ball a box",
       "true in the plane (4/π, π/2), and more so in space (6/π, π√3/2)",
       "figure 5: a box fits a ball better than a ball fits a box", box_or_sphere},
      {"11", "6.1", "n objects have n! possible interactions",
       "n(n+1)/2 kinds of pairs; the two agree for n = 1 and for the thesis' example, n = 3",
       "prediction 11: n objects have n(n+1)/2 kinds of pairs, not n!", kinds_of_pairs},
      {"14", "9.1.1.2.1", "a box around both ends of a movement finds the collision",
       "the first of a frame: bodies do not pass, a driven bat included, if it starts at rest; "
       "what happens in the rest of that frame is not looked at",
       "the geometric approach: a bat from rest never passes, a ball between two walls gets out",
       one_contact_a_frame},
      {"12", "9.1.1.2.2", "smaller steps than frames catch the collision",
       "taken literally, with a threshold d of half of w + 2r, a fraction (d-r)/(v h) goes through "
       "where n = ceil(v h/d) - 1 is odd, r = v h - n d: all just above d/h, where the original "
       "lets "
       "none through; equal substeps and location mend it",
       "prediction 12: fig. 15 taken literally still tunnels; its mends do not", literal_substeps},
      {"12a", "9.1.3", "the analytic approach will also solve this problem (of the user's bat)",
       "taken literally it does not: strokes pass as without it, and with the thesis' boxes more "
       "(200 rallies of the figure table-tennis decide that; these are fewer)",
       "rally: fig. 15 taken literally does not cure the bat; equal substeps do", cure_of_the_bat},
      {"2.1.2", "2.1.2", "a test for AABBs: is a corner of C in D, for all four corners",
       "as printed it compares yd with itself and invents overlaps; corners miss crosses",
       "figures 2 and 3: corners miss overlaps, the printed test invents them", corner_tests},
      {"13.8", "7.2", "velocity is distance over time",
       "the distance since the last accepted sample over the last interval alone: 0.1 m/s reads "
       "0.65 m/s",
       "bat: a true speed of 0.1 m/s reads 0.65 m/s at 60 Hz", velocity_from_positions},
      {"E", "—", "—",
       "energy near its start alone proves nothing: late flips keep it and lose the "
       "state",
       "an energy error near 0 proves nothing: late flips keep energy and lose the state",
       energy_proves_nothing},
  };
  return all;
}

void tell_claims(FigureData& data);  // errata_claims.cpp

namespace {

std::string relation(const Check& check) {
  switch (check.agreement) {
    case Agreement::equal:
      return "=";
    case Agreement::at_most:
      return "at most";
    case Agreement::more_than:
      break;
  }
  return "more than";
}

const char* verdict(const Check& check) {
  switch (check.evidence) {
    case Evidence::arithmetic:
      return check.confirmed() ? "computed" : "refuted";
    case Evidence::observation:
      return check.confirmed() ? "observed" : "refuted";
    case Evidence::run:
      break;
  }
  return check.confirmed() ? "confirmed" : "refuted";
}

void measure(FigureData& data) {
  const std::span<const Erratum> all = errata();
  std::vector<std::vector<Check>> checks(all.size());
  parallel_for(all.size(), 0, [&](std::size_t i) { checks[i] = all[i].measure(data.size()); });
  Table& table = data.table("errata", {{"id", "", "number of the prediction, or section"},
                                       {"section", "", "of the thesis"},
                                       {"thesis", "", "what it says"},
                                       {"reading", "", "what its algorithm should do, then"},
                                       {"quantity", "", "what is measured"},
                                       {"unit", "", "of the next two"},
                                       {"relation", "", "how they are held against each other"},
                                       {"predicted", "", "by the reading"},
                                       {"measured", "", "by a run"},
                                       {"tolerance", "", "of the difference"},
                                       {"kind", "", "of the tolerance"},
                                       {"verdict", "", "on the reading"},
                                       {"test", "", "that holds it"}});
  std::int64_t confirmed = 0;
  std::int64_t refuted = 0;
  std::int64_t computed = 0;
  std::int64_t observed = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Erratum& e = all[i];
    for (const Check& check : checks[i]) {
      if (check.evidence == Evidence::run) {
        (check.confirmed() ? confirmed : refuted) += 1;
      } else {
        (check.evidence == Evidence::arithmetic ? computed : observed) += 1;
      }
      table.rows.push_back({std::string(e.id), std::string(e.section), std::string(e.thesis),
                            std::string(e.reading), check.quantity, check.unit, relation(check),
                            number_cell(check.predicted), number_cell(check.measured),
                            number_cell(check.tolerance), std::string(check.tolerance_kind),
                            std::string(verdict(check)), std::string(e.test)});
    }
  }
  data.count("items", static_cast<std::int64_t>(all.size()), "statements");
  data.count("decided", confirmed + refuted, "numbers that a run could have refuted");
  data.count("confirmed", confirmed, "of them, those that confirm the reading");
  data.count("refuted", refuted, "of them, those that refute it");
  data.count("computed", computed, "numbers that were counted or computed on both sides");
  data.count("observed", observed, "effects that were observed, with no number predicted");
  data.count("corrected", static_cast<std::int64_t>(corrected().size()),
             "first readings that runs refuted, and that were corrected");
  tell_claims(data);
}

}  // namespace

ThesisFigure errata_table() {
  return {
      .name = "errata",
      .chapter = "",
      .title = "Errata: what the thesis says, and what its algorithms do",
      .shows =
          "What follows from the thesis' algorithms where its text is silent, or says "
          "otherwise.",
      .how =
          "{items} statements, each with the test that holds it. A row is a number predicted in "
          "closed form from the reading of the thesis, and the number measured. Only where a run, "
          "or an answer of the library, could have said otherwise does it count as confirmed; "
          "what is counted or computed on both sides is called computed, and an effect of which "
          "no number was predicted, observed.",
      .caption = "",
      .finding =
          "Of {decided} numbers that a run could have refuted, {confirmed} confirm the reading and "
          "{refuted} refute it; {computed} are computed, {observed} observed. This is the reading "
          "after correction: {corrected} first readings were refuted by runs, and are listed below "
          "with what the runs said, with the contradictions within the thesis, and with the claims "
          "that no run here decides.",
      .script = "",
      .measure = measure};
}

}  // namespace kairos::experiments::thesis
