// Soft bodies' part of a world's update(): after all bodies have moved, they go on for the same tick.
//
// A world gets this layer with its first soft body, and pays nothing before. What a soft body does to rigid
// ones is applied to them after its step (SoftMeetings.h).
#pragma once

#include <memory>
#include <vector>

#include "engine/world/Layer.h"
#include "engine/world/World.h"
#include "physics/body/BodyPlan.h"
#include "physics/body/SoftMeetings.h"
#include "physics/body/SoftTable.h"
#include "physics/body/SoftTouches.h"

namespace df {

class BodyLayer;

class SoftLayer : public Layer {
 public:
  SoftLayer(BodyLayer& bodies, std::shared_ptr<naiad::physics::BodyTable> table)
      : m_bodies(bodies), m_table(std::make_shared<naiad::physics::SoftTable>(std::move(table))) {}
  /// The layer of this world; made if there is none, after the one of bodies.
  static SoftLayer& of(World& world);
  /// What drags the nodes of a soft body is this obstacle to it. Others have their Object's slot as id.
  static int handOf(int id) { return SoftMeetings::kHands + id; }
  /// A new soft body: its Object gets position and box.
  static void tellAtOnce(World& world, naiad::physics::SoftTable& table, int id);

  void step(World& world) override;
  const std::shared_ptr<naiad::physics::SoftTable>& table() { return m_table; }

 private:
  void prepare(const World& world, int id);
  void push(int id);
  void wakeByOthers();
  void settle(World& world, int id);
  void freeze(World& world, int id);
  void tell(World& world, int id);
  void rest();
  bool mayRest(int id) const;
  bool areNear(int a, int b);
  void findLoads();
  void tellOfCrowd(World& world);

  BodyLayer& m_bodies;  // lives as long: it is a layer of the same world, and came before
  std::shared_ptr<naiad::physics::SoftTable> m_table;
  SoftMeetings m_meetings;
  SoftTouches m_touches;
  naiad::physics::Vec2 m_gravity;
  bool m_has_told_of_crowd = false;
  // Of this step; kept for their memory.
  std::vector<naiad::physics::MovedObject> m_moved;
  std::vector<naiad::physics::BodyContact> m_news;
  std::vector<naiad::physics::Vec2> m_reaches;  // by id
  std::vector<char> m_rests;                    // likewise
};

}  // namespace df
