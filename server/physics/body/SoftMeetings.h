// What soft bodies may run into in a tick, as obstacles of a SoftWorld, and what they do to it in turn.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/world/World.h"
#include "physics/body/SoftTable.h"

namespace naiad::physics {
struct BodyPlan;

/// An Object that is to be put somewhere once all have moved.
struct MovedObject {
  df::ObjectKey key;
  df::FixedVector where;
};
}  // namespace naiad::physics

namespace df {

class BodyLayer;
class WorldStore;

class SoftMeetings {
 public:
  static constexpr int kHands = 1 << 30;

  void begin();
  /// What is near this soft body, and what it holds on to. `reach`: as far as it gets in this tick.
  void gather(const World& world, const BodyLayer& bodies, naiad::physics::SoftTable& table, int id,
              naiad::physics::Vec2 reach);
  /// A sum over what gather() found for it: who, and where. 0 if some of it moves.
  std::uint64_t surrounding() const { return m_is_lively ? 0 : m_sum; }
  void addHand(const naiad::physics::SoftTable& table, const naiad::physics::SoftSeat& seat, int id);
  std::vector<naiad::physics::SoftObstacle>& obstacles();

  /// After the step: velocities and places of the bodies that were pushed. What lies on something else that
  /// is rigid only takes the impulse on into its next step, which knows what it lies on.
  void apply(World& world, BodyLayer& bodies, naiad::physics::SoftTable& table,
             std::vector<naiad::physics::MovedObject>& moved);
  /// The key of what has this id in the step; generation 0 if nobody has.
  ObjectKey keyOf(int obstacle) const;
  /// Can the obstacle of this id move?
  bool isMovable(int obstacle) const;

 private:
  struct Met {
    ObjectKey key;
    int plan = -1;  ///< of the body; −1: no body
    int hand = -1;  ///< of this soft body
    int shape = -1;
    // What the bodies' step has already done to it, as the last tick's impulses.
    naiad::physics::Vec2 gained;  ///< velocity
    double turned = 0;            ///< spin
  };

  struct Pushed {
    naiad::physics::BodyTable::Index index;
    ObjectKey key;
    FixedVector told;  ///< where watchers see it
    naiad::physics::Vec2 impulse;
    double angular_impulse;
    bool is_met;  ///< in the step at hand
  };

  const Pushed* pushedBefore(ObjectKey key);
  void takeBack(const BodyLayer& bodies, naiad::physics::BodyTable& table);
  bool isKnown(int id) const;
  void addObject(const World& world, const naiad::physics::BodyTable& table, ObjectKey key);
  void addBody(const World& world, const BodyLayer& bodies, const naiad::physics::BodyTable& table, int plan);
  bool giveShape(const WorldStore& store, const naiad::physics::BodyTable& table,
                 const naiad::physics::BodyPlan& plan, naiad::physics::SoftObstacle& obstacle, Met& met);
  void sum(ObjectKey key, FixedVector where, const FixedBox& box);
  void push(World& world, const BodyLayer& bodies, naiad::physics::BodyTable& table, const Met& met,
            const naiad::physics::SoftObstacle& obstacle, std::vector<naiad::physics::MovedObject>& moved);
  void tell(World& world, naiad::physics::BodyTable& table, Pushed& pushed,
            std::vector<naiad::physics::MovedObject>& moved);

  std::vector<Met> m_met;
  std::vector<naiad::physics::SoftObstacle> m_obstacles;  // by the same index
  std::vector<naiad::physics::ConvexShape> m_shapes;
  std::vector<ObjectKey> m_found;
  std::vector<Pushed> m_pushed;   // in the last step, by the key's slot
  std::vector<Pushed> m_pushing;  // in this one
  std::uint64_t m_sum = 0;
  bool m_is_lively = false;
};

}  // namespace df
