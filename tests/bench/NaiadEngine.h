// A Scene in this project's engine, with only the means of a game: Objects, their handlers and WM.update().
#pragma once

#include <vector>

#include "Engine.h"
#include "Scene.h"
#include "engine/world/World.h"
#include "engine/world/WorldStore.h"

namespace bench {

class Ball;

/// Puts an Object that has left a square world back, and reflects its velocity at the border.
void turnBack(df::Object& object, double side);

class NaiadEngine : public Engine {
 public:
  explicit NaiadEngine(const Scene& scene);
  ~NaiadEngine() override;

  void tick() override;
  const Tally& tally() const override { return m_tally; }
  std::uint64_t stateHash() const override;
  const df::MoverStats& moverStats() const { return m_world.store().grid().moverStats(); }

 private:
  df::World m_world;
  Tally m_tally;
  std::vector<Ball*> m_balls;  // owned by the world, by id
};

}  // namespace bench
