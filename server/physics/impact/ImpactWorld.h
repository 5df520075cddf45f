// Event-driven simulation of bodies that do not rotate: handles every impact at its exact moment.
//
// Between events each body flies in closed form (FlightFree.h). A queue returns the next event of all pairs.
// After an event, only the pairs of the changed bodies are examined again. Bodies that rest on others get the
// accelerations that keep them there (ImpactRest.h), and then fly like all others until something changes.
// Results depend only on ids, relative places and inputs.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/broadphase/ImpactTree.h"
#include "physics/impact/ImpactBody.h"
#include "physics/impact/ImpactRest.h"
#include "physics/impact/ImpactTime.h"

namespace naiad::physics {

/// The start or end of a contact. A bounce has both.
struct ImpactEvent {
  double time;  ///< time since the start of the tick
  int first;    ///< the lower id
  int second;
  bool is_begin;
  double impulse;  ///< impulse on `second` along the normal; 0 if the contact ends
  Vec2 normal;     ///< direction from `first` to `second`
  int order = 0;   ///< index in events()
};

/// Counters since the world was made.
struct ImpactCounters {
  std::int64_t ticks = 0;
  std::int64_t impacts = 0;
  std::int64_t forecasts = 0;    ///< number of pairs for which the next contact was computed
  std::int64_t overlaps = 0;     ///< examined pairs that overlapped too deeply to be separated
  std::int64_t rest_solves = 0;  ///< solutions for groups of resting bodies
  std::int64_t unconverged = 0;  ///< solutions for groups of resting bodies that are only approximate
  std::int64_t quarantined = 0;  ///< number of times that a body was frozen
  std::int64_t given_up = 0;     ///< bodies abandoned because their tick would have cost too much
};

enum class ImpactStepStatus : std::uint8_t {
  kDone,
  kQuarantined,  ///< the step is complete, but at least one body had to be frozen
  kRefused       ///< `dt` is invalid; nothing happened
};

/// Not thread-safe. After a warm-up, step() does not allocate.
class ImpactWorld {
 public:
  /// Work budget of a tick in multiplications (about a nanosecond each), shared by all bodies.
  static constexpr double kWorkOfTick = 1e6;
  /// Additional budget for each body; it is also the body's own share.
  static constexpr double kWorkOfBody = 5e3;
  /// Additional budget for each event, until the reserve of setReserve() is empty. It covers an impact of two
  /// bodies, but not the solution of a large resting group. If the whole budget is used up, a body that has
  /// used its own share is abandoned for this tick.
  static constexpr double kWorkOfEvent = 1e3;
  static constexpr double kUsualReserve = 20'000 * kWorkOfEvent;
  /// Sets the reserve, which limits the work per tick; unlimited by default.
  void setReserve(double work) { m_reserve = work; }
  /// A bounce that would not rise higher than this (in cells) ends at rest, to avoid infinitely many bounces.
  /// It is far below the world's unit of 2^-32 cell.
  static constexpr double kRestHeight = 1e-11;
  /// Limit of impacts of one body at one moment; after it, the next inelastic impact ends at rest.
  static constexpr int kMaxAtOnce = 32;

  /// Two movable bodies that overlap by more than this (in cells) ignore each other until they are apart. (If
  /// one is immovable, the other may leave it but gets no deeper.)
  static constexpr double kDeepest = 1e-6;

  /// Adds a body. Returns its id, the lowest free one, or −1 if the body is invalid.
  int add(const ImpactBody& body);
  /// Replaces a body and unfreezes it. Changes nothing and returns false if the id or `body` is invalid.
  bool set(int id, const ImpactBody& body);
  /// Removes a body; its contacts end without events.
  bool remove(int id);

  const ImpactBody& body(int id) const { return m_bodies[id]; }
  bool exists(int id) const {
    return id >= 0 && id < static_cast<int>(m_bodies.size()) && m_motions[id].exists;
  }
  /// True if the body is in quarantine or abandoned: it does not move and collides with nothing until set().
  bool isFrozen(int id) const { return m_motions[id].is_frozen; }
  /// True if the body was abandoned because it or its group would have cost too much in a tick. Another
  /// solver must move it and all that it touched, from the tick's beginning.
  bool isGivenUp(int id) const { return m_motions[id].is_given_up; }
  bool hasGivenUp() const { return m_has_given_up; }
  /// Returns the work of the last tick, in multiplications.
  double work() const { return m_work; }
  /// True if the movable body touches anything.
  bool isTouching(int id) const { return m_motions[id].first_contact >= 0; }
  /// Returns the acceleration at the end of the last step, including that by contacts.
  Vec2 acceleration(int id) const { return m_motions[id].acceleration; }
  /// Returns a number that is larger than all ids.
  int idLimit() const { return static_cast<int>(m_bodies.size()); }

  /// Sets the area that the caller has searched for obstacles for the next step: `half` to each side of
  /// `centre`. If an impact sends the body out of this area, the step ends there. Unlimited if not set.
  void setReach(int id, const Place& centre, Vec2 half);

  /// Advances by `dt` > 0 ticks, or until a body would leave its reach. `goes_on` is true for the rest of a
  /// tick; it uses the remaining budget.
  ImpactStepStatus step(double dt = 1, bool goes_on = false);
  /// Returns the time by which the last step advanced.
  double stepped() const { return m_stepped; }

  /// Returns the events of the last step, sorted by (time, ids).
  const std::vector<ImpactEvent>& events() const { return m_events; }
  const ImpactCounters& counters() const { return m_counters; }

 private:
  struct Motion {
    double time = 0;    // time within the tick at which place and velocity are valid
    Vec2 acceleration;  // includes that by contacts
    unsigned generation = 0;
    int first_contact = -1;
    double work = 0;         // multiplications in this tick
    int events_at_once = 0;  // number of events at the time last_event
    double last_event = -1;
    int local = -1;  // index in the current group
    bool has_reach = false;
    bool exists = false;
    bool is_frozen = false;
    bool is_given_up = false;  // true if abandoned; it is frozen, too, until set()
    bool is_dirty = false;     // set() was called since the last step
    bool is_changed = false;   // listed in m_changed
    bool is_visited = false;   // visited by the current settle()
  };
  struct Reach {
    Place centre;
    Vec2 half;
  };
  struct Contact {
    int first = -1;  // −1: the entry is free
    int second = -1;
    int next_of_first = -1;  // next contact in the list of `first`; for free entries: next free entry
    int next_of_second = -1;
    ImpactAxis axis = ImpactAxis::kNearest;
    bool is_resting = false;
    bool is_tried = false;   // true if touchCandidates() tries it: it becomes a contact only if it presses
    bool is_listed = false;  // listed in m_group_contacts
  };
  /// The unknowns of a group: speeds after an impact, accelerations at rest, or places.
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
  struct PairState {  // the state of two bodies at a moment
    ImpactTouch touch;
    Vec2 velocity;
    double approach;  // speed at which they approach; negative if they separate
    double rest_speed;
  };

  // Defined in ImpactWorld.cpp:
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

  // Defined in ImpactContact.cpp:
  void collide(int a, int b, ImpactAxis axis, double now);
  void stopSliding(int a, int b);
  void pushPair(int a, int b, const PairState& state);
  double pushGroupOf(int contact, double now);
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
  std::vector<Reach> m_reaches;  // by id; only as long as needed
  std::vector<Contact> m_contacts;
  int m_free_contact = -1;
  std::vector<ImpactEvent> m_events;
  ImpactCounters m_counters;

  double m_dt = 0;
  double m_stepped = 0;
  bool m_is_beyond = false;  // true if a body left its reach
  bool m_has_given_up = false;
  static constexpr double kUnbounded = 1e300;
  double m_reserve = kUnbounded;
  double m_work = 0, m_most_work = 0;           // done and allowed in this tick
  double m_reserve_left = 0;                    // rest of the reserve in this tick
  int m_lowest_free = 0;                        // all lower ids are in use
  std::vector<int> m_ending;                    // scratch memory of remove()
  std::vector<Candidate> m_candidates;          // pairs with overlapping boxes at the beginning of the tick
  std::int64_t m_origin_x = 0, m_origin_y = 0;  // origin of the broad phase
  std::vector<int> m_ids;                       // ids of the bodies in this tick
  std::vector<SweptBox> m_boxes;
  ImpactTree m_tree;
  std::vector<Pending> m_queue;
  std::size_t m_compact_at = 4096;
  std::vector<int> m_changed;

  RestSolver m_rest;
  std::vector<int> m_group;           // bodies of the current group
  std::vector<int> m_group_contacts;  // contacts within the current group
  std::vector<double> m_group_masses;
};

}  // namespace naiad::physics
