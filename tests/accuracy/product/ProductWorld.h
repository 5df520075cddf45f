// Common part of all scenes in the product: a World of their own, in which a metre is a cell and a tick of
// the scene is a tick.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "engine/managers/WorldManager.h"
#include "engine/world/Object.h"
#include "engine/world/World.h"
#include "engine/world/WorldLog.h"
#include "tests/accuracy/frame/Simulation.h"

namespace lab {

class ProductWorld : public Simulation {
 public:
  explicit ProductWorld(const Scene& scene) : m_tick(scene.tick) {
    m_world.log().setSink([](const std::string&) {});
  }
  ~ProductWorld() override { clear(); }

  void step(double /*tick*/, int /*substeps*/) override { m_world.update(); }
  std::optional<Work> work() const override { return Work{}; }

 protected:
  /// Makes an Object in the world, which must be the current one. It exists until clear() or the end of this
  /// ProductWorld.
  template <class Made, class... Arguments>
  Made& make(Arguments&&... arguments) {
    auto made = std::make_unique<Made>(std::forward<Arguments>(arguments)...);
    Made& result = *made;
    m_objects.push_back(std::move(made));
    return result;
  }
  /// Deletes the Objects from make(). For destructors of classes whose members these Objects use.
  void clear() {
    const df::World::Scope scope(m_world);
    m_objects.clear();
  }
  /// Converts a position in cells and a velocity in cells per tick to metres and seconds.
  BodyState stateOf(df::Vector position, df::Vector velocity) const {
    return {{position.x(), position.y()}, {velocity.x() / m_tick, velocity.y() / m_tick}, 0, 0};
  }

  df::World m_world;
  const double m_tick;  // length of a tick, s

 private:
  std::vector<std::unique_ptr<df::Object>> m_objects;
};

}  // namespace lab
