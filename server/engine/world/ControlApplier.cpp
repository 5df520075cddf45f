#include "engine/world/ControlApplier.h"

#include <memory>

#include "engine/world/Object.h"
#include "engine/world/Player.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldStore.h"
#include "shared/replica/Steering.h"

namespace df {

namespace {

/// The Object that a player steers, for the function that the client shares. One that is gone or inactive is
/// not moved.
class ControlApplier : public naiad::Steered {
 public:
  ControlApplier(World& world, ObjectKey object) : m_world(world), m_object(object) {}

  bool isManned() const {
    const Object* p_o = m_world.find(m_object);
    return p_o != nullptr && p_o->isActive();
  }
  FixedVector position() const override {
    return isManned() ? m_world.store().position(m_object.slot) : FixedVector{};
  }
  FixedVector velocity() const override {
    return isManned() ? m_world.store().velocity(m_object.slot) : FixedVector{};
  }
  void setVelocity(FixedVector velocity) override {
    if (isManned()) m_world.find(m_object)->setVelocity(Vector::fromFixed(velocity));
  }
  void moveTo(FixedVector position) override {
    if (isManned()) m_world.moveObject(m_world.find(m_object), Vector::fromFixed(position));
  }

 private:
  World& m_world;
  ObjectKey m_object;
};

}  // namespace

void beginControlTick(World& world) {
  for (const auto& [id, p_player] : world.views().players()) {
    if (p_player->m_p_controls == nullptr) continue;
    ControlApplier applier(world, p_player->m_object);
    p_player->m_control_state.steering = p_player->m_steers && applier.isManned();
    naiad::beginControlTick(*p_player->m_p_controls, p_player->m_control_state, applier);
  }
}

bool handleKey(World& world, Player& player, Keyboard::Key key, EventKeyboardAction action) {
  // Held on to: a handler that the move calls may declare other controls.
  const std::shared_ptr<const ControlTable> p_controls = player.m_p_controls;
  if (p_controls == nullptr) return false;
  ControlApplier applier(world, player.m_object);
  player.m_control_state.steering = player.m_steers && applier.isManned();
  return naiad::applyControlKey(*p_controls, player.m_control_state, key, action, applier);
}

}  // namespace df
