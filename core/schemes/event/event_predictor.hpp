#pragma once

#include "core/contacts/contact_graph.hpp"
#include "core/looks_ahead.hpp"
#include "core/prefetch.hpp"
#include "core/schemes/event/event_motions.hpp"
#include "core/schemes/shared/grasps.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace kairos {
inline namespace core {

class BallDetector;

/// When will pairs meet or part? Asks the detector about the motions that bodies have, no further
/// than the end of the epoch, and puts the answers on the agenda.
///
/// A query is canonical: its window starts where the later of the two motions does (or where an
/// epoch does, or what a hand let go of comes clear), whenever it is made. So an answer depends on
/// the two motions alone, and not on who else is near: a broad phase changes what a run costs, and
/// no bit of it.
class EventPredictor {
 public:
  EventPredictor(EventRun& run, const EventMotions& motions, const Grasps& grasps,
                 const ContactGraph& graph, const Method& method);

  /// All pairs, from t on.
  void predict_all(Instant t);
  /// All pairs of i, which moves or meets others from t on as it did not before.
  void predict(BodyIndex i, Instant t) { predict(i, t, i); }
  /// All pairs of i but that with `except`, as it is itself and not as an image.
  void predict(BodyIndex i, Instant t, BodyIndex except);
  /// `predict` of a, and of b but with a, where both fly on alone: who is near b is fetched while a
  /// is predicted, and the other way round.
  void predict_struck(BodyIndex a, BodyIndex b, Instant t);
  /// All pairs of all bodies of the island of i, which was launched at t.
  void predict_island(BodyIndex i, Instant t);
  /// Body i, which moves as before, comes near others.
  void cross(BodyIndex i, Instant t);
  /// The earliest meeting of i was not what it seemed, or is over.
  void renew(BodyIndex i, Instant t);
  /// A pair whose last answer told nothing beyond t: i and the image n of j.
  void predict_pair(BodyIndex i, BodyIndex j, const Image& n, Instant t);
  /// Body i is counted on as its image n, on the motion that it has.
  void go_on_as(BodyIndex i, const Image& n);
  /// Of two that meet in different boxes, which is counted on in that of the other, and so is
  /// seen where the other is while the two are asked about: b if it moves by itself, else a.
  [[nodiscard]] BodyIndex mover(BodyIndex a, BodyIndex b) const { return goes_alone(b) ? b : a; }
  /// Whether nothing holds body i where it is.
  [[nodiscard]] bool goes_alone(BodyIndex i) const;

  /// Solids that body i could touch now, appended: some of them as images.
  void solids_near(BodyIndex i, std::vector<Neighbour>& out);

  /// Beyond this gap two bodies do not touch, m: twice what a detector may leave between them (its
  /// tolerance, the roundoff of the coordinates that their motions reach, their error radii). No
  /// impact law acts across more.
  [[nodiscard]] double touching_gap(BodyIndex a, BodyIndex b) const;
  /// That of two plain balls, or of one and a wall (null), is no less, wherever they are, m.
  [[nodiscard]] double least_touching_gap(const PlainBall* a, const PlainBall* b) const;

  /// Body i is about to be predicted.
  void look_up(BodyIndex i) const {
    prefetch(since_[i]);
    if (looks_ahead_ != nullptr) {
      looks_ahead_->look_up(i);
    }
  }
  /// And those near it will be asked about; it has been looked up.
  void look_around(BodyIndex i) const {
    if (looks_ahead_ != nullptr) {
      looks_ahead_->look_around(i);
    }
  }

  void persist(Archive& archive);

 private:
  /// A pair from an instant on; what was due up to `known` has been dealt with.
  struct PairQuery {
    BodyIndex a = 0;
    BodyIndex b = 0;
    Instant from;
    double duration = 0.0;  ///< s
    Instant known;
    bool kept = false;  ///< whether a meeting is kept as that of `asker`
    BodyIndex asker = 0;
    Image image{};  ///< of b, as a sees it
    int links = 0;  ///< answers before this one, each asked about what follows the one before
  };
  /// Who may be near, and no meeting with whom is due before.
  struct Near {
    Neighbour who;
    Instant clear;
    bool usual = false;  ///< as i is, and not an image
  };
  static constexpr Instant before_all{-std::numeric_limits<double>::infinity(), 0.0};

  /// Until when a motion that body i has now may be asked about.
  [[nodiscard]] Instant last_of(BodyIndex i) const {
    return std::min(motions_.end_of(i), run_.epoch_end());
  }
  void enter(BodyIndex i, Instant t);
  void predict_near(BodyIndex i, const Neighbour& j, Instant known = before_all);
  void survey_all(BodyIndex i, BodyIndex except);
  void survey(BodyIndex i, Instant known) { survey(i, known, i); }
  void survey(BodyIndex i, Instant known, BodyIndex except);
  void survey_usual(BodyIndex i, Instant known, BodyIndex except);
  void meet_balls(BodyIndex i, Instant known);
  void filter_beside();
  void ask_near(BodyIndex i, Instant known);
  void ask_usual(BodyIndex i, BodyIndex j, Instant known);
  [[nodiscard]] bool is_beyond(BodyIndex i, BodyIndex wall) const;
  [[nodiscard]] bool keeps_meeting(BodyIndex i, BodyIndex with) const;
  void ask(BodyIndex i, const Neighbour& j, Instant from, Instant known, int links = 0);
  void ask_on(const PairQuery& of, Instant from);
  void push(const PairQuery& of, double after, DueKind kind, double bracket = 0.0,
            bool decided = true);
  /// Whether b is seen as an image of it.
  [[nodiscard]] bool is_imaged(const PairQuery& of) const {
    return run_.model.scene().periodic && !is_zero(of.image);
  }
  void move_to(const Image& n, BallFlight& flight) const;
  [[nodiscard]] bool stay_clear(const PairQuery& of);
  void predict_meeting(const PairQuery& query);
  void take_answer(const PairQuery& query, const TimeOfImpact& toi);
  [[nodiscard]] TimeOfImpact time_of_impact(const PairQuery& of, double duration);
  [[nodiscard]] std::optional<TimeOfImpact> ball_meets_plane(const PairQuery& of,
                                                             const Window& window) const;
  [[nodiscard]] Motion motion_of(BodyIndex i, const PairQuery& of) const;
  [[nodiscard]] double answered_gap(const PairQuery& of) const;
  void push_meeting(const PairQuery& of, const TimeOfImpact& toi);
  void look_nearer(const PairQuery& query, TimeOfImpact toi);
  void predict_parting(const PairQuery& query, DueKind kind);
  [[nodiscard]] bool approach(const PairQuery& query) const;
  void leave_overlap(const PairQuery& query);
  /// What a query cost is told.
  TimeOfImpact counted(const TimeOfImpact& toi);
  TimeOfImpact without_errors(const PairQuery& of);
  [[nodiscard]] TimeOfImpact time_of_separation(const PairQuery& of);

  EventRun& run_;
  const EventMotions& motions_;
  const Grasps& grasps_;
  const ContactGraph& graph_;
  std::unique_ptr<Neighbourhood> neighbourhood_;  ///< null: every partner is a neighbour
  const LooksAhead* looks_ahead_ = nullptr;       ///< that, if it can be told; else null
  /// Without that, by body: what it can interact with.
  std::vector<std::vector<BodyIndex>> partners_;
  std::vector<Instant> since_;         ///< by body: from when on its pairs are asked
  const BallDetector* ball_detector_;  ///< the detector, if it is one; else null
  /// Nothing but their motions says when two plain balls meet.
  bool only_motions_ = false;
  bool bounds_hold_ = false;               ///< a detector tells no contact before there is one
  std::vector<std::uint32_t> themselves_;  ///< scratch, as what follows
  std::vector<Neighbour> neighbours_;
  std::vector<std::uint32_t> themselves_of_other_;
  std::vector<Neighbour> neighbours_of_other_;
  std::vector<std::uint32_t> usual_;  ///< as long as it has had to be
  std::vector<Neighbour> balls_;
  BallFlight own_;
  FlightsBeside beside_;  ///< that
  FlightsBeside pair_;
  std::vector<double> clear_;  ///< as long as it has had to be
  std::vector<Near> near_;
};

}  // namespace core
}  // namespace kairos
