// Objects and bodies near soft bodies, as obstacles of a SoftWorld, and what the soft bodies do to them in
// turn.
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
  /// Adds what is near this soft body, and what it is attached to. `reach`: as far as it gets in this tick.
  void gather(const World& world, const BodyLayer& bodies, SoftTable& table, int id, Vec2 reach);
  /// A checksum of what gather() found for it: keys and places. 0 if some of it moves.
  std::uint64_t surrounding() const { return m_is_lively ? 0 : m_sum; }
  void addGrab(const SoftTable& table, const SoftEntry& entry, int id);
  std::vector<SoftObstacle>& all();

  /// After the step: velocities and places of the bodies that were pushed. A body that lies on something
  /// else that is rigid takes the impulse into its next step instead, which knows what it lies on.
  void apply(World& world, BodyLayer& bodies, SoftTable& table, std::vector<MovedObject>& moved);
  /// The key of what has this id in the step; generation 0 if none has.
  ObjectKey keyOf(int obstacle) const;

 private:
  struct Source {
    ObjectKey key;
    int state = -1;  ///< of the body; −1: no body
    int grab = -1;   ///< of this soft body
    int shape = -1;
    // What the bodies' step has already done to it, as the last tick's impulses.
    Vec2 gained;        ///< velocity
    double turned = 0;  ///< spin
  };

  struct Pushed {
    BodyTable::Index index;
    ObjectKey key;
    FixedVector published;  ///< its position as clients have it
    Vec2 impulse;
    double angular_impulse;
    bool is_near;  ///< in the current step
  };

  const Pushed* findPushed(ObjectKey key);
  void revertMissing(const BodyLayer& bodies, BodyTable& table);
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
  std::vector<SoftObstacle> m_obstacles;  // by the same index
  std::vector<ConvexShape> m_shapes;
  std::vector<ObjectKey> m_found;
  std::vector<Pushed> m_pushed;   // in the last step, by the key's slot
  std::vector<Pushed> m_pushing;  // in this one
  std::uint64_t m_sum = 0;
  bool m_is_lively = false;
};

}  // namespace naiad::physics
