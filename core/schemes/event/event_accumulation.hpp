#pragma once

#include "core/schemes/event/event_motions.hpp"
#include "core/schemes/event/impact_cluster.hpp"
#include "core/schemes/event/impact_history.hpp"

#include <string>
#include <vector>

namespace kairos {
inline namespace core {

/// Decides whether impacts accumulate: infinitely many in a finite time, which no number of events
/// gets past, or a lasting contact of a kind that is not kept. It reasons from restitutions,
/// speeds, gaps and the forces that press. Elastic balls meet finitely often, however fast
/// [Vaserstein1979]: where no energy is lost, nothing is called a collapse.
class EventAccumulation {
 public:
  EventAccumulation(EventRun& run, const EventMotions& motions);

  /// How small a hop is taken for rest, m: where hops die down, between the two or because of
  /// another that one of them lately met, those that would follow are summed up, so that the height
  /// only has to be far below anything measured; otherwise only what is near the roundoff of
  /// coordinates and extents.
  [[nodiscard]] double rest_tolerance(BodyIndex a, BodyIndex b, double e) const;

  /// What impacts come to.
  struct Finding {
    enum class Kind {
      none,      ///< they go on
      rests,     ///< what is left of the hops is nothing
      collapse,  ///< infinitely many in a finite time, after which the bodies are in touch
      creeps,    ///< they follow each other on no way at all
      squeezed,  ///< no room is left for them
    };
    Kind kind = Kind::none;
    std::string reason;             ///< why the run could not go on past it
    double remaining = 0.0;         ///< until a collapse is over, s
    std::vector<BodyIndex> bodies;  ///< who takes part
    std::size_t pairs = 0;          ///< how many of them collapse
    bool goes_on = false;           ///< the impacts may go on for now
    bool endless = false;           ///< they did so for long, and got nowhere
  };
  /// Whether very many impacts of one of the two followed each other on no way at all.
  [[nodiscard]] bool creep(BodyIndex a, BodyIndex b) const;
  /// An impact that met at `approach`, m/s, left the two at `now`.
  [[nodiscard]] Finding after_impact(BodyIndex a, BodyIndex b, double approach, Instant t);

  /// Two plain balls, or one and a wall, have struck each other. None of what follows asks for
  /// their states at `now`.
  struct Rebound {
    const PlainBall* ball_a;  ///< null: a wall
    const PlainBall* ball_b;
    const Event& event;     ///< of the impact
    double approach = 0.0;  ///< at which they met, m/s, > 0
    double parting = 0.0;   ///< at which they part, m/s; < 0: they do not
  };
  /// What impacts of a pair are measured with.
  struct Scale {
    double tolerance = 0.0;  ///< see `rest_tolerance`, m
    double pressing = 0.0;   ///< accelerations that press the two together at most, m/s^2
    double near_a = 0.0;     ///< shorter ways than this hang together, m
    double near_b = 0.0;
  };
  [[nodiscard]] Scale scale_of(const Rebound& of) const;
  /// Whether they part by more than what presses them together, or rounding, could make of rest.
  [[nodiscard]] static bool part_for_sure(const Rebound& of, const Scale& scale);
  /// Counts the impact as `after_impact` does; whether it is one of those that just go on. If not,
  /// that is still to be asked.
  [[nodiscard]] bool go_on_for_sure(const Rebound& of, const Scale& scale);
  /// What follows of such an impact, which is counted; the two are at `now`.
  [[nodiscard]] Finding after_impact(const Rebound& of, const Scale& scale) const;
  /// Says that the body that two pairs share is between two that nothing stops from meeting: its
  /// impacts follow each other ever faster until no room is left. Empty: it is not.
  [[nodiscard]] std::string squeeze(const BodyPair& one, const BodyPair& other, Instant t) const;
  /// A look at a pair at t that changed nothing: true where looks get nowhere, each within
  /// `resolution`, s, of the one before.
  [[nodiscard]] bool stalls(BodyIndex a, BodyIndex b, Instant t, double resolution);
  /// Body i, which stalled, goes on in another way.
  void go_on(BodyIndex i) { histories_[i].go_on(); }

  /// An impact of body i is about to come.
  void look_up(BodyIndex i) const { prefetch(histories_[i]); }

  void persist(Archive& archive);

 private:
  [[nodiscard]] bool lately_lost(BodyIndex i) const;
  [[nodiscard]] static double rest_tolerance(double extent, double coordinate, bool dies_down);
  [[nodiscard]] Finding conclude(BodyIndex a, BodyIndex b, double tolerance, bool resting,
                                 Instant t) const;
  [[nodiscard]] bool rests(BodyIndex a, BodyIndex b, double approach, double tolerance,
                           Instant t) const;
  [[nodiscard]] Finding collapse(BodyIndex a, BodyIndex b, Instant t,
                                 std::int64_t most_impacts) const;
  [[nodiscard]] std::string squeeze(BodyIndex i, BodyIndex one, BodyIndex other, Instant t) const;
  [[nodiscard]] std::vector<BodyPair> cluster_pairs(BodyIndex a, BodyIndex b) const;
  [[nodiscard]] double restitution(BodyIndex a, BodyIndex b) const;

  EventRun& run_;
  const EventMotions& motions_;
  std::vector<ImpactHistory> histories_;
};

}  // namespace core
}  // namespace kairos
