// Bodies that stack, slide, roll and hang on joints, fast rather than exact.
//
// What touches what is found at the beginning of a step, and solved for in soft sub-steps (ContactRows.h,
// SubstepJoints.h), in an order that follows from the bodies' own order alone: groups that do not touch do
// not see each other. A tick is one step, or several. A body that moves farther than its contacts were
// searched for stops where it first touches something, until the next step. Groups at rest sleep, exactly
// still.
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
#include "physics/substep/SubstepForms.h"
#include "physics/substep/SubstepJoints.h"

namespace naiad::physics {

struct SubstepOptions {
  int searches = 1;  ///< times a tick that contacts are found, 1 … 64 …
  int substeps = 4;  ///< … and sub-steps from one to the next, 1 … 64
  bool may_sleep = true;
  double sleep_speed = 1e-3;  ///< cells per tick, of every point of a body: slower counts as still …
  double sleep_delay = 15;  ///< … and ticks that a group must be still, and not speed up, before it sleeps
};

/// What has happened since the world was made.
struct SubstepCounters {
  std::int64_t ticks = 0;
  std::int64_t contacts = 0;     ///< manifolds solved for, once per step each
  std::int64_t blocks = 0;       ///< of rows that were solved side by side
  std::int64_t sweeps = 0;       ///< over pairs that fly past each other (choosePairs())
  std::int64_t near = 0;         ///< bodies that fast ones might have met, and were swept against
  std::int64_t stopped = 0;      ///< fast bodies, where they first touched something
  std::int64_t quarantined = 0;  ///< bodies frozen
  std::int64_t broken = 0;       ///< joints
};

class SubstepWorld final : public RigidStepper {
 public:
  explicit SubstepWorld(SubstepOptions options = {})
      : m_options(options), m_states(1), m_dt(1.0 / options.searches) {}

  void expect(std::size_t bodies) override;
  /// Of two bodies the one of the lower order comes first in everything.
  int addInOrder(std::uint64_t order, const RigidBody& body, std::span<const ConvexShape> shapes) override;
  bool set(int id, const RigidBody& body) override;
  bool setShapes(int id, std::span<const ConvexShape> shapes) override;
  bool remove(int id) override;
  const RigidBody& body(int id) const override { return m_bodies[at(id)].body; }
  bool exists(int id) const override { return id >= 0 && id < idLimit() && m_bodies[at(id)].exists; }
  bool isFrozen(int id) const override { return m_bodies[at(id)].is_frozen; }
  bool isStopped(int id) const override { return m_bodies[at(id)].state > 0 && m_bodies[at(id)].is_stopped; }
  bool isGivenUp(int /*id*/) const override { return false; }
  bool hasThinned() const override { return m_broad.hasThinned(); }
  bool isAsleep(int id) const { return m_bodies[at(id)].is_asleep; }
  int idLimit() const override { return static_cast<int>(m_bodies.size()); }

  void setSleeping(bool may_sleep) override;
  void step() override;
  const SubstepCounters& counters() const { return m_counters; }
  /// How deep the deepest overlap was at the start of the last step.
  double deepest() const { return m_deepest; }

 private:
  // Of a contact, from step to step. What its rows are made of comes first, in as few cache lines as can be.
  struct alignas(64) Memory {
    Manifold manifold;
    KnownImpulses known;  // of its points
    // When the manifold was found. It is kept while its bodies hardly move against each other.
    Vec2 offset;
    Rotation rotation_a, rotation_b;
    std::array<double, 2> gap = {};
    double margin = -1;  // below 0: none has been found
    std::uint32_t version_a = 0, version_b = 0;
    std::int32_t next = -1;
    std::int32_t shape_a = 0, shape_b = 0;
  };
  static_assert(sizeof(Memory) == 256);
  struct Pair {
    std::int32_t low, high;  // ids: what the broad phase orders by
    std::int32_t a, b;       // the same, by the order of the bodies
    std::int32_t first = -1;
    bool is_touching = false;
    bool is_pushing = false;   // in the last step
    bool is_jointed = false;   // a joint keeps them from touching
    bool is_seen = false;      // in this step
    std::int32_t event = -1;   // of this tick
    bool is_examined = false;  // in this step: they may meet
  };
  struct Calm {     // a pair that is near, but does not meet if nothing pushes it
    double nearer;  // the gap that is left between them then, negative
    std::int32_t pair;
  };
  struct Fast {  // a body that goes farther in this step than contacts were searched for
    Vec2 path;
    double roll, thickness;
    std::int32_t id;
    GridBounds way;          // what it sweeps
    std::int32_t near = -1;  // what may be in its way: the first of its list in m_near
    bool is_stopped = false;
  };
  struct Near {
    std::int32_t id, next;
  };
  static constexpr std::int32_t kSlowNumber = -1;
  static constexpr float kInCrowd = 1;  // value of a path
  struct Slow {
    GridBounds bounds;  // in the broad phase
    std::int32_t id;
  };
  struct Turn {  // in the order in which contacts are solved for
    std::uint64_t order_a, order_b;
    std::int32_t contact;
  };
  struct Contact {  // within a step
    std::int32_t pair, memory;
    std::int32_t a, b;
    std::int32_t state;  // of one of them that has one
    std::int32_t colour;
    std::int32_t place;  // in the rows
    ContactPush pushed;
  };
  // Groups, together small enough that their rows stay in a cache for all sub-steps.
  struct Batch {
    std::size_t contacts = 0;  // of those in m_by_colour …
    std::size_t states = 0;    // … and m_by_batch, that come after those of the batch before
    std::size_t blocks = 0;    // of its rows
  };

  struct Magnet {  // a body that one turns, within a step
    std::int32_t id;
    MagnetTurn turn;  // in this sub-step
    Vec2 given;       // to its velocity, since the step began
  };
  struct Group {
    double still = 1e300;
    double speed_before = 0, speed = 0;
    std::int32_t first = -1;
    bool is_held = false, is_driven = false, is_adrift = false;
    Vec2 missing;     // momentum that rounding has taken in this step
    double mass = 0;  // of those that it was taken from
  };

  // Thicknesses per tick: what moves by less against each other may lie for long.
  static constexpr double kCalm = 0.05;

  // SubstepWorld.cpp
  void measure(SubstepBody& body);
  void turnShapes(SubstepBody& body);
  TurnedView turnedShape(const SubstepBody& body, std::int32_t number) const;
  void boundNow(SubstepBody& body);
  void enter(int id);
  void leave(int id);
  void freeze(int id);
  void wakeRing(int id) override;
  const JointStore& joints() const override { return m_joints; }
  JointStore& joints() override { return m_joints; }
  void markChanged(int id);

  // SubstepStep.cpp
  void stepOnce();
  void listActive();
  void sortActive();
  void begin(int id);
  void pushByMagnets();
  void undoMagnetWork();
  void stepBatch(std::span<const std::int32_t> states);
  void moveStates(std::span<const std::int32_t> states);
  void keepMomentum();
  void finish();
  bool isFast(const SubstepBody& body) const;
  void stopFast();
  void treePaths();
  Vec2 middlePath();
  SweptBox seenPath(const Fast& fast) const;
  static GridBounds sweptBounds(const SubstepBody& body, Vec2 path);
  float crowdValue(const SubstepBody& body) const;
  template <typename Visit>
  void visitPathsBeside(int own, Visit&& visit) const;
  bool passes(const SubstepBody& a, const SubstepBody& b) const;
  void addNear(Fast& fast, std::int32_t id);
  void approach(int one, int other);
  void approachAgain(Fast& fast);
  RigidMotion motionOf(const SubstepBody& body) const;
  bool isClear(const SubstepBody& body, Vec2 path);
  void stop(Fast& fast);
  bool goOnTogether(Fast& one, Fast& other, double time);
  void forecast(SubstepBody& body) const;
  static double calmMargin(const SubstepBody& a, const SubstepBody& b);
  GridBounds wideBounds(const SubstepBody& body) const;
  Vec2 movedBy(const SubstepBody& body) const;

  // SubstepContacts.cpp
  void updatePairs();
  void endPair(Pair& pair);
  void wakeChanged();
  void updateContacts();
  bool wakeTouched(std::size_t first_contact);
  void listPairsOf(std::span<const std::int32_t> bodies);
  bool mayMeet(Pair& pair);
  double gapOf(SubstepBody& a, SubstepBody& b, Vec2 offset);
  void stir(const SubstepBody& body, double by);
  void choosePairs();
  void choosePairsOfWoken(std::size_t first_state);
  void passStirsOn();
  bool isReached(const Calm& calm) const;
  double stirOf(const SubstepBody& b) { return m_stirs[at(m_sets.rootOf(b.state))]; }
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

  // SubstepRows.cpp
  void chooseColours();
  void chooseBatches();
  void sortByBatch();
  const Contact* contactAhead(std::span<const std::int32_t> contacts, std::size_t turn) const;
  void addRow(Contact& contact);
  void fillRows(std::span<const std::int32_t> contacts);
  void storeImpulses(std::span<const std::int32_t> contacts);
  void reportContacts();

  // SubstepSleep.cpp
  void findGroups();
  Group& groupOf(const SubstepBody& b) { return m_groups[at(m_sets.rootOf(b.state))]; }
  void unite(const SubstepBody& a, const SubstepBody& b);
  void sleep();

  SubstepOptions m_options;
  std::vector<SubstepBody> m_bodies;
  SubstepForms m_forms;
  std::vector<std::int32_t> m_free;
  std::vector<std::int32_t> m_active;  // ids of those that move in this step, by order
  std::vector<std::int32_t> m_changed;
  std::vector<Near> m_near;
  std::vector<Fast> m_fast;
  std::vector<std::int32_t> m_fast_numbers;  // by id: which of these
  std::vector<Slow> m_slow;                  // the others, if the fast ones are many
  // Of those, then of these: in grid units about the first of them, as seen by one who flies along.
  std::vector<SweptBox> m_paths;
  Vec2 m_along;  // how that one flies
  std::vector<double> m_path_order;
  std::vector<float> m_path_values;  // of each, kInCrowd or 0
  bool m_are_many = false;           // the slow ones are among these
  bool m_are_crowded = false;        // some of the fast ones are of a crowd
  std::vector<int> m_path_ids;
  ImpactTree m_path_tree;
  std::vector<SubstepKick> m_kicks;  // by state
  std::vector<Magnet> m_magnets;
  std::vector<double> m_turns;  // likewise: rad, since the step began
  std::vector<Calm> m_calm;
  std::vector<double> m_stirs;         // by state: how far off its own path a body may come in this step
  std::vector<SubstepState> m_states;  // the first one is of all that does not move
  BroadPhase m_broad{true};
  std::vector<Pair> m_pairs, m_pairs_before;
  std::vector<std::int32_t> m_pair_ends,
      m_pair_numbers;  // of each body, by id; empty: not listed in this step
  std::vector<std::int32_t> m_woken_pairs;
  std::vector<Memory> m_memory;
  std::int32_t m_free_memory = -1;
  std::vector<Contact> m_contacts;
  std::vector<Turn> m_sequence;
  std::vector<std::int32_t> m_by_colour;  // contacts, by batch and colour
  std::vector<Batch> m_batches;
  std::vector<std::int32_t> m_batch_of;    // by state
  std::vector<std::int32_t> m_by_batch;    // states
  std::vector<std::size_t> m_turn_counts;  // by batch and colour
  ContactRows m_rows;                      // of a batch
  SubstepJoints m_joints;
  UnionFind m_sets;             // of states
  std::vector<Group> m_groups;  // by root
  SubstepCounters m_counters;
  double m_deepest = 0;
  double m_dt;        // how long a step is
  double m_time = 0;  // in this tick, when this step began
  float m_h = 0.25f;
  std::int64_t m_steps = 0;
  bool m_active_changed = false;
  bool m_has_stirred = false;
  bool m_is_shuffled = false;  // ids are not in the order of the bodies, or of what they lie on
};

}  // namespace naiad::physics
