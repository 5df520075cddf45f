// The soft bodies of a world: the data that the SoftLayer needs in addition to the SoftWorld that moves them.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "physics/body/BodyTable.h"
#include "physics/body/WorldNames.h"
#include "physics/soft/SoftWorld.h"

namespace naiad::physics {

/// A grab: a mass without shape on a spring to the target. The grabbed node is attached to this mass.
struct SoftGrab {
  int attachment = -1;  ///< −1: nothing is grabbed
  Place place;
  Place target;
  Vec2 velocity;
  double strength = 0;  ///< maximum force
};

/// A node attached to a body of the same world.
struct SoftAttachedNode {
  int attachment = -1;
  int node = 0;
  ObjectKey key;
};

/// Data of a soft body, by its id in the SoftWorld.
struct SoftEntry {
  ObjectKey key;
  const Object* p_object = nullptr;  ///< null: the entry is free
  SoftBody made;                     ///< the body as built, restored after a quarantine
  FixedVector published_position;    ///< last position given to the store; if the store has another one, the
                                     ///< game moved the body
  FixedVector published_velocity;
  Place centre;  ///< centre of mass
  Vec2 velocity;
  Vec2 force;                     ///< force on the whole body in the next step
  std::vector<Vec2> node_forces;  ///< forces on single nodes in the next step; may be empty
  double mass = 1;
  double gravity_scale = 1;
  double top_speed = 0;     ///< speed of the fastest free node
  bool has_forces = false;  ///< true if external forces act on its nodes
  bool is_in = false;       ///< true if it takes part in this tick
  bool is_frozen = false;
  bool is_asleep = false;
  bool is_loaded = false;         ///< true if something movable presses on it
  int still = 0;                  ///< number of ticks with hardly any motion
  int since_touch = 0;            ///< ticks since the last contact
  std::uint64_t surrounding = 0;  ///< SoftObstacles::surrounding() in the last tick
  SoftGrab grab;
  std::vector<SoftAttachedNode> attached_nodes;
};

/// The layer and each SoftBody share the ownership, because an Object may outlive its world.
class SoftTable {
 public:
  explicit SoftTable(std::shared_ptr<BodyTable> bodies) : m_bodies(std::move(bodies)) {}

  /// Adds a soft body and returns its id; −1 if the body is invalid.
  int add(const Object* p_object, ObjectKey key, const SoftBody& body);
  void remove(int id);
  SoftEntry& entry(int id) { return m_entries[static_cast<std::size_t>(id)]; }
  /// Returns a number larger than all ids. Some smaller ids may be unused.
  int idLimit() const { return static_cast<int>(m_entries.size()); }
  SoftWorld& world() { return m_world; }
  BodyTable& bodies() { return *m_bodies; }
  const Metric& metric() const { return m_bodies->metric; }

  /// Replaces the body and wakes it. Returns false if the new one is invalid.
  bool set(int id, const SoftBody& body);
  /// Pins or releases a node, and wakes the body. Returns false if the node does not exist.
  bool pin(int id, int node, bool is_pinned);
  /// Computes the centre of mass, its velocity and the top speed from the nodes.
  void measure(int id);
  /// Moves the whole body so that its centre of mass is at `centre`.
  void moveTo(int id, const Place& centre);
  void setVelocity(int id, Vec2 velocity);
  /// Reads changes that the game made by the Object's setters. The arguments are the store's present values.
  void syncFromStore(int id, FixedVector position, FixedVector velocity);
  void wake(int id) {
    entry(id).is_asleep = false;
    entry(id).still = 0;
  }
  /// Returns the half size of the body around its centre of mass, including the thickness of its nodes.
  Vec2 reach(int id) const;

 private:
  void thaw(int id);

  std::shared_ptr<BodyTable> m_bodies;
  SoftWorld m_world;
  std::vector<SoftEntry> m_entries;
};

}  // namespace naiad::physics
