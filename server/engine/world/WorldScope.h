// Makes a world the current world of the calling thread while this object exists (World::Scope).
#pragma once

namespace df {

class World;

class WorldScope {
 public:
  explicit WorldScope(World& world);
  ~WorldScope();
  WorldScope(const WorldScope&) = delete;
  WorldScope& operator=(const WorldScope&) = delete;

 private:
  World* m_p_before;
};

}  // namespace df
