// The soft bodies of a world: what the layer knows of each, beside the SoftWorld that moves them.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "physics/body/BodyTable.h"
#include "physics/body/WorldNames.h"
#include "physics/soft/SoftWorld.h"

namespace naiad::physics {

/// The grab constraint: a mass without a shape on a spring to the target, to which the node is attached.
struct SoftGrab {
  int attachment = -1;  ///< −1: nothing is grabbed
  Place place;
  Place target;
  Vec2 velocity;
  double strength = 0;  ///< greatest force
};

/// A node that is held to a body of the same world.
struct SoftAttachedNode {
  int attachment = -1;
  int node = 0;
  ObjectKey key;
};

/// By id in the SoftWorld.
struct SoftEntry {
  ObjectKey key;
  const Object* p_object = nullptr;  ///< null: the entry is free
  SoftBody made;                     ///< as it was built, to come back to after a quarantine
  FixedVector
      published_position;  ///< as the store got it last; if it holds another now, the game moved the body
  FixedVector published_velocity;
  Place centre;  ///< of mass
  Vec2 velocity;
  Vec2 force;                     ///< on the whole, for the next step
  std::vector<Vec2> node_forces;  ///< on single nodes, for the next step; empty if there are none
  double mass = 1;
  double gravity_scale = 1;
  double top_speed = 0;     ///< of its nodes
  bool has_forces = false;  ///< are there external forces on its nodes?
  bool is_in = false;       ///< does it take part?
  bool is_frozen = false;
  bool is_asleep = false;
  bool is_loaded = false;         ///< by what could move
  int still = 0;                  ///< ticks that it hardly moved
  int since_touch = 0;            ///< ticks
  std::uint64_t surrounding = 0;  ///< a sum over what was near when it fell asleep
  SoftGrab grab;
  std::vector<SoftAttachedNode> attached_nodes;
};

/// Counted: by the layer and by each soft Object, which may outlive its world.
class SoftTable {
 public:
  explicit SoftTable(std::shared_ptr<BodyTable> bodies) : m_bodies(std::move(bodies)) {}

  /// −1 if the body is not sound.
  int add(const Object* p_object, ObjectKey key, const SoftBody& body);
  void remove(int id);
  SoftEntry& entry(int id) { return m_entries[static_cast<std::size_t>(id)]; }
  /// Limit of ids; some are free.
  int idLimit() const { return static_cast<int>(m_entries.size()); }
  SoftWorld& world() { return m_world; }
  BodyTable& bodies() { return *m_bodies; }
  const Metric& metric() const { return m_bodies->metric; }

  /// Replaces the body and wakes it. False if it is not sound.
  bool set(int id, const SoftBody& body);
  /// Wakes the body. False if there is no such node.
  bool pin(int id, int node, bool is_pinned);
  /// Centre of mass, its velocity and the fastest node, from the nodes.
  void measure(int id);
  /// As a whole.
  void moveTo(int id, const Place& centre);
  void setVelocity(int id, Vec2 velocity);
  /// What the game has done by the Object's setters: the store holds these now.
  void absorb(int id, FixedVector position, FixedVector velocity);
  void wake(int id) {
    entry(id).is_asleep = false;
    entry(id).still = 0;
  }
  /// As far as it reaches from its centre of mass, each way, its thickness included.
  Vec2 reach(int id) const;

 private:
  void thaw(int id);

  std::shared_ptr<BodyTable> m_bodies;
  SoftWorld m_world;
  std::vector<SoftEntry> m_entries;
};

}  // namespace naiad::physics
