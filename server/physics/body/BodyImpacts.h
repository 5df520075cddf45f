// The bodies that an ImpactWorld moves, and their obstacles: keeps that world in step with the table.
#pragma once

#include <array>
#include <vector>

#include "engine/world/World.h"
#include "physics/body/BodyContacts.h"
#include "physics/body/BodyObstacles.h"
#include "physics/body/BodyState.h"
#include "physics/body/BodySurroundings.h"
#include "physics/impact/ImpactWorld.h"

namespace naiad::physics {

class BodyImpacts {
 public:
  BodyImpacts() { m_world.setReserve(ImpactWorld::kUsualReserve); }
  using Index = BodyTable::Index;

  /// Can an ImpactWorld have a body of this form, and this box of its Object? Then `body` gets the shape, and
  /// `offset` says where its middle is from the body's place.
  static bool canHave(const BodyForm& form, const Metric& metric, const FixedBox& box, ImpactBody& body,
                      Vec2& offset);

  /// No body takes part in this tick, until it is added.
  void beginTick();
  /// The body takes part in this tick: with the shape in `body`, the rest is filled in here. False if its
  /// numbers are beyond what can be calculated with.
  bool add(const BodyState& state, const BodyRow& row, ImpactBody body, Vec2 offset);
  /// No body takes part, nor did one in the last tick.
  bool isEmpty() const { return m_active.empty() && !m_was_active; }
  /// Steps the bodies that were added by a tick. `is_costly` of their states says which were given up, as
  /// they would have cost too much.
  void step(World& world, const BodyTable& table, std::vector<BodyState>& states, BodyContacts& contacts);

  bool hasGivenUp() const { return m_world.hasGivenUp(); }
  /// Another solver moves the body in this tick: what the step has done to it is forgotten.
  void passOn(const BodyState& state);
  /// Appends the contacts of those that are still here, whose states get places and velocities.
  void finish(std::vector<BodyState>& states, BodyContacts& contacts);

  const ImpactCounters& counters() const { return m_world.counters(); }

 private:
  struct Proxy {              // by index of the table
    std::uint64_t order = 0;  // of the body's construction: which body it stands for
    int id = -1;
    bool is_used = false;  // in this tick
    Place row_place;       // what the table got last,
    Place world_place;     // which is this to the ImpactWorld,
    Vec2 offset;           // with this between them
  };
  struct ActiveBody {
    Index index;
    ImpactBody body;
    Place search_centre;  // where obstacles were searched, and how far
    Vec2 search_half;
  };
  struct Identity {  // by id
    ObjectKey key;
    std::uint64_t order = 0;
    int state = -1;  // −1: an obstacle
  };
  struct FoundContact {
    BodyContact contact;
    std::array<int, 2> states;  // −1: an obstacle's
  };

  void adapt(const BodyState& state, const BodyRow& row, ImpactBody& body);
  void updateBodies();
  void searchAround(const BodyTable& table, ActiveBody& active, double left, double room);
  void updateObstacles(World& world, const BodyTable& table, BodyContacts& contacts);
  void identify(int id, ObjectKey key, std::uint64_t order, int state);
  void collect(double since);

  ImpactWorld m_world;
  std::vector<Proxy> m_proxies;
  std::vector<ActiveBody> m_active;
  std::vector<int> m_state_of;  // by active body
  std::vector<Identity> m_identities;
  std::vector<FoundContact> m_found_contacts;  // in this tick
  BodyObstacles m_obstacles;
  BodySurroundings m_surroundings;
  bool m_was_active = false;
};

}  // namespace naiad::physics
