// Bodies that do not rotate, event by event: the exact moment of every impact, and the rest of the tick used.
//
// Between events each body flies in closed form (FlightFree.h). A queue gives the next event of all pairs; it
// is handled, and only the pairs of the bodies that it changed are examined again. Bodies that lie on one
// another get the accelerations that keep them so (ImpactRest.h) and then fly like any other until something
// changes. Results depend on ids, places relative to one another, and inputs alone.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/broadphase/ImpactTree.h"
#include "physics/impact/ImpactBody.h"
#include "physics/impact/ImpactRest.h"
#include "physics/impact/ImpactTime.h"

namespace naiad::physics {

/// A contact began or ended. A bounce does both.
struct ImpactEvent {
  double time;  ///< since the start of the tick
  int first;    ///< the lower id
  int second;
  bool is_begin;
  double impulse;  ///< along the normal, on second, when it begins
  Vec2 normal;     ///< from first to second
  int order = 0;   ///< index in the list
};

/// What has happened since the world was made.
struct ImpactCounters {
  std::int64_t ticks = 0;
  std::int64_t impacts = 0;
  std::int64_t forecasts = 0;    ///< pairs examined
  std::int64_t overlaps = 0;     ///< of those, how many were too deep in one another to be kept apart
  std::int64_t rest_solves = 0;  ///< groups of resting bodies
  std::int64_t unconverged = 0;  ///< of those, how many got an approximate solution
  std::int64_t quarantined = 0;  ///< bodies frozen
  std::int64_t given_up = 0;     ///< bodies whose tick would have cost too much
};

enum class ImpactStepStatus : std::uint8_t {
  kDone,
  kQuarantined,  ///< done, and at least one body had to be frozen
  kRefused       ///< not a time; nothing happened
};

/// Not thread-safe. No allocation in step() once the scene has shown what it needs.
class ImpactWorld {
 public:
  /// What a tick may take, in multiplications (about a nanosecond each): so much …
  static constexpr double kWorkOfTick = 1e6;
  /// … so much for each body, whose own share that is …
  static constexpr double kWorkOfBody = 5e3;
  /// … and so much for each event, which covers an impact of two bodies, but not the solution of a large
  /// group that lies there. Events get it until a reserve is empty. A body whose own share is spent when all
  /// of it is gone is given up for this tick.
  static constexpr double kWorkOfEvent = 1e3;
  static constexpr double kUsualReserve = 20'000 * kWorkOfEvent;
  /// Bounds the work of ticks: until then it is not.
  void setReserve(double work) { m_reserve = work; }
  /// A bounce that would not rise higher than this (cells) ends in rest: the Zeno guard. Far below the
  /// world's unit of 2^-32 cell.
  static constexpr double kRestHeight = 1e-11;
  /// So does one that follows as many others of the same body in the same moment, unless it is elastic.
  static constexpr int kMaxAtOnce = 32;

  /// Two bodies that were put into one another deeper than this pass until they have parted. (What cannot be
  /// pushed lets no body go deeper.)
  static constexpr double kDeepest = 1e-6;

  /// Returns the id, the lowest free one, or −1 if the body is not sound.
  int add(const ImpactBody& body);
  /// Replaces a body, and thaws it. False if there is none, or `body` is not sound; then nothing changes.
  bool set(int id, const ImpactBody& body);
  /// Its contacts end without an event.
  bool remove(int id);

  const ImpactBody& body(int id) const { return m_bodies[id]; }
  bool exists(int id) const {
    return id >= 0 && id < static_cast<int>(m_bodies.size()) && m_motions[id].exists;
  }
  /// Is the body in quarantine? It is kept as it is and collides with nothing, until set().
  bool isFrozen(int id) const { return m_motions[id].is_frozen; }
  /// Was the body given up in this tick, as its group would have cost too much? What it has touched in the
  /// tick must be moved otherwise, from where it began. It collides with nothing until set().
  bool isGivenUp(int id) const { return m_motions[id].is_given_up; }
  bool hasGivenUp() const { return m_has_given_up; }
  /// What the last tick has taken.
  double work() const { return m_work; }
  /// Does the body, which can be pushed, touch anything?
  bool isTouching(int id) const { return m_motions[id].first_contact >= 0; }
  /// What moves it at the end of the last step, with what contacts add.
  Vec2 acceleration(int id) const { return m_motions[id].acceleration; }
  /// Ids are below this.
  int idLimit() const { return static_cast<int>(m_bodies.size()); }

  /// For the next step: the world is known `half` to either side of `centre`, and if an impact sends the body
  /// out of that, the step ends there. Everywhere, unless it is set.
  void setReach(int id, const Place& centre, Vec2 half);

  /// Goes on by `dt` > 0 ticks, or until a body would leave its reach. `goes_on`: the rest of a tick, with
  /// what is left of its work.
  ImpactStepStatus step(double dt = 1, bool goes_on = false);
  /// How far the last step went on.
  double stepped() const { return m_stepped; }

  /// Of the last step, by (time, ids).
  const std::vector<ImpactEvent>& events() const { return m_events; }
  const ImpactCounters& counters() const { return m_counters; }

 private:
  struct Motion {
    double time = 0;    // when place and velocity hold, within the tick
    Vec2 acceleration;  // with what contacts add
    unsigned generation = 0;
    int first_contact = -1;
    double work = 0;         // in this tick
    int events_at_once = 0;  // at the moment of the last one
    double last_event = -1;
    int local = -1;  // index in the current group
    bool has_reach = false;
    bool exists = false;
    bool is_frozen = false;
    bool is_given_up = false;  // frozen until it is set
    bool is_dirty = false;     // set() since the last step
    bool is_changed = false;   // in m_changed
    bool is_visited = false;   // by the current settle()
  };
  struct Reach {
    Place centre;
    Vec2 half;
  };
  struct Contact {
    int first = -1;  // −1: free
    int second = -1;
    int next_of_first = -1;  // lists of the bodies that can be pushed; of the free ones: next free
    int next_of_second = -1;
    ImpactAxis axis = ImpactAxis::kNearest;
    bool is_resting = false;
    bool is_tried = false;   // by touchCandidates(): one only if it presses
    bool is_listed = false;  // in m_group_contacts
  };
  /// What a group is solved for: speeds after an impact, accelerations at rest, or places.
  enum class Purpose : std::uint8_t { kImpact, kRest, kPlace };
  enum class Kind : std::uint8_t { kImpact, kStop, kEdge };
  struct Pending {
    double time;
    int first;
    int second;
    unsigned first_generation;
    unsigned second_generation;
    Kind kind;
    ImpactAxis axis;
  };
  struct Candidate {
    int id, other;
  };
  struct PairState {  // of two bodies at a moment
    ImpactTouch touch;
    Vec2 velocity;
    double approach;  // > 0 if they do
    double rest_speed;
  };

  // ImpactWorld.cpp
  bool isPushed(int id) const { return m_bodies[id].inverse_mass > 0; }
  bool isMoving(int id) const {
    return m_bodies[id].velocity != Vec2{} || m_motions[id].acceleration != Vec2{};
  }
  void advance(int id, double time);
  void freeze(int id);
  void giveUp(int id);
  bool isOverdrawn(int id) const { return m_motions[id].work > kWorkOfBody && m_work > m_most_work; }
  double workLeft() const;
  void spend(int id, double work);
  void beginTick(double dt);
  void settleAtStart();
  void placeBoxes();
  void listCandidates();
  bool listCandidates(int id, std::size_t most);
  void forecastAll();
  void forecastChanged(double now);
  void forecastPair(int i, int j, double now);
  RelativeMotion relative(int a, int b, double now) const;
  SweptBox sweptBox(int id, double now) const;
  bool isWithinReach(int id, const SweptBox& box) const;
  bool isStale(const Pending& pending) const;
  void handle(const Pending& pending);
  void compactQueue();
  void sortEvents();
  void markChanged(int id);

  // ImpactContact.cpp
  void collide(int a, int b, ImpactAxis axis, double now);
  void stopSliding(int a, int b);
  void pushPair(int a, int b, const PairState& state);
  double pushGroup(int contact, double now);
  bool touchCandidates();
  void settle(double now);
  void settleGroup(int body, double now);
  void calm(const Contact& contact);
  void gather(int body, double now, bool is_impact, int own_contact);
  bool keepsContact(const Contact& contact, const PairState& state) const;
  bool isSoft(int a, int b, const PairState& state) const;
  PairState pairState(int a, int b, ImpactAxis axis) const;
  void addRows(const Contact& contact, Purpose purpose);
  void solveGroup(Purpose purpose);
  void partGroup(double now);
  int localOf(int id);
  int findContact(int a, int b) const;
  int makeContact(int a, int b, ImpactAxis axis);
  void dropContact(int contact);
  void endContact(int contact, double now);
  void unlink(int body, int contact);

  std::vector<ImpactBody> m_bodies;
  std::vector<Motion> m_motions;
  std::vector<Reach> m_reaches;  // by id; only as many as were set
  std::vector<Contact> m_contacts;
  int m_free_contact = -1;
  std::vector<ImpactEvent> m_events;
  ImpactCounters m_counters;

  double m_dt = 0;
  double m_stepped = 0;
  bool m_is_beyond = false;  // a body's reach
  bool m_has_given_up = false;
  static constexpr double kUnbounded = 1e300;
  double m_reserve = kUnbounded;
  double m_work = 0, m_most_work = 0;           // in this tick
  double m_reserve_left = 0;                    // likewise
  int m_lowest_free = 0;                        // no id below it is free
  std::vector<int> m_ending;                    // contacts, in remove()
  std::vector<Candidate> m_candidates;          // pairs whose boxes overlap when the tick begins
  std::int64_t m_origin_x = 0, m_origin_y = 0;  // of the broad phase
  std::vector<int> m_ids;                       // those that take part
  std::vector<SweptBox> m_boxes;
  ImpactTree m_tree;
  std::vector<Pending> m_queue;
  std::size_t m_compact_at = 4096;
  std::vector<int> m_changed;

  RestSolver m_rest;
  std::vector<int> m_group;           // bodies of the current group
  std::vector<int> m_group_contacts;  // and what holds them together
  std::vector<double> m_group_masses;
};

}  // namespace naiad::physics
