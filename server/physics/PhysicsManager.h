// What holds for all bodies of the current world.
#pragma once

#include <cstdint>

#include "Integrator.h"
#include "Manager.h"
#include "Vector.h"

#define PM df::PhysicsManager::getInstance()

namespace df {

/// Holds no state of its own, as all managers. Setters return 0, or -1 (and no change) for numbers that are
/// not finite or out of range.
class PhysicsManager : public Manager {
 public:
  static PhysicsManager& getInstance();

  /// Cells per tick², for every body by its gravity scale; (0,0) by default.
  int setGravity(Vector gravity);
  Vector getGravity() const;
  /// Height of a character cell over its width, 0.25 … 4; 2 by default. Lengths, angles and circles are what
  /// they seem on such a screen. Only while there are no bodies.
  int setAspect(double aspect);
  double getAspect() const;
  /// How fields are integrated; docs/physics/flight.md has the table. Returns -1 for settings out of range.
  int setIntegrator(const naiad::physics::IntegratorOptions& options);
  const naiad::physics::IntegratorOptions& getIntegrator() const;

  /// Bodies in the world, removed ones included.
  int getBodyCount() const;
  /// Bodies that were frozen so far (Body::isFrozen).
  std::uint64_t getQuarantineCount() const;

 private:
  PhysicsManager() { setType("PhysicsManager"); }
};

}  // namespace df
