// Simulation of rotating bodies that stack, slide, roll, bounce and hang on joints.
//
// A step is divided into a few sub-steps. Contacts are found once per step and followed in closed form
// through the sub-steps (RigidSolver.h); contacts and joints are solved together. A body that moves farther
// than the distance to which contacts were searched is swept from impact to impact (RigidSweep.cpp). Groups
// at rest sleep, with velocity zero. Results depend only on ids, relative places and inputs.
#pragma once

#include <array>
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
#include "physics/rigid/RigidLinkage.h"
#include "physics/rigid/RigidStepper.h"

namespace naiad::physics {

/// Counters since the world was made.
struct RigidCounters {
  std::int64_t ticks = 0;
  std::int64_t contacts = 0;         ///< manifolds solved; each counts once per step
  std::int64_t sweeps = 0;           ///< pairs tested for a time of impact
  std::int64_t impacts = 0;          ///< impacts of fast bodies
  std::int64_t held = 0;             ///< times that a fast body had to wait for the next sub-step
  std::int64_t unresolved = 0;       ///< times of impact for which the iteration limit was reached
  std::int64_t direct_solves = 0;    ///< groups solved by RigidDirect
  std::int64_t direct_rounds = 0;    ///< approximate number of factorisations in all direct solutions
  std::int64_t direct_failures = 0;  ///< direct solutions that failed
  std::int64_t direct_refusals = 0;  ///< groups not solved directly because it might cost too much
  std::int64_t restarts = 0;         ///< halves of a sub-step of a group solved again, as it gained energy
  std::int64_t scalings = 0;         ///< restarts after which the impulses were reduced
  std::int64_t late_scalings = 0;    ///< contacts found within the step whose impulses were reduced
  std::int64_t quarantined = 0;      ///< number of times that a body was frozen
  std::int64_t broken = 0;           ///< joints that broke
};

/// A direction along which an impact acts: a normal or a tangent of a contact point.
struct ImpactRow {
  Vec2 n;
  double lever_a = 0, lever_b = 0;
  double speed = 0, impulse = 0;
  std::array<double, 4> gain = {};  ///< change of the speed along each row by a unit impulse along this one
  std::vector<BodyChange> changes;  ///< changes by a unit impulse
};

struct RigidOptions {
  int substeps = 4;  ///< 1 … 64
  bool may_sleep = true;
  double sleep_speed = 3e-4;  ///< cells per tick: maximum speed of every point of a still body
  double sleep_delay = 15;    ///< ticks that a group must be still, without becoming faster, before it sleeps
};

/// Not thread-safe. After a warm-up, step() does not allocate.
class RigidWorld final : public RigidStepper {
 public:
  explicit RigidWorld(RigidOptions options = {}) : m_options(options) {}

  /// Adds a body. Shapes are relative to the centre of mass; a body without shapes touches nothing and is
  /// only for joints. Returns the lowest free id, or −1 if the body is invalid.
  int add(const RigidBody& body, std::span<const ConvexShape> shapes) { return addInOrder(0, body, shapes); }
  void expect(std::size_t bodies) override;
  int addInOrder(std::uint64_t order, const RigidBody& body, std::span<const ConvexShape> shapes) override;
  int add(const RigidBody& body, const ConvexShape& shape) { return add(body, std::span(&shape, 1)); }
  bool set(int id, const RigidBody& body) override;
  bool setShapes(int id, std::span<const ConvexShape> shapes) override;
  bool remove(int id) override;

  const RigidBody& body(int id) const override { return m_bodies[at(id)]; }
  std::span<const ConvexShape> shapes(int id) const { return m_extras[at(id)].shapes; }
  bool exists(int id) const override { return id >= 0 && id < idLimit() && m_extras[at(id)].exists; }
  bool isFrozen(int id) const override { return m_extras[at(id)].is_frozen; }
  bool isPushed(int id) const override { return m_extras[at(id)].is_pushed || m_extras[at(id)].is_asleep; }
  bool isStopped(int /*id*/) const override { return false; }
  bool isGivenUp(int id) const override { return m_extras[at(id)].is_given_up; }
  bool hasThinned() const override { return m_broad.hasThinned(); }
  bool isAsleep(int id) const { return m_extras[at(id)].is_asleep; }
  /// Wakes the body and the bodies that fell asleep with it. Its group starts without memory (forget()).
  void wake(int id);
  int idLimit() const override { return static_cast<int>(m_bodies.size()); }

  void setSleeping(bool may_sleep) override;
  void step() override;

  const RigidCounters& counters() const { return m_counters; }
  const LinkageCounters& linkageCounters() const { return m_linkage_counters; }
  const RigidOptions& options() const { return m_options; }

  /// Returns the depth of the deepest overlap at the start of the last step.
  double deepest() const { return m_deepest; }

 private:
  /// Limit of the cost of a group's direct solution, in multiplications per constraint and sub-step. It is
  /// enough for the narrow matrix of a stack, but not for the wide one of a heap.
  static constexpr double kDirectBudget = 5000;
  /// Part of a body's thickness by which corners may move by rotation before other corners may touch.
  static constexpr double kMaxRoll = 0.5;
  static constexpr int kPushSweeps = 8;  // sweeps that undo overlap in a group with joints; others need one

  struct Extra {
    std::uint64_t order = 0;  // decides the order of bodies, because ids depend on which are free
    std::vector<ConvexShape> shapes;
    std::vector<RotatedShape> turned;
    double reach = 0;         // maximum distance of a point of its shapes from the centre
    double margin = 0;        // distance to which contacts are searched in this step
    double thickness = 0;     // smallest half width of a shape
    double moved = 0;         // upper bound of the movement of any of its points in this step up to now
    double rolled = 0;        // part of `moved` due to rotation
    double still = 0;         // number of ticks for which it has been still
    double first_speed = 0;   // speed when it became still
    std::int32_t proxy = -1;  // index in the broad phase
    int ring = -1;            // next body that fell asleep with it
    bool exists = false;
    bool is_frozen = false;
    bool is_asleep = false;
    bool is_pushed = false;  // a contact pushed or stopped it in the last step
    bool is_dirty = false;   // set() was called since the last step
    bool is_active = false;  // listed in m_active
    bool is_fast = false;
    bool is_touched = false;    // a contact has pushed it in this step
    bool is_in_group = false;   // true if its group, when last listed, had more than three bodies
    bool is_in_crowd = false;   // true if its group, when last listed, was large or had rigid joints
    bool is_on_joints = false;  // true if its group, when last listed, had rigid joints
    bool is_given_up = false;   // true if the last step abandoned its group
    int push_sweeps = 1;        // number of sweeps that undo overlap in its group
    int flight = -1;            // index in m_flights if it moves from impact to impact in this sub-step
  };
  struct Pair {
    std::int32_t a, b;
    std::int32_t first = -1;  // index of the pair's first contact
    std::int32_t event = -1;  // index of its begin event in this step
    bool is_touching = false;
    bool is_seen = false;     // examined in this step
    bool is_jointed = false;  // a joint prevents contacts of the two bodies
    bool is_pushing = false;  // true if a contact has pushed in this step
    bool is_near = false;     // true if the bodies are near each other at the end of this step
  };
  struct Late {  // a contact found within the step
    std::int32_t a, b;
    friend constexpr bool operator==(const Late&, const Late&) = default;
  };
  struct Flight {  // a swept body within a sub-step; time is 0 at its start and 1 at its end
    std::int32_t id;
    int impacts = 0;
    double time = 0;
    double last = 0;          // time of the last impact of its linkage
    double part = 1;          // part of the remaining sub-step by which it moves
    Vec2 bend;                // as in bendOf()
    double spin_bend = 0;     // like `bend`, of the spin
    bool has_landed = false;  // true if it moves on without being swept
    bool is_held = false;
  };
  struct Island {
    int first_body = 0, bodies = 0;  // part of m_island_bodies
    int first_constraint = 0, constraints = 0;
    int first_link = 0, links = 0;
    int hard_links = 0;  // number of links other than springs and mice
    int linkage = -1;    // index of its linkage, if that is pure
    double kick = 0;     // maximum speed of RigidState::kick of its bodies
    double budget = 0;   // multiplications that a direct solution may need in this step
    double spare = 0;    // energy that the first half of the sub-step removed and the second may return
    bool has_fast = false;
    bool may_fly = true;      // true if its linkages may be swept
    bool rests_anew = false;  // true if it is at rest in this sub-step, but has no known impulses
    bool is_elastic =
        true;  // true if no contact loses energy, so that it must be moved from impact to impact
  };
  struct Gain {  // maximum speeds in a group: when it became still, and now
    double before = 0, now = 0;
  };
  struct Work {         // effect of the impulses of this half on the bodies of a group
    double along = 0;   // Σ mass · velocity before · change
    double square = 0;  // Σ mass · change²; the kinetic energy grows by along + square / 2
    double before = 0;  // twice the kinetic energy before
    double pull = 0;    // Σ mass · kick · change
  };
  struct Impact {
    double time = 2;
    std::int32_t a = -1, b = -1;
    std::int32_t shape_a = 0, shape_b = 0;
    Vec2 normal;
  };

  bool isMovable(int id) const { return physics::isMovable(m_bodies[at(id)]); }
  // Order of the bodies in a pair, of pairs and of bodies in a group: movable bodies in the order of
  // addition, then immovable ones. Ids must not decide it, because they depend on other groups.
  bool isBefore(int a, int b) const {
    if (isMovable(a) != isMovable(b)) return isMovable(a);
    const std::uint64_t first = m_extras[at(a)].order, second = m_extras[at(b)].order;
    return first != second ? first < second : a < b;
  }
  void sortByOrder(std::vector<int>& ids) const;
  bool isMoving(int id) const { return m_bodies[at(id)].velocity != Vec2{} || m_bodies[at(id)].spin != 0; }

  // Defined in RigidWorld.cpp:
  void measure(int id);
  void enter(int id);
  void leave(int id);
  void freeze(int id);
  void wakeNeighbours(int id);
  void wakeRing(int id) override;
  const JointStore& joints() const override { return m_joints; }
  JointStore& joints() override { return m_joints; }
  Bounds turnShapes(int id, Rotation rotation);

  // Defined in RigidStep.cpp:
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
  bool mayMeet(const ContactConstraint& constraint, double h) const;
  void finishStep(double dt);
  bool isFlying(int id) const;
  void dropParted();

  // Defined in RigidPairs.cpp:
  void updatePairs();
  void dropPair(Pair& pair);
  void keepTouching(int id);
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

  // Defined in RigidSweep.cpp:
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
  Vec2 bendOf(int id) const;
  bool haveLanded(int a, int b) const;
  const RigidContact* contactOf(const Pair& pair, int shape_a, int shape_b) const;
  void handleImpact(const Impact& impact, double h);
  void land(int id, double h);
  void applyImpact(ContactConstraint& constraint, double time);
  double spinBendOf(int id) const;
  bool rub(ContactConstraint& constraint, double rest_speed, double rest_after);
  void wakeInFlight(int id);
  void hold(int id);

  // Defined in RigidLinkageImpacts.cpp:
  void gatherMet(int a, int b, double time, double h);
  void findResponse(const ContactConstraint& constraint, ImpactRow& row);
  void applyJoinedImpact(ContactConstraint& constraint, double time, double h);
  // Returns the index of the linkage of a movable body if it may be swept; −1: none.
  int flyingLinkageOf(int id) const {
    const int index = at(id) < m_linkage_of.size() ? m_linkage_of[at(id)] : -1;
    return index >= 0 && m_linkages[at(index)].mayFly() ? index : -1;
  }

  // Defined in RigidSleep.cpp:
  void findIslands();
  void gatherIslands();
  int islandOf(int a, int b);
  void findLinkages();
  void beginLinkages();
  void aimLinkages(double h);
  void fitLinkages();
  void dampLinkages();
  void moveLinkages();
  void findPushedLinkages();
  template <class Visit>
  void visitLinkages(Visit visit) const {
    for (const RigidLinkage& linkage : m_linkages) {
      if (linkage.isAlone() && m_extras[at(linkage.someBody())].is_active) linkage.visitLinks(visit);
    }
  }

  // Defined in RigidIslands.cpp:
  void solveIsland(Island& island, bool is_second);
  bool solveAtOnce(Island& island, bool is_second);
  void sweepIsland(const Island& island, bool is_second, int sweeps);
  void guardEnergy(Island& island, bool is_second);
  Work workOf(const Island& island) const;
  static void addWork(const RigidState& state, Work& work);
  void solveLate(ContactConstraint& constraint, bool is_second);
  double inputOf(const Island& island, bool is_second);
  void restart(const Island& island, bool is_second, double part);
  double partOfGuess(const Island& island, bool is_second);
  void scaleImpulses(const Island& island, double part);
  std::span<const int> bodiesOf(const Island& island) const {
    return std::span(m_island_bodies).subspan(at(island.first_body), at(island.bodies));
  }
  std::span<const int> constraintsOf(const Island& island) const {
    return std::span(m_island_constraints).subspan(at(island.first_constraint), at(island.constraints));
  }
  std::span<const int> linksOf(const Island& island) const {
    return std::span(m_island_links).subspan(at(island.first_link), at(island.links));
  }
  void giveUp(Island& island);
  void sleep(double dt);

  RigidOptions m_options;
  std::vector<RigidBody> m_bodies;
  std::vector<Extra> m_extras;
  std::vector<RigidState> m_states;
  int m_first_free = 0;  // all lower ids are in use
  BroadPhase m_broad{true};
  std::vector<Pair> m_pairs, m_pairs_before;
  std::vector<RigidContact> m_contacts;
  std::int32_t m_free_contact = -1;
  std::vector<ContactConstraint> m_constraints;
  std::vector<int> m_active;                          // ids of bodies that move in this step
  std::vector<std::pair<int, MagnetTurn>> m_magnets;  // bodies turned by a magnet in this sub-step
  std::vector<int> m_dirty;                           // ids of immovable bodies that were set
  RigidJoints m_joints;
  std::vector<RigidLinkage> m_linkages;
  std::vector<int> m_linkage_of;                // by id of a movable body: index in m_linkages; −1: none
  std::vector<std::uint8_t> m_pushed_linkages;  // by index: a contact pushes it in this half of the sub-step
  std::array<ImpactRow, 4> m_impact_rows;
  std::vector<int> m_met;              // movable bodies whose paths the last impact has changed
  std::vector<Vec2> m_met_velocities;  // their velocities after the impact
  std::uint64_t m_joint_changes = 0;   // m_joints.changes() when m_linkages was made
  bool m_linkages_changed = false;     // true if bodies have changed so that m_linkages may be others
  LinkageCounters m_linkage_counters;
  std::vector<Late> m_late, m_late_before;
  std::vector<Flight> m_flights;
  std::vector<Impact> m_impacts;
  std::vector<int> m_near;
  UnionFind m_sets;              // sets of bodies
  std::vector<int> m_island_of;  // by root of m_sets: index of the island; in sleep(), the first body
  std::vector<Island> m_islands;
  std::vector<int> m_island_bodies, m_island_constraints, m_island_links;
  std::size_t m_first_late = 0;  // index in m_constraints of the first one found within the step
  RigidDirect m_direct;
  std::vector<double> m_island_still;
  std::vector<Gain> m_island_gain;
  std::vector<std::uint8_t> m_island_flags;
  RigidCounters m_counters;
  double m_time = 0;    // time within the step
  Manifold m_manifold;  // of the current pair; a member, because a local one would be set to zero first
  double m_deepest = 0;
  double m_h = 0;
  bool m_active_changed = false;
  bool m_has_flown = false;  // true if a body was swept in this step
};

}  // namespace naiad::physics
