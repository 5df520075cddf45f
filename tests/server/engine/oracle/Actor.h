// The interface by which a script acts on a world and reads the results that are compared. It is implemented
// for the engine and for the oracle. Objects are numbered in creation order.
#pragma once

#include <optional>
#include <vector>

#include "RandomWorld.h"

namespace oracle {

/// The state of one Object after a tick.
struct Snapshot : State {
  int id = 0;

  friend bool operator==(const Snapshot&, const Snapshot&) = default;
};

/// The result of firstContact().
struct Meeting {
  int id = -1;      ///< -1: no contact
  double time = 1;  ///< rounded; engine and oracle may round differently
  FixedVector position;
};

class Actor {
 public:
  virtual ~Actor() = default;

  virtual void create(int id, const Spec& spec) = 0;
  // The functions below require an existing `id`.
  virtual void markForDelete(int id) = 0;
  virtual void deleteByHand(int id) = 0;
  /// Removes the Object from the world without deleting it. Afterwards only insert() and deleteByHand() are
  /// called for it.
  virtual void remove(int id) = 0;
  virtual void insert(int id) = 0;
  virtual int moveObject(int id, FixedVector where) = 0;
  virtual void setPosition(int id, FixedVector position) = 0;
  virtual void setVelocity(int id, FixedVector velocity) = 0;
  virtual void setAcceleration(int id, FixedVector acceleration) = 0;
  virtual void setSolidness(int id, Solidness solidness) = 0;
  virtual void setBox(int id, FixedBox box) = 0;
  virtual void setNoSoft(int id, bool no_soft) = 0;
  virtual void setActive(int id, bool active) = 0;
  virtual void setOptions(int id, Options options) = 0;
  virtual void setMask(int id, const Mask& mask) = 0;
  /// Sets the world's setting for all Objects (WM.setSweptCollisions()).
  virtual void setSweptCollisions(bool swept) = 0;

  virtual FixedVector getPosition(int id) const = 0;
  virtual FixedVector getVelocity(int id) const = 0;
  virtual Solidness getSolidness(int id) const = 0;
  virtual bool getSweptCollisions() const = 0;
  virtual Meeting firstContact(int id, FixedVector where) = 0;
  virtual std::optional<FixedVector> findFree(FixedBox box, FixedVector near) = 0;

  /// Runs one tick: the step event, then all moves, then all deletions.
  virtual void tick() = 0;
  /// Returns the states of all live Objects, in the world's order.
  virtual std::vector<Snapshot> snapshot() const = 0;
};

}  // namespace oracle
