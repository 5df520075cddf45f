// Soft bodies in motion: implicit sub-steps, contacts with rigid bodies and with one another, attachments.
//
// Bodies that touch, or that touch the same movable obstacle, form a group, which is solved as one; groups do
// not see each other. Results depend on ids, places relative to one another, and inputs alone.
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

/// Two bodies began to touch in this step, or no longer do.
struct SoftEvent {
  int body;   ///< a soft body's id
  int other;  ///< the obstacle's id, or a soft body's higher than `body`
  bool is_other_soft;
  bool is_begin;
  double impulse;  ///< when it begins: the sum along the normals, in this step
};

/// A node that is held to a point of an obstacle; it pulls at both.
struct SoftAttachment {
  int body = -1;
  int node = 0;
  int obstacle = 0;  ///< id; while no such obstacle is given, nothing is held
  Vec2 anchor;       ///< in the obstacle's axes, from its centre of mass
};

/// What has happened since the world was made.
struct SoftCounters {
  std::int64_t steps = 0;
  std::int64_t iterations = 0;      ///< systems solved
  std::int64_t decompositions = 0;  ///< made for them, of bodies that are not wide
  std::int64_t unconverged = 0;     ///< groups' sub-steps that ended without the accuracy they should have
  std::int64_t limited = 0;  ///< bodies' sub-steps that were slowed, because they would have gained energy
  std::int64_t stopped = 0;  ///< nodes that were held at a surface at last, as no force had done it
  std::int64_t crowded =
      0;  ///< bodies' sub-steps in which some contacts with others were left out (SoftCrowd)
  std::int64_t quarantined = 0;  ///< bodies frozen
};

enum class SoftStatus : std::uint8_t {
  kDone,
  kQuarantined,  ///< done, and at least one body had to be frozen
  kRefused       ///< not a time, or an obstacle that is not sound; nothing happened
};

/// Not thread-safe. No allocation in step() once the scene has shown what it needs.
class SoftWorld {
 public:
  static constexpr int kDefaultSubsteps = 4;  ///< of a tick
  /// A body with a node that would go farther than this within a sub-step is frozen (cells).
  static constexpr double kFarthest = 1e12;

  /// Returns the id, the lowest free one, or −1 if the body is not sound.
  int add(const SoftBody& body);
  /// Replaces a body, and thaws it; its contacts go on. False if there is none, or `body` is not sound; then
  /// nothing changes.
  bool set(int id, const SoftBody& body);
  /// Its contacts end without an event, and so do its attachments.
  bool remove(int id);
  bool exists(int id) const { return id >= 0 && id < idLimit() && m_states[at(id)].exists; }
  /// Offsets are from body(id).place, which follows the body in whole cells.
  const SoftBody& body(int id) const { return m_bodies[at(id)]; }
  /// Is the body in quarantine? It is kept as it is and collides with nothing, until set().
  bool isFrozen(int id) const { return m_states[at(id)].is_frozen; }
  int idLimit() const { return static_cast<int>(m_bodies.size()); }
  /// Leave it out of steps: it stays as it is, collides with nothing, and what it touches counts as touched.
  /// Not kept over set().
  void setOut(int id, bool is_out) { m_states[at(id)].is_out = is_out; }
  /// Did it touch anything in the last step that it took part in?
  bool isTouching(int id) const;
  /// The same of one obstacle.
  bool isTouching(int id, int obstacle) const;

  /// A force that stays until it is set again. False if it is not sound, or there is no such node.
  bool setForce(int id, int node, Vec2 force);
  /// The node stops, and is pinned or free from now on. False if there is no such node.
  bool pin(int id, int node, bool is_pinned);
  /// The same for a blow.
  bool applyImpulse(int id, int node, Vec2 impulse);
  /// Refuses what is not finite or too large.
  bool setGravity(Vec2 gravity);
  /// Of a tick: 1 … 64.
  bool setSubsteps(int substeps);

  /// Returns the attachment's id, or −1.
  int attach(const SoftAttachment& attachment);
  bool detach(int attachment);

  /// Goes on by `dt` > 0 ticks, in sub-steps of at most 1 / substeps tick, at most 64 of them.
  SoftStatus step(double dt = 1, std::span<SoftObstacle> obstacles = {});

  /// Of the last step, by ids.
  const std::vector<SoftEvent>& events() const { return m_events; }
  const SoftCounters& counters() const { return m_counters; }

 private:
  struct State {
    double budget = 0;  // energy that it may have
    bool exists = false;
    bool is_frozen = false;
    bool is_out = false;
    bool is_fresh = true;       // changed from outside: the budget is to be computed again
    bool is_worked_on = false;  // in this sub-step, by what is not the body itself
    int group = -1;
  };
  struct Touch {
    std::uint64_t key;  // body, kind, other
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

  // SoftDetection.cpp
  void updateViews(double h, std::span<SoftObstacle> obstacles);
  void findRows(double h, std::span<SoftObstacle> obstacles);
  void findAttachments(std::span<SoftObstacle> obstacles);

  // SoftGroup.cpp
  void substep(double h, std::span<SoftObstacle> obstacles);
  void findGroups();
  void solveGroups(double h);
  bool solveGroup(double h);
  bool iterate(double h, bool& is_settled);
  void moveObstacles(double h, std::span<SoftObstacle> obstacles);
  void stopNodes(int id, double h, std::span<SoftObstacle> obstacles);
  void stopNode(int id, int node, const SoftPose& pose, double h, SoftObstacle& obstacle);
  bool limitEnergy(int id);
  // SoftWideStep.cpp
  void separateWide();
  void solveWide(const SoftView& view, double h, std::span<SoftObstacle> obstacles);
  bool iterateWide(int id, double h);
  void gatherPushes(const SoftView& view, double h);
  SoftPush pushOf(SoftRow& row, int id, double h) const;
  std::size_t sharedBy(const SoftPoint& point, int which) const;
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
  std::vector<Touch> m_touching;  // in this step
  std::vector<Touch> m_touched;   // in the last one

  // Of the current sub-step.
  std::vector<SoftView> m_views;
  std::vector<Vec2> m_ends;
  std::vector<SoftPose> m_poses;
  std::vector<SoftPatch> m_patches;  // of wide bodies
  std::vector<SoftPatch> m_stop_patches;
  std::vector<SoftObstacleMotion> m_obstacle_motions;
  SoftCrowd m_crowd;
  std::vector<SoftRow> m_rows;
  std::vector<SoftRow> m_earlier;    // of the one before, by key
  std::vector<SoftRow> m_wide_rows;  // of wide bodies, taken out of m_rows
  std::vector<SoftPush> m_pushes;
  std::vector<int> m_sharing;  // pushes on an obstacle or on a node of another body
  UnionFind m_links;           // bodies and obstacles
  std::vector<int> m_group;
  std::vector<SoftRow*> m_group_rows;
  SoftRowSolver m_solver;
};

}  // namespace naiad::physics
