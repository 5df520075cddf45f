// Objects and rigid bodies near soft bodies, as obstacles of a SoftWorld, and the forces on them.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/body/BodyState.h"
#include "physics/body/SoftTable.h"

namespace naiad::physics {

class BodyLayer;

class SoftObstacles {
 public:
  static constexpr int kFirstGrabId = 1 << 30;

  void clear();
  /// Adds all obstacles near this soft body, and the bodies attached to it. `reach` is how far the soft body
  /// can move in this tick.
  void gather(const World& world, const BodyLayer& bodies, SoftTable& table, int id, Vec2 reach);
  /// Returns a checksum of the keys and places of the obstacles that gather() found; 0 if any of them moves.
  std::uint64_t surrounding() const { return m_is_lively ? 0 : m_sum; }
  void addGrab(const SoftTable& table, const SoftEntry& entry, int id);
  std::vector<SoftObstacle>& all();

  /// Call after the step: updates velocities and places of pushed bodies. A body that lies on something rigid
  /// gets the impulse in its own next step, because that step handles its contacts.
  void apply(World& world, BodyLayer& bodies, SoftTable& table, std::vector<MovedObject>& moved);
  /// Returns the key of the obstacle with this id in the step; its generation is 0 if it does not exist.
  ObjectKey keyOf(int obstacle) const;

 private:
  struct Source {
    ObjectKey key;
    int state = -1;  ///< index of the body's state; −1: not a body
    int grab = -1;   ///< id of the soft body that grabs; −1: not a grab
    int shape = -1;
    // Effects of the last tick's impulses that the bodies' own step already contains:
    Vec2 gained;        ///< change of the velocity
    double turned = 0;  ///< change of the spin
  };

  struct Pushed {
    BodyTable::Index index;
    ObjectKey key;
    FixedVector published;  ///< position as sent to clients
    Vec2 impulse;
    double angular_impulse;
    bool is_near;  ///< found by the current gather()
  };

  const Pushed* findPushed(ObjectKey key);
  void removeStaleImpulses(const BodyLayer& bodies, BodyTable& table);
  bool isKnown(int id) const;
  void addObject(const World& world, const BodyTable& table, ObjectKey key);
  void addBody(const World& world, const BodyLayer& bodies, const BodyTable& table, int state);
  bool setShape(const WorldStore& store, const BodyTable& table, const BodyState& state,
                SoftObstacle& obstacle, Source& source);
  void sum(ObjectKey key, FixedVector where, const FixedBox& box);
  void push(World& world, const BodyLayer& bodies, BodyTable& table, const Source& source,
            const SoftObstacle& obstacle, std::vector<MovedObject>& moved);
  void publish(World& world, BodyTable& table, Pushed& pushed, std::vector<MovedObject>& moved);

  std::vector<Source> m_sources;
  std::vector<SoftObstacle> m_obstacles;  // by index in m_sources
  std::vector<ConvexShape> m_shapes;
  std::vector<ObjectKey> m_found;
  std::vector<Pushed> m_pushed;   // bodies pushed in the last step
  std::vector<Pushed> m_pushing;  // bodies pushed in the current step
  std::uint64_t m_sum = 0;
  bool m_is_lively = false;
};

}  // namespace naiad::physics
