// What a script can do to a world, and all that a comparison wants to see of it: implemented once over the
// engine and once over the oracle. Objects are named by numbers, in the order of their creation.
#pragma once

#include <optional>
#include <vector>

#include "RandomWorld.h"
#include "shared/values/Fixed.h"
#include "shared/values/Solidness.h"

namespace oracle {

/// The state of one Object after a tick.
struct Snapshot {
  int id = 0;
  FixedVector position;
  FixedVector velocity;
  FixedBox box;
  Solidness solidness = df::HARD;
  bool no_soft = false;
  bool active = true;
  Options options;

  friend bool operator==(const Snapshot&, const Snapshot&) = default;
};

/// What firstContact() found.
struct Meeting {
  int id = -1;      ///< none
  double time = 1;  ///< rounded, perhaps not in the same way by both
  FixedVector position;
};

class Actor {
 public:
  virtual ~Actor() = default;

  virtual void create(int id, const Spec& spec) = 0;
  // For these, `id` must exist.
  virtual void markForDelete(int id) = 0;
  virtual void deleteByHand(int id) = 0;
  /// Take out of the world, alive; nothing but insert() and deleteByHand() is done to it then.
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
  /// Of all Objects: the world's switch.
  virtual void setSweptCollisions(bool swept) = 0;

  virtual FixedVector getPosition(int id) const = 0;
  virtual FixedVector getVelocity(int id) const = 0;
  virtual Solidness getSolidness(int id) const = 0;
  virtual bool getSweptCollisions() const = 0;
  virtual Meeting firstContact(int id, FixedVector where) = 0;
  virtual std::optional<FixedVector> findFree(FixedBox box, FixedVector near) = 0;

  /// One tick: the step event, then all moves, then all deletions.
  virtual void tick() = 0;
  /// All Objects that live, in the world's order.
  virtual std::vector<Snapshot> snapshot() const = 0;
};

}  // namespace oracle
