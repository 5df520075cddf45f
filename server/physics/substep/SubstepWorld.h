// Simulation of bodies that stack, slide, roll and hang on joints; fast rather than exact.
//
// Contacts are found at the beginning of a step and solved in soft sub-steps (ContactRows.h,
// SubstepJoints.h). The order of solution depends only on the bodies' own order, so groups that do not touch
// do not influence each other. A tick is one step, or several. A body that moves farther than contacts were
// searched for stops at its first contact until the next step. Groups at rest sleep, with velocity zero.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "physics/broadphase/BroadPhase.h"
#include "physics/broadphase/ImpactTree.h"
#include "physics/geometry/Index.h"
#include "physics/geometry/TimeOfImpact.h"
#include "physics/geometry/UnionFind.h"
#include "physics/rigid/MagnetTurn.h"
#include "physics/rigid/RigidStepper.h"
#include "physics/substep/ContactRows.h"
#include "physics/substep/SubstepBody.h"
#include "physics/substep/SubstepEnergy.h"
#include "physics/substep/SubstepForms.h"
#include "physics/substep/SubstepJoints.h"

namespace naiad::physics {

struct SubstepOptions {
  int searches = 1;  ///< steps per tick, each with a search for contacts, 1 … 64
  int substeps = 4;  ///< sub-steps per step, 1 … 64
  bool may_sleep = true;
  double sleep_speed = 1e-3;  ///< cells per tick: maximum speed of every point of a still body
  double sleep_delay = 15;    ///< ticks that a group must be still, without becoming faster, before it sleeps
};

/// Counters since the world was made.
struct SubstepCounters {
  std::int64_t ticks = 0;
  std::int64_t contacts = 0;     ///< manifolds solved; each counts once per step
  std::int64_t blocks = 0;       ///< blocks of rows solved in parallel
  std::int64_t sweeps = 0;       ///< sweeps over separated pairs, to find which may touch (passStirsOn())
  std::int64_t near = 0;         ///< bodies that a fast one might touch
  std::int64_t stopped = 0;      ///< fast bodies stopped or diverted at their first contact
  std::int64_t quarantined = 0;  ///< number of times that a body was frozen
  std::int64_t broken = 0;       ///< joints that broke
  std::int64_t scaled = 0;       ///< groups whose impulses were scaled because they added energy
  std::int64_t sunk = 0;         ///< contacts in which a load sank too deep, counted once per step
};

class SubstepWorld final : public RigidStepper {
 public:
  explicit SubstepWorld(SubstepOptions options = {})
      : m_options(options), m_states(1), m_dt(1.0 / options.searches) {}

  void expect(std::size_t bodies) override;
  /// Adds a body. Bodies with a lower `order` always come first.
  int addInOrder(std::uint64_t order, const RigidBody& body, std::span<const ConvexShape> shapes) override;
  bool set(int id, const RigidBody& body) override;
  bool setShapes(int id, std::span<const ConvexShape> shapes) override;
  bool remove(int id) override;
  const RigidBody& body(int id) const override { return m_bodies[at(id)].body; }
  bool exists(int id) const override { return id >= 0 && id < idLimit() && m_bodies[at(id)].exists; }
  bool isFrozen(int id) const override { return m_bodies[at(id)].is_frozen; }
  bool isPushed(int id) const override {
    const SubstepBody& b = m_bodies[at(id)];
    return b.is_asleep || (b.pushed_at >= 0 && b.pushed_at > m_steps - m_options.searches);
  }
  bool isStopped(int id) const override { return m_bodies[at(id)].state > 0 && m_bodies[at(id)].is_stopped; }
  bool isGivenUp(int /*id*/) const override { return false; }
  bool hasThinned() const override { return m_broad.hasThinned(); }
  bool isAsleep(int id) const { return m_bodies[at(id)].is_asleep; }
  int idLimit() const override { return static_cast<int>(m_bodies.size()); }

  void setSleeping(bool may_sleep) override;
  void step() override;
  const SubstepCounters& counters() const { return m_counters; }
  /// Returns the depth of the deepest overlap at the start of the last step.
  double deepest() const { return m_deepest; }

 private:
  // A contact, kept from step to step. The data for its rows comes first, in as few cache lines as possible.
  struct alignas(64) Memory {
    Manifold manifold;
    KnownImpulses known;  // impulses of its points
    // Positions and gaps when the manifold was found. It is reused while its bodies hardly move relatively.
    Vec2 offset;
    Rotation rotation_a, rotation_b;
    std::array<double, 2> gap = {};
    double margin = -1;  // < 0: no manifold has been found
    std::uint32_t version_a = 0, version_b = 0;
    std::int32_t next = -1;
    std::int32_t shape_a = 0, shape_b = 0;
  };
  static_assert(sizeof(Memory) == 256);
  struct Pair {
    std::int32_t low, high;  // ids, in the order of the broad phase
    std::int32_t a, b;       // these two ids, in the order of the bodies
    std::int32_t first = -1;
    bool is_touching = false;
    bool is_pushing = false;   // true if it pushed in the last step
    bool is_jointed = false;   // a joint prevents contacts of the two bodies
    bool is_seen = false;      // examined in this step
    std::int32_t event = -1;   // index of its event in this tick
    bool is_examined = false;  // true if the bodies may touch in this step
  };
  struct Calm {     // a near pair that does not touch unless something pushes it
    double nearer;  // negative of the gap that remains if nothing pushes the pair
    std::int32_t pair;
  };
  struct Fast {  // a body that moves farther in this step than the distance to which contacts were searched
    Vec2 path;
    double roll, thickness;
    std::int32_t id;
    GridBounds way;          // bounds of its path in this step
    std::int32_t near = -1;  // index in m_near of the first of its possible obstacles; −1: none
    bool is_stopped = false;
    std::int32_t carrier = -1;  // kinematic body that carries it; −1: none
    double reached = 2;         // time at which a fast kinematic body reaches it; 2: never
  };
  struct Near {
    std::int32_t id, next;
  };
  static constexpr std::int32_t kSlowNumber = -1;
  static constexpr float kInCrowd = 1;  // value in m_path_values for a body in a crowd

  struct Turn {  // place of a contact in the order of solution
    std::uint64_t order_a, order_b;
    std::int32_t contact;
  };
  struct Contact {  // a contact within a step
    std::int32_t pair, memory;
    std::int32_t a, b;
    std::int32_t state;  // state of one of its movable bodies
    std::int32_t colour;
    std::int32_t place;      // number of its row in m_rows
    std::int32_t load = -1;  // number in m_joints, if they may solve it
    ContactPush pushed;
  };
  // Some groups whose rows together fit into a cache during all sub-steps.
  struct Batch {
    std::size_t contacts = 0;  // number of its contacts in m_by_colour, after those of the previous batch
    std::size_t states = 0;    // number of its states in m_by_batch, after those of the previous batch
    std::size_t blocks = 0;    // number of blocks of its rows
  };

  struct Magnet {  // a body turned by a magnet, within a step
    std::int32_t id;
    MagnetTurn turn;  // its push in this sub-step
    Vec2 given;       // velocity that the magnet has added since the step began
  };
  struct Group {
    double still = 1e300;
    double speed_before = 0, speed = 0;
    std::int32_t first = -1;
    bool is_held = false, is_driven = false, is_adrift = false;
    bool is_diverted = false;  // it does not fall as a group without contacts
    Vec2 missing;              // momentum lost by rounding in this step
    Vec2 missing_path;         // mass times the path by which it deviates from a parabola
    double mass = 0;           // total mass of the bodies that lost it
    std::int32_t members = 0;
    std::int32_t free = -1;  // index in m_free_groups
  };
  struct Free;
  struct Sums {  // over the bodies of a group, relative to its origin and velocity
    double mass = 0, angular = 0, inertia = 0, twice_energy = 0;
    Vec2 path, momentum;
    void add(const RigidBody& body, const Free& group);
    double angularAboutMiddle() const { return angular - cross(path, momentum) / mass; }
    double inertiaAboutMiddle() const { return inertia - lengthSquared(path) / mass; }
    double twiceEnergyAboutMiddle() const { return twice_energy - lengthSquared(momentum) / mass; }
  };
  struct Free {    // a group that nothing holds
    Place origin;  // place of its first body before the step
    Vec2 velocity, acceleration, jerk;
    bool is_kept = true;  // only its bodies' torques change its angular momentum
    double torque = 0;
    Sums before = {}, after = {};
  };

  static constexpr double kFarthest = 1e9;  // metric cells: maximum path in a step, limit of timeOfImpact()

  // Contacts whose relative movement is slower may be lasting; in thicknesses of a body per tick.
  static constexpr double kCalm = 0.05;

  // Defined in SubstepWorld.cpp:
  void measure(SubstepBody& body);
  void turnShapes(SubstepBody& body);
  RotatedView turnedShape(const SubstepBody& body, std::int32_t number) const;
  void boundNow(SubstepBody& body);
  void enter(int id);
  void leave(int id);
  void freeze(int id);
  void wakeRing(int id) override;
  const JointStore& joints() const override { return m_joints; }
  JointStore& joints() override { return m_joints; }
  void markChanged(int id);

  // Defined in SubstepStep.cpp:
  void stepOnce();
  void listActive();
  void sortActive(std::size_t first = 0);
  void begin(int id);
  void pushByMagnets();
  void undoMagnetWork();
  void beginEnergy();
  void stepBatch(std::span<const std::int32_t> states);
  void kick(std::span<const std::int32_t> states, float part);
  void balance(double time, bool is_end = false);
  void bounce(double time);
  void moveStates(std::span<const std::int32_t> states);
  void keepMomentum();
  void listFree();
  void keepAngularMomentum();
  void finish();
  void forecast(SubstepBody& body) const;
  static double calmMargin(const SubstepBody& a, const SubstepBody& b);
  GridBounds wideBounds(const SubstepBody& body) const;
  Vec2 movedBy(const SubstepBody& body) const;

  // Defined in SubstepFast.cpp:
  bool isFast(const SubstepBody& body) const;
  void addFast(std::int32_t id);
  void stopFast();
  void wakeAhead();
  void addDriven();
  void treePaths();
  Vec2 middlePath();
  SweptBox seenPath(const Fast& fast) const;
  static GridBounds sweptBounds(const Place& from, double reach, Vec2 path);
  float crowdValue(const SubstepBody& body) const;
  template <typename Visit>
  void visitPathsBeside(int own, Visit&& visit) const;
  bool passes(const SubstepBody& a, const SubstepBody& b) const;
  void addNear(Fast& fast, std::int32_t id);
  void approach(int one, int other);
  void approachAgain(Fast& fast);
  RigidMotion wholeMotion(const SubstepBody& body) const;
  RigidMotion motionOf(const SubstepBody& body) const;
  bool isClear(const SubstepBody& body, std::span<const ConvexShape> shapes, const RigidMotion& motion,
               double time, Vec2 moved, std::int32_t except);
  void stop(Fast& fast);
  void stopJoined();
  std::int32_t carrierOf(const Fast& fast) const;
  static bool makeCore(const SubstepBody& body, ConvexShape& core);
  bool carry(Fast& fast, std::int32_t carrier, double time);
  void divert(Fast& fast, Vec2 path);
  bool advanceTogether(Fast& one, Fast& other, double time);

  // Defined in SubstepContacts.cpp:
  void updatePairs();
  void endPair(Pair& pair);
  void wakeChanged();
  void updateContacts();
  void wakeInStep(std::int32_t id);
  bool wakeTouched(std::size_t first_contact);
  void listPairsOf(std::span<const std::int32_t> bodies);
  bool mayMeet(Pair& pair);
  double gapOf(SubstepBody& a, SubstepBody& b, Vec2 offset);
  void stir(const SubstepBody& body, double by);
  void choosePairs();
  void choosePairsOfWoken(std::size_t first_state);
  void passStirsOn();
  bool isReached(const Calm& calm) const;
  double deviationOf(const SubstepBody& b) { return m_deviations[at(m_sets.rootOf(b.state))]; }
  double marginOf(const SubstepBody& a, const SubstepBody& b) const;
  void updatePair(std::int32_t pair);
  static void shake(SubstepBody& a, SubstepBody& b, double depth);
  static KnownImpulses carriedOver(const Memory& memory, const Manifold& now);
  static bool keepsManifold(Memory& memory, const SubstepBody& a, const SubstepBody& b, Vec2 offset,
                            double margin);
  bool findManifold(std::int32_t& memory, SubstepBody& a, SubstepBody& b, std::int32_t shape_a,
                    std::int32_t shape_b, Vec2 offset);
  void sequence(bool is_sorted);
  std::int32_t makeMemory();
  void freeMemory(std::int32_t memory);
  void dropMemory(Pair& pair);
  std::vector<Pair>::const_iterator findPair(std::int32_t one, std::int32_t other) const;

  // Defined in SubstepRows.cpp:
  void chooseColours();
  void chooseBatches();
  void sortByBatch();
  const Contact* contactAhead(std::span<const std::int32_t> contacts, std::size_t turn) const;
  void giveLoads();
  void addRow(Contact& contact);
  void fillRows(std::span<const std::int32_t> contacts);
  void storeImpulses(std::span<const std::int32_t> contacts);
  void reportContacts();

  // Defined in SubstepSleep.cpp:
  void findGroups();
  Group& groupOf(const SubstepBody& b) { return m_groups[at(m_sets.rootOf(b.state))]; }
  void unite(const SubstepBody& a, const SubstepBody& b);
  void sleep();

  SubstepOptions m_options;
  std::vector<SubstepBody> m_bodies;
  SubstepForms m_forms;
  std::vector<std::int32_t> m_free;
  std::vector<std::int32_t> m_active;   // ids of bodies that move in this step, by order
  std::vector<std::int32_t> m_drivers;  // the kinematic ones of these
  std::vector<std::int32_t> m_changed;
  std::vector<std::int32_t> m_slowed;
  std::vector<Free> m_free_groups;
  std::vector<std::pair<std::int32_t, std::int32_t>> m_free_members;  // id and index in m_free_groups
  std::vector<Near> m_near;
  std::vector<Fast> m_fast;
  std::vector<std::int32_t> m_fast_numbers;  // by id: index in m_fast
  std::vector<std::int32_t> m_slow;          // the bodies that are not fast, if there are many fast ones
  // Paths of the fast bodies, then of the slow ones, in grid units relative to the first one, in a frame that
  // moves with m_along.
  std::vector<SweptBox> m_paths;
  Vec2 m_along;  // median movement of the fast bodies in this step
  std::vector<double> m_path_order;
  std::vector<float> m_path_values;  // by path: kInCrowd or 0
  bool m_are_many = false;           // true if m_paths includes the slow bodies
  bool m_are_crowded = false;        // true if some of the fast bodies are in a crowd
  std::vector<int> m_path_ids;
  ImpactTree m_path_tree;
  std::vector<SubstepKick> m_kicks;  // kick of each state
  std::vector<Magnet> m_magnets;
  std::vector<double> m_turns;  // by state: rotation in rad since the step began
  std::vector<Calm> m_calm;
  std::vector<double> m_deviations;    // by state: how far it may deviate from its undisturbed path
  std::vector<SubstepState> m_states;  // the first one stands for all bodies that do not move
  BroadPhase m_broad{true};
  std::vector<Pair> m_pairs, m_pairs_before;
  std::vector<std::int32_t> m_pair_ends,
      m_pair_numbers;  // by id: the pairs of each body; empty if they are not listed in this step
  std::vector<std::int32_t> m_woken_pairs;
  std::vector<Memory> m_memory;
  std::int32_t m_free_memory = -1;
  std::vector<Contact> m_contacts;
  std::vector<Turn> m_sequence;
  std::vector<std::int32_t> m_by_colour;  // contacts by batch and colour
  std::vector<Batch> m_batches;
  std::vector<std::int32_t> m_batch_of;    // index of the batch, by state
  std::vector<std::int32_t> m_by_batch;    // states by batch
  std::vector<std::size_t> m_turn_counts;  // by batch and colour: numbers of contacts
  ContactRows m_rows;                      // rows of the present batch
  SubstepJoints m_joints;
  SubstepEnergy m_energy;
  UnionFind m_sets;        // sets of states
  UnionFind m_batch_sets;  // sets of states that are in one batch, if there are m_driven
  std::vector<std::pair<std::int32_t, std::int32_t>> m_driven;  // states that touch, one of them kinematic
  std::vector<Group> m_groups;                                  // by root of m_sets
  SubstepCounters m_counters;
  double m_deepest = 0;
  double m_dt;        // length of a step in ticks
  double m_time = 0;  // start of this step within the tick, in ticks
  float m_h = 0.25f;
  std::int64_t m_steps = 0;
  bool m_active_changed = false;
  bool m_has_stirred = false;
  bool m_is_shuffled = false;  // true if the ids of movable or of immovable bodies are not in their order
};

}  // namespace naiad::physics
