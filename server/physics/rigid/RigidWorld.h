// Bodies that turn: they stack, slide, roll, bounce and hang on joints.
//
// A step is divided into a few sub-steps. What touches what is found once per step and followed in closed
// form through the sub-steps (RigidSolver.h); contacts and joints are solved for together. A body that moves
// farther than its contacts were searched for is swept, from impact to impact (RigidSweep.cpp).
// Groups that have come to rest sleep, exactly still. Results depend on ids, places relative to one another,
// and inputs alone.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "physics/broadphase/BroadPhase.h"
#include "physics/geometry/ConvexShape.h"
#include "physics/geometry/Index.h"
#include "physics/geometry/UnionFind.h"
#include "physics/rigid/MagnetTurn.h"
#include "physics/rigid/RigidContact.h"
#include "physics/rigid/RigidDirect.h"
#include "physics/rigid/RigidJoint.h"
#include "physics/rigid/RigidStepper.h"

namespace naiad::physics {

/// What has happened since the world was made.
struct RigidCounters {
  std::int64_t ticks = 0;
  std::int64_t contacts = 0;         ///< manifolds solved for, once per step each
  std::int64_t sweeps = 0;           ///< pairs whose time of impact was asked for
  std::int64_t impacts = 0;          ///< of fast bodies, handled at their moment
  std::int64_t held = 0;             ///< times that a fast body had to wait for the next sub-step
  std::int64_t unresolved = 0;       ///< times of impact that were not found to the end
  std::int64_t direct_solves = 0;    ///< groups that were solved for at once
  std::int64_t direct_rounds = 0;    ///< factorisations, about, that it took
  std::int64_t direct_failures = 0;  ///< of these solves, those that were given up
  std::int64_t direct_refusals = 0;  ///< groups whose solve might have cost too much: not tried
  std::int64_t quarantined = 0;      ///< bodies frozen
  std::int64_t broken = 0;           ///< joints
};

struct RigidOptions {
  int substeps = 4;  ///< 1 … 64
  bool may_sleep = true;
  double sleep_speed = 3e-4;  ///< cells per tick, of every point of a body: slower counts as still …
  double sleep_delay = 15;  ///< … and ticks that a group must be still, and not speed up, before it sleeps
};

/// Not thread-safe. No allocation in step() once the scene has shown what it needs.
class RigidWorld final : public RigidStepper {
 public:
  explicit RigidWorld(RigidOptions options = {}) : m_options(options) {}

  /// Shapes are relative to the centre of mass; none: a body that touches nothing, for joints. Returns the
  /// id, the lowest free one, or −1 if the body is not sound.
  int add(const RigidBody& body, std::span<const ConvexShape> shapes);
  void expect(std::size_t bodies) override;
  int addInOrder(std::uint64_t /*order*/, const RigidBody& body,
                 std::span<const ConvexShape> shapes) override {
    return add(body, shapes);
  }
  int add(const RigidBody& body, const ConvexShape& shape) { return add(body, std::span(&shape, 1)); }
  /// Replaces a body's state, wakes it and what it lies among, and thaws it. Equal to what there is: nothing
  /// happens. False if there is none, or `body` is not sound; then nothing changes.
  bool set(int id, const RigidBody& body) override;
  bool setShapes(int id, std::span<const ConvexShape> shapes) override;
  /// Its contacts end without an event; joints with it go, too. What it carried wakes.
  bool remove(int id) override;

  const RigidBody& body(int id) const override { return m_bodies[at(id)]; }
  std::span<const ConvexShape> shapes(int id) const { return m_extras[at(id)].shapes; }
  bool exists(int id) const override { return id >= 0 && id < idLimit() && m_extras[at(id)].exists; }
  /// Is the body in quarantine? It is kept as it is and collides with nothing, until set().
  bool isFrozen(int id) const override { return m_extras[at(id)].is_frozen; }
  bool isStopped(int /*id*/) const override { return false; }
  bool isGivenUp(int id) const override { return m_extras[at(id)].is_given_up; }
  bool hasThinned() const override { return m_broad.hasThinned(); }
  bool isAsleep(int id) const { return m_extras[at(id)].is_asleep; }
  /// Wakes it and what sleeps with it.
  void wake(int id);
  int idLimit() const override { return static_cast<int>(m_bodies.size()); }

  void setSleeping(bool may_sleep) override;
  void step() override;

  const RigidCounters& counters() const { return m_counters; }
  const RigidOptions& options() const { return m_options; }

  /// How deep the deepest overlap was at the start of the last step.
  double deepest() const { return m_deepest; }

 private:
  /// What a direct solution of a group may cost, in multiplications per constraint and sub-step: a stack's
  /// band fits, a wide heap's does not.
  static constexpr double kDirectBudget = 5000;
  /// In a body's thickness: how far corners turn before others than those found may touch.
  static constexpr double kMaxRoll = 0.5;
  static constexpr int kPushSweeps = 8;  // that undo overlap in a group with joints; one, without

  struct Extra {
    std::vector<ConvexShape> shapes;
    std::vector<TurnedShape> turned;
    double reach = 0;         // of all shapes from the centre
    double margin = 0;        // how far around it contacts were searched in this step
    double thickness = 0;     // the least half width of any shape
    double moved = 0;         // how far any of its points has got in this step, at most
    double rolled = 0;        // the part of it that is due to turning
    double still = 0;         // ticks
    double first_speed = 0;   // when it began to be still
    std::int32_t proxy = -1;  // in the broad phase
    int ring = -1;            // the next body that fell asleep with it
    bool exists = false;
    bool is_frozen = false;
    bool is_asleep = false;
    bool is_dirty = false;   // set() since the last step
    bool is_active = false;  // in m_active
    bool is_fast = false;
    bool is_in_crowd = false;  // in a group that is large or has joints, in the last step
    bool is_given_up = false;  // in the last step, with its group
    int push_sweeps = 1;       // of its group
    int flight = -1;           // in m_flights: it moves impact by impact in this sub-step
  };
  struct Pair {
    std::int32_t a, b;
    std::int32_t first = -1;  // of its contacts
    std::int32_t event = -1;  // that it began, in this step
    bool is_touching = false;
    bool is_seen = false;     // in this step
    bool is_jointed = false;  // a joint keeps them from touching
    bool is_pushing = false;  // in this step
    bool is_near = false;     // at the end of this step
  };
  struct Late {  // a contact found within the step
    std::int32_t a, b;
    friend constexpr bool operator==(const Late&, const Late&) = default;
  };
  struct Flight {  // of a swept body within a sub-step, which lasts from 0 to 1
    std::int32_t id;
    int impacts = 0;
    double time = 0;
    double part = 1;          // of the rest of the sub-step that it moves
    bool has_landed = false;  // moves on, but is swept no more
    bool is_bending = false;  // to bounce where contacts do not know
    bool is_held = false;
  };
  struct Island {
    int first_body = 0, bodies = 0;  // in m_island_bodies
    int first_constraint = 0, constraints = 0;
    int first_link = 0, links = 0;
    int hard_links = 0;  // of these, what springs and mice are not
    double kick = 0;     // the greatest of its bodies
    double budget = 0;   // for solving at once, in this step
    bool has_fast = false;
    bool rests_anew = false;  // in this sub-step: no impulse of it was known, and nothing in it met fast
  };
  struct Gain {  // the greatest speed in a group, when it began to be still and now
    double before = 0, now = 0;
  };
  struct Impact {
    double time = 2;
    std::int32_t a = -1, b = -1;
    std::int32_t shape_a = 0, shape_b = 0;
    Vec2 normal;
  };

  bool isMovable(int id) const { return physics::isMovable(m_bodies[at(id)]); }
  // The order in which a pair names its bodies, and pairs are solved: what moves, by id, then what does not.
  // An obstacle's id goes with when something first came near it, and that may have been anybody.
  static constexpr std::uint32_t kImmovable = std::uint32_t{1} << 31;
  std::uint32_t rankOf(int id) const {
    return static_cast<std::uint32_t>(id) | (isMovable(id) ? 0 : kImmovable);
  }
  static int idOf(std::uint32_t rank) { return static_cast<int>(rank & ~kImmovable); }
  bool isBefore(int a, int b) const { return rankOf(a) < rankOf(b); }
  bool isMoving(int id) const { return m_bodies[at(id)].velocity != Vec2{} || m_bodies[at(id)].spin != 0; }

  // RigidWorld.cpp
  void measure(int id);
  void enter(int id);
  void leave(int id);
  void freeze(int id);
  void wakeNeighbours(int id);
  void wakeRing(int id) override;
  const JointStore& joints() const override { return m_joints; }
  JointStore& joints() override { return m_joints; }
  Bounds turnShapes(int id, Rotation rotation);

  // RigidStep.cpp
  void stepOnce(double dt);
  void beginStep(double dt);
  void beginBody(int id, double dt);
  void substep(double h);
  void solve(bool is_second);
  void pushOut(double h);
  void kick(bool is_second);
  void turnByMagnets(double h);
  void drift(double h);
  void move(int id, double h);
  void finishStep(double dt);
  bool isFlying(int id) const;
  void dropParted();

  // RigidPairs.cpp
  void updatePairs();
  void dropPair(Pair& pair);
  void forgetPairs(int id);
  void addEvent(RigidEvent event);
  void updateContacts(double dt);
  void updatePair(std::int32_t index, double dt);
  ContactConstraint& addConstraint(int a, int b);
  std::int32_t makeContact();
  void dropContacts(Pair& pair);
  std::int32_t findPair(std::int32_t a, std::int32_t b) const;
  void storeContact(const ContactConstraint& constraint, double h);
  void publishBegin(const ContactConstraint& constraint, double dt);
  void publishEnds(double dt);

  // RigidSweep.cpp
  struct Pose {
    Vec2 displacement;
    Rotation turn;
  };
  void sweep(double h);
  void addFlight(int id, double time);
  Pose poseAt(int id, double time, double h) const;
  void advance(int id, double time, double h);
  void forecast(int id, double h);
  void forecastPair(int a, int b, double h);
  bool isSolved(int a, int b, int shape_a, int shape_b) const;
  void handleImpact(const Impact& impact, double h);
  void land(int id, double h);
  void applyImpact(ContactConstraint& constraint, double restitution, double time);
  void wakeInFlight(int id);
  void hold(int id);

  // RigidSleep.cpp
  void findIslands();
  void gatherIslands();
  int islandOf(int a, int b);

  // RigidIslands.cpp
  void solveIsland(Island& island, bool is_second);
  bool solveAtOnce(Island& island, bool is_second);
  void giveUp(Island& island);
  void sleep(double dt);

  RigidOptions m_options;
  std::vector<RigidBody> m_bodies;
  std::vector<Extra> m_extras;
  std::vector<RigidState> m_states;
  int m_first_free = 0;  // no id below it is free
  BroadPhase m_broad{true};
  std::vector<Pair> m_pairs, m_pairs_before;
  std::vector<RigidContact> m_contacts;
  std::int32_t m_free_contact = -1;
  std::vector<ContactConstraint> m_constraints;
  std::vector<int> m_active;                          // ids of those that move in this step
  std::vector<std::pair<int, MagnetTurn>> m_magnets;  // of those that a magnet turns, in this sub-step
  std::vector<int> m_dirty;                           // ids of immovable ones that were set
  RigidJoints m_joints;
  std::vector<Late> m_late, m_late_before;
  std::vector<Flight> m_flights;
  std::vector<Impact> m_impacts;
  std::vector<int> m_near;
  UnionFind m_sets;              // of bodies
  std::vector<int> m_island_of;  // by root
  std::vector<Island> m_islands;
  std::vector<int> m_island_bodies, m_island_constraints, m_island_links;
  std::size_t m_first_late = 0;  // in m_constraints
  RigidDirect m_direct;
  std::vector<double> m_island_still;
  std::vector<Gain> m_island_gain;
  std::vector<std::uint8_t> m_island_flags;
  RigidCounters m_counters;
  double m_time = 0;    // within the step
  Manifold m_manifold;  // of the pair at hand: one on the stack would be set to zero first
  double m_deepest = 0;
  double m_h = 0;
  bool m_active_changed = false;
  bool m_has_flown = false;  // one was swept in this step
};

}  // namespace naiad::physics
