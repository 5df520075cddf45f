// The handlers of a random world, written once for engine and oracle: what each Object does at each event.
//
// Every decision is drawn from the world's seed, the Object's number and how many events it has had. So two
// worlds in which the same happened do the same, and the first difference is never the script's.
#pragma once

#include <vector>

#include "Actor.h"
#include "EventLog.h"
#include "RandomWorld.h"

namespace oracle {

class Script {
 public:
  /// Both must outlive the script.
  Script(const RandomWorld& world, Actor& actor) : m_world(world), m_actor(actor) {}

  /// Make the world's first Objects.
  void begin();
  /// At the start of each tick: what one tick may cost is limited.
  void beginTick();

  // The handlers.
  void onStep(int id);
  void onCollision(int id, int object1, int object2, FixedVector where);
  void onOut(int id);
  void onDestroyed(int id);

  EventLog& log() { return m_log; }
  const EventLog& log() const { return m_log; }
  /// Collision and out events handled, and what their handlers did.
  std::int64_t handled() const { return m_handled; }
  std::int64_t births() const { return m_births; }
  std::int64_t deaths() const { return m_deaths; }
  /// The most Objects in the world at one time; the fewest at the start of a tick is 2.
  int largest() const { return m_largest; }
  /// Those in the world, in its order.
  const std::vector<int>& present() const { return m_present; }
  /// All Objects that ever were.
  int created() const { return static_cast<int>(m_cast.size()); }

 private:
  struct Role {
    Temper temper = Temper::QUIET;
    int events = 0;
    bool present = true;  ///< neither destroyed nor removed
    bool marked = false;
  };

  Rng draw(int id);
  int someone(Rng& rng, int self, int other) const;
  void comeHome(Rng& rng, int id);
  void act(Rng& rng, int self, int other);
  void give(Rng& rng, int id);
  void create(const Spec& spec);
  void bear(Rng& rng, FixedVector near);
  void die(int id, bool by_hand);
  void remove(int id);
  void insert(int id);
  void readmit();
  void move(int id, FixedVector where);
  FixedVector nearby(Rng& rng, FixedVector position) const;
  bool isPresent(int id) const { return id >= 0 && m_cast[static_cast<std::size_t>(id)].present; }

  const RandomWorld& m_world;
  Actor& m_actor;
  EventLog m_log;
  std::vector<Role> m_cast;    ///< by number
  std::vector<int> m_present;  ///< in the world's order
  std::vector<int> m_removed;  ///< alive, but not in the world
  int m_moves_left = 0;        ///< in this tick
  int m_births_left = 0;
  std::int64_t m_tick = 0;
  int m_largest = 0;
  bool m_colliding = false;  ///< in a collision or out handler, not in a step handler
  std::int64_t m_handled = 0;
  std::int64_t m_births = 0;
  std::int64_t m_deaths = 0;
};

}  // namespace oracle
