// Simulation of soft bodies: implicit sub-steps, contacts with rigid and soft bodies, attachments.
//
// Bodies that touch each other or a common movable obstacle form a group, which is solved together; groups
// are independent. Results depend only on ids, relative places and inputs.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/geometry/Index.h"
#include "physics/geometry/UnionFind.h"
#include "physics/soft/SoftBody.h"
#include "physics/soft/SoftContact.h"
#include "physics/soft/SoftCrowd.h"
#include "physics/soft/SoftElastic.h"
#include "physics/soft/SoftRows.h"

namespace naiad::physics {

/// The start or end of a contact of two bodies in this step.
struct SoftEvent {
  int body;   ///< a soft body's id
  int other;  ///< id of an obstacle, or of a soft body with a higher id than `body`
  bool is_other_soft;
  bool is_begin;
  double impulse;  ///< sum of the impulses along the normals in this step; 0 for an end
};

/// A node that is attached to a point of an obstacle; each pulls the other.
struct SoftAttachment {
  int body = -1;
  int node = 0;
  int obstacle = 0;  ///< id of the obstacle; the attachment has no effect in steps without this obstacle
  Vec2 anchor;       ///< relative to the obstacle's centre of mass, in its axes
};

/// Counters since the world was made.
struct SoftCounters {
  std::int64_t steps = 0;
  std::int64_t iterations = 0;      ///< linear systems solved
  std::int64_t decompositions = 0;  ///< decompositions for these systems, only for bodies that are not wide
  std::int64_t unconverged = 0;     ///< sub-steps of groups that did not reach the required accuracy
  std::int64_t limited = 0;  ///< sub-steps of bodies that were slowed because they would have gained energy
  std::int64_t stopped = 0;  ///< nodes stopped at a surface because forces had not stopped them
  std::int64_t crowded = 0;  ///< sub-steps of bodies that lost contacts because of crowding (SoftCrowd)
  std::int64_t quarantined = 0;  ///< number of times that a body was frozen
};

enum class SoftStatus : std::uint8_t {
  kDone,
  kQuarantined,  ///< the step is complete, but at least one body had to be frozen
  kRefused       ///< invalid time or obstacle; nothing happened
};

/// Not thread-safe. After a warm-up, step() does not allocate.
class SoftWorld {
 public:
  static constexpr int kDefaultSubsteps = 4;  ///< per tick
  /// A body is frozen if a node would move farther than this within a sub-step, in cells.
  static constexpr double kFarthest = 1e12;

  /// Adds a body. Returns its id, the lowest free one, or −1 if the body is invalid.
  int add(const SoftBody& body);
  /// Replaces and unfreezes a body; its contacts continue. False, without change, for an invalid id or body.
  bool set(int id, const SoftBody& body);
  /// Removes a body and its attachments; its contacts end without events.
  bool remove(int id);
  bool exists(int id) const { return id >= 0 && id < idLimit() && m_states[at(id)].exists; }
  /// Returns the body. Its offsets are relative to body(id).place, which follows the body in whole cells.
  const SoftBody& body(int id) const { return m_bodies[at(id)]; }
  /// True if the body is in quarantine: it does not move and collides with nothing until set().
  bool isFrozen(int id) const { return m_states[at(id)].is_frozen; }
  int idLimit() const { return static_cast<int>(m_bodies.size()); }
  /// Excludes the body from steps: it neither moves nor collides, but its contacts last. set() resets this.
  void setOut(int id, bool is_out) { m_states[at(id)].is_out = is_out; }
  /// True if it touched anything in the last step in which it took part.
  bool isTouching(int id) const;
  /// Like isTouching(id), for one obstacle.
  bool isTouching(int id, int obstacle) const;

  /// Sets a force on a node that acts until it is changed. Returns false if the force or node is invalid.
  bool setForce(int id, int node, Vec2 force);
  /// Stops the node, pins or releases it, and unfreezes the body. Returns false if the node does not exist.
  bool pin(int id, int node, bool is_pinned);
  /// Applies an impulse to a node, which has no effect if it is pinned. False for an invalid impulse or node.
  bool applyImpulse(int id, int node, Vec2 impulse);
  /// Sets the gravity, in cells per tick². Returns false if it is not finite or too large.
  bool setGravity(Vec2 gravity);
  /// Sets the number of sub-steps per tick: 1 … 64.
  bool setSubsteps(int substeps);

  /// Adds an attachment. Returns its id, or −1 if it is invalid.
  int attach(const SoftAttachment& attachment);
  bool detach(int attachment);

  /// Advances by `dt` ticks (> 0, at most 1e6), in sub-steps of at most 1 / substeps tick, or in 64 longer
  /// ones if there would be more.
  SoftStatus step(double dt = 1, std::span<SoftObstacle> obstacles = {});

  /// Returns the events of the last step, sorted by ids.
  const std::vector<SoftEvent>& events() const { return m_events; }
  const SoftCounters& counters() const { return m_counters; }

 private:
  struct State {
    double budget = 0;  // upper limit of the body's energy
    bool exists = false;
    bool is_frozen = false;
    bool is_out = false;
    bool is_fresh = true;       // changed from outside, so that the budget must be computed again
    bool is_worked_on = false;  // true if something outside the body does work on it in this sub-step
    int group = -1;
  };
  struct Touch {
    std::uint64_t key;  // body, kind and id of the other
    double impulse;

    int body() const { return static_cast<int>(key >> 33); }
    int other() const { return static_cast<int>(key & 0xffffffff); }
    bool isSoft() const { return (key >> 32 & 1) != 0; }
    bool isOf(int id) const { return body() == id || (isSoft() && other() == id); }
    SoftEvent event(bool is_begin) const {
      return {body(), other(), isSoft(), is_begin, is_begin ? impulse : 0};
    }
  };

  bool isLive(int id) const {
    const State& state = m_states[at(id)];
    return state.exists && !state.is_frozen && !state.is_out;
  }
  bool isOut(const Touch& touch) const;
  bool isWide(int id) const { return m_elastics[at(id)].isWide(); }
  void freeze(int id);
  void recentre(int id);
  void start(int id);

  // Defined in SoftDetection.cpp:
  void updateViews(double h, std::span<SoftObstacle> obstacles);
  void findRows(double h, std::span<SoftObstacle> obstacles);
  void findAttachments(std::span<SoftObstacle> obstacles);

  // Defined in SoftGroup.cpp:
  void substep(double h, std::span<SoftObstacle> obstacles);
  void findGroups();
  void solveGroups(double h);
  bool solveGroup(double h);
  bool iterate(double h, bool& is_settled);
  void moveObstacles(double h, std::span<SoftObstacle> obstacles);
  void stopNodes(int id, double h, std::span<SoftObstacle> obstacles);
  void stopNode(int id, int node, const SoftPose& pose, double h, SoftObstacle& obstacle);
  bool limitEnergy(int id);
  // Defined in SoftWideStep.cpp:
  void separateWide();
  void solveWide(const SoftView& view, double h, std::span<SoftObstacle> obstacles);
  bool iterateWide(int id, double h);
  void gatherPushes(const SoftView& view, double h);
  SoftPush pushOf(SoftRow& row, int id, double h) const;
  std::size_t sharedBy(const SoftPoint& point, int which) const;
  /// Returns how far the other side of a push yields, per unit of force.
  double yieldOf(const SoftPush& push, double h) const;
  void pushOthers(const SoftPush& push, double h);
  void stopWide(int id, double h, std::span<SoftObstacle> obstacles);

  void recordRow(const SoftRow& row, double h, std::span<SoftObstacle> obstacles);
  void publish();

  std::vector<SoftBody> m_bodies;
  std::vector<SoftElastic> m_elastics;
  std::vector<State> m_states;
  std::vector<SoftAttachment> m_attachments;
  Vec2 m_gravity;
  int m_substeps = kDefaultSubsteps;
  bool m_has_frozen = false;
  SoftCounters m_counters;
  std::vector<SoftEvent> m_events;
  std::vector<Touch> m_touching;  // contacts in this step
  std::vector<Touch> m_touched;   // contacts in the last step

  // State of the current sub-step.
  std::vector<SoftView> m_views;
  std::vector<Vec2> m_ends;
  std::vector<SoftPose> m_poses;
  std::vector<SoftPatch> m_patches;  // patches of wide bodies
  std::vector<SoftPatch> m_stop_patches;
  std::vector<SoftObstacleMotion> m_obstacle_motions;
  SoftCrowd m_crowd;
  std::vector<SoftRow> m_rows;
  std::vector<SoftRow> m_earlier;    // rows of the previous sub-step, by key
  std::vector<SoftRow> m_wide_rows;  // rows of wide bodies, moved from m_rows
  std::vector<SoftPush> m_pushes;
  std::vector<int> m_sharing;  // by obstacle or node of another body: number of pushes that act on it
  UnionFind m_links;           // groups of bodies and obstacles
  std::vector<int> m_group;
  std::vector<SoftRow*> m_group_rows;
  SoftRowSolver m_solver;
};

}  // namespace naiad::physics
