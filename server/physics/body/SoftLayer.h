// Soft bodies' part of a world's update(): after all bodies have moved, they go on for the same tick.
//
// A world gets this layer with its first soft body, and pays nothing before. What a soft body does to rigid
// ones is applied to them after its step (SoftObstacles.h).
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
  /// The layer of this world; made if there is none, after the one of bodies.
  static SoftLayer& of(World& world);
  /// The grab of a soft body is the obstacle with this id. Others have their Object's slot as id.
  static int grabIdOf(int id) { return SoftObstacles::kFirstGrabId + id; }
  /// Publishes a new soft body: its Object gets position and box.
  static void publishNow(World& world, SoftTable& table, int id);

  void step(World& world) override;
  const std::shared_ptr<SoftTable>& table() { return m_table; }

 private:
  struct Touch {
    ObjectKey first, second;
    // What the solver calls them.
    int body;
    int other;
    bool is_other_soft;
  };

  void prepare(const World& world, int id);
  void push(int id);
  void collectContacts(const WorldStore& store);
  void settle(World& world, int id);
  void freeze(World& world, int id);
  void publish(World& world, int id);
  void logCrowd(World& world);

  BodyLayer& m_bodies;  // lives as long: it is a layer of the same world, and came before
  std::shared_ptr<SoftTable> m_table;
  SoftObstacles m_obstacles;
  std::vector<Touch> m_touching;
  SoftSleep m_sleep;
  Vec2 m_gravity;
  bool m_has_logged_crowd = false;
  // Of this step; kept for their memory.
  std::vector<MovedObject> m_moved;
  std::vector<BodyContact> m_contact_changes;
};

}  // namespace naiad::physics
