// Keeps an ImpactWorld up to date with the BodyTable: the bodies that it moves, and their obstacles.
#pragma once

#include <array>
#include <vector>

#include "engine/world/World.h"
#include "physics/body/BlockContacts.h"
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

  /// True if an ImpactWorld can move a body of this form and Object box. Then sets the shape of `body`, and
  /// `offset` to its centre relative to the body's place.
  static bool canHave(const BodyGeometry& form, const Metric& metric, const FixedBox& box, ImpactBody& body,
                      Vec2& offset);

  /// Begins a tick without any bodies; add() adds them.
  void beginTick();
  /// Adds a body to this tick. `body` has the shape; this function sets its other fields. Returns false if
  /// numbers are too large to calculate with.
  bool add(const BodyState& state, const BodyRow& row, ImpactBody body, Vec2 offset, BodyContacts& contacts);
  /// True if no body is moved in this tick, and none was in the last one.
  bool isEmpty() const { return m_active.empty() && !m_was_active; }
  /// Steps the added bodies by a tick. Sets `is_costly` in the states of bodies that the ImpactWorld
  /// abandoned because they would have cost too much.
  void step(World& world, const BodyTable& table, std::vector<BodyState>& states, BodyContacts& contacts);

  bool hasGivenUp() const { return m_world.hasGivenUp(); }
  /// Call if another solver moves the body in this tick: discards this step's results for the body.
  void passOn(const BodyState& state);
  /// Appends the contacts of the bodies without passOn(), and sets the places and velocities in their states.
  void finish(const WorldStore& store, const BodyTable& table, std::vector<BodyState>& states,
              BodyContacts& contacts);

  const ImpactCounters& counters() const { return m_world.counters(); }

 private:
  struct Proxy {              // by row of the table
    std::uint64_t order = 0;  // construction order of the body that this entry belongs to
    int id = -1;
    bool is_used = false;  // true if added in this tick
    Place row_place;       // place of the body in the table after the last tick
    Place world_place;     // row_place as the ImpactWorld has it
    Vec2 offset;           // world_place − row_place
  };
  struct ActiveBody {
    Index index;
    ImpactBody body;
    Place search_centre;  // centre and half size of the area that is searched for obstacles
    Vec2 search_half;
  };
  struct Identity {  // entry of m_identities, which is indexed by id in the solver
    ObjectKey key;
    std::uint64_t order = 0;
    int state = -1;  // index of the state; −1: an obstacle
    int block = -1;  // index of the block, if it is not just one Object; else −1
  };
  struct FoundContact {
    BodyContact contact;
    std::array<int, 2> states;  // indices of the states; −1: an obstacle
    int body, block;            // ids of a body and of the block that it touches; block −1: none
  };

  void adapt(const BodyState& state, const BodyRow& row, ImpactBody& body);
  void updateBodies(BodyContacts& contacts);
  void searchAround(const BodyTable& table, ActiveBody& active, double left, double room);
  void updateObstacles(World& world, const BodyTable& table, BodyContacts& contacts);
  void identify(int id, const Identity& identity);
  void collect(double since);
  void settleBlocks(const WorldStore& store, const Metric& metric, const std::vector<BodyState>& states,
                    BodyContacts& contacts);

  ImpactWorld m_world;
  std::vector<Proxy> m_proxies;
  std::vector<ActiveBody> m_active;
  std::vector<int> m_state_of;  // index of the state, by active body
  std::vector<Identity> m_identities;
  std::vector<FoundContact> m_found_contacts;  // contacts found in this tick
  BodyObstacles m_obstacles;
  BlockContacts m_block_contacts;
  BodySurroundings m_surroundings;
  bool m_was_active = false;
};

}  // namespace naiad::physics
