// The soft bodies' part of a world's update(): moves them by a tick after all rigid bodies.
//
// A world gets this layer with its first soft body; before that, it costs nothing. The effect of soft bodies
// on rigid ones is applied after the step (SoftObstacles.h).
#pragma once

#include <memory>
#include <vector>

#include "engine/world/Layer.h"
#include "engine/world/World.h"
#include "physics/body/BodyState.h"
#include "physics/body/SoftObstacles.h"
#include "physics/body/SoftSleep.h"
#include "physics/body/SoftTable.h"

namespace naiad::physics {

class BodyLayer;

class SoftLayer : public df::Layer {
 public:
  SoftLayer(BodyLayer& bodies, std::shared_ptr<BodyTable> table)
      : m_bodies(bodies), m_table(std::make_shared<SoftTable>(std::move(table))) {}
  /// Returns the layer of this world; creates it, after the layer of bodies, if needed.
  static SoftLayer& of(World& world);
  /// Returns the obstacle id of a soft body's grab. Other obstacles have their Object's slot as id.
  static int grabIdOf(int id) { return SoftObstacles::kFirstGrabId + id; }
  /// Publishes a new soft body: sets position and box of its Object.
  static void publishNow(World& world, SoftTable& table, int id);

  void step(World& world) override;
  const std::shared_ptr<SoftTable>& table() { return m_table; }

 private:
  struct Touch {
    BodyContact contact;
    // Ids in the SoftWorld:
    int body;
    int other;
    bool is_other_soft;
  };

  void prepare(const World& world, int id);
  void setForces(int id);
  void collectContacts(const WorldStore& store);
  template <class IsOver>
  void endContacts(IsOver isOver);
  void send(World& world);
  void endMarked(World& world);
  void settle(World& world, int id);
  void freeze(World& world, int id);
  void publish(World& world, int id);
  void logCrowd(World& world);

  BodyLayer& m_bodies;  // a layer that the same world made earlier, so it outlives this one
  std::shared_ptr<SoftTable> m_table;
  SoftObstacles m_obstacles;
  std::vector<Touch> m_touching;
  SoftSleep m_sleep;
  Vec2 m_gravity;
  bool m_has_logged_crowd = false;
  // Scratch memory of a step.
  std::vector<MovedObject> m_moved;
  std::vector<BodyContact> m_contact_changes;
};

}  // namespace naiad::physics
