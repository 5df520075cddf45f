// In the published engine, this manager divides the time for path searches among Objects. In Naiad,
// Object::pathTo() finds its path before it returns, so the manager has nothing to do.
#pragma once

#include <string>
#include <vector>

#include "Manager.h"
#include "PathFind.h"

#if !defined(PM)  // PhysicsManager.h defines PM, too
#define PM df::PathManager::getInstance()
#endif

namespace df {

class PathFind;

class PathManager : public Manager {
 public:
  static PathManager& getInstance();

  /// Returns 0, as do the next two functions.
  int startUp() override;
  int registerPathFind(PathFind* /*p_path_find*/) { return 0; }
  int unregisterPathFind(PathFind* /*p_path_find*/) { return 0; }
  /// Time in milliseconds; only stored, without effect.
  void setMinCycleTime(int new_min_cycle_time) { m_min_cycle_time = new_min_cycle_time; }
  int getMinCycleTime() const { return m_min_cycle_time; }
  void cycle(int /*max_cycle_time*/ = -1) {}

 private:
  PathManager() { setType("PathManager"); }

  int m_min_cycle_time = 3;
};

}  // namespace df
