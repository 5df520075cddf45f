// The bodies of an ImpactWorld, and what stands in their way.
#pragma once

#include <vector>

#include "engine/world/World.h"
#include "physics/body/BodyContacts.h"
#include "physics/body/BodyObstacles.h"
#include "physics/body/BodyPlan.h"
#include "physics/impact/ImpactWorld.h"

namespace df {

class BodyImpacts {
 public:
  using Index = naiad::physics::BodyTable::Index;

  /// Can an ImpactWorld have a body of this form, and this box of its Object? Then `body` gets the shape, and
  /// `offset` says where its middle is from the body's place.
  static bool canHave(const naiad::physics::BodyForm& form, const naiad::physics::Metric& metric,
                      const FixedBox& box, naiad::physics::ImpactBody& body, naiad::physics::Vec2& offset);

  /// Nobody takes part, until he enters.
  void begin();
  /// Takes part in this tick: with the shape in `body`, the rest is filled in here. False if its numbers are
  /// beyond what can be calculated with.
  bool enter(const naiad::physics::BodyPlan& plan, const naiad::physics::BodyRow& row,
             naiad::physics::ImpactBody body, naiad::physics::Vec2 offset);
  /// Neither now, nor until now.
  bool isEmpty() const { return m_entrants.empty() && !m_had_entrants; }
  /// Lets a tick pass for those who entered, and appends what they touched. Plans get places and velocities.
  void step(World& world, const naiad::physics::BodyTable& table,
            std::vector<naiad::physics::BodyPlan>& plans, naiad::physics::BodyContacts& contacts);

  const naiad::physics::ImpactCounters& counters() const { return m_world.counters(); }

 private:
  struct Seat {               // by index of the table
    std::uint64_t order = 0;  // of the body's construction: who sits here
    int id = -1;
    bool is_taken = false;              // in this tick
    naiad::physics::Place row_place;    // what the table was told last,
    naiad::physics::Place world_place;  // which is this to the ImpactWorld,
    naiad::physics::Vec2 offset;        // with this between them
  };
  struct Entrant {
    Index index;
    naiad::physics::ImpactBody body;
    naiad::physics::Place looked;  // where it was looked around for obstacles, and how far
    naiad::physics::Vec2 looked_half;
  };
  struct Who {  // by id
    ObjectKey key;
    std::uint64_t order = 0;
    int plan = -1;  // −1: an obstacle
  };

  void adapt(const naiad::physics::BodyPlan& plan, const naiad::physics::BodyRow& row,
             naiad::physics::ImpactBody& body);
  void sitDown();
  void look(World& world, const naiad::physics::BodyTable& table, Entrant& entrant, double left, double room);
  void takeObstacles(World& world, const naiad::physics::BodyTable& table,
                     naiad::physics::BodyContacts& contacts);
  void know(int id, ObjectKey key, std::uint64_t order, int plan);
  void collect(double since, std::vector<naiad::physics::BodyPlan>& plans,
               naiad::physics::BodyContacts& contacts) const;
  void finish(std::vector<naiad::physics::BodyPlan>& plans);

  naiad::physics::ImpactWorld m_world;
  std::vector<Seat> m_seats;
  std::vector<Entrant> m_entrants;
  std::vector<int> m_plan_of;  // by entrant
  std::vector<Who> m_who;
  BodyObstacles m_obstacles;
  std::vector<ObjectKey> m_found;
  bool m_had_entrants = false;
};

}  // namespace df
