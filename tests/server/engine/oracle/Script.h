// The handlers of a random world, written once for engine and oracle: what each Object does at each event.
//
// Every decision is drawn from the world's seed, the Object's number and the number of its earlier events. So
// worlds with equal events make equal decisions, and the first difference is never the script's.
#pragma once

#include <vector>

#include "Actor.h"
#include "EventLog.h"
#include "RandomWorld.h"

namespace oracle {

class Script {
 public:
  /// `world` and `actor` must outlive the script.
  Script(const RandomWorld& world, Actor& actor) : m_world(world), m_actor(actor) {}

  /// Creates the world's first Objects.
  void begin();
  /// Resets the limits of moves and births per tick. Call at the start of each tick.
  void beginTick();

  // Event handlers.
  void onStep(int id);
  void onCollision(int id, int object1, int object2, FixedVector where);
  void onOut(int id);
  void onDestroyed(int id);

  EventLog& log() { return m_log; }
  const EventLog& log() const { return m_log; }
  /// Returns the number of collision and out events handled. The next functions count what their handlers
  /// did.
  std::int64_t handled() const { return m_handled; }
  std::int64_t births() const { return m_births; }
  std::int64_t deaths() const { return m_deaths; }
  /// Returns the largest number of Objects in the world at one time. A tick starts with at least 2.
  int largest() const { return m_largest; }
  /// Returns the Objects in the world, in its order.
  const std::vector<int>& present() const { return m_present; }
  /// Returns the number of Objects ever created.
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
  std::vector<Role> m_cast;    ///< index: id
  std::vector<int> m_present;  ///< present Objects, in the world's order
  std::vector<int> m_removed;  ///< alive, but not in the world
  int m_moves_left = 0;        ///< left in this tick
  int m_births_left = 0;
  std::int64_t m_tick = 0;
  int m_largest = 0;
  bool m_colliding = false;  ///< true in a collision or out handler
  std::int64_t m_handled = 0;
  std::int64_t m_births = 0;
  std::int64_t m_deaths = 0;
};

}  // namespace oracle
