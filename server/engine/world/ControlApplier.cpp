#include "engine/world/ControlApplier.h"

#include <memory>

#include "engine/world/Mover.h"
#include "engine/world/Object.h"
#include "engine/world/Views.h"
#include "engine/world/WorldStore.h"
#include "shared/replica/Steering.h"

namespace df {

/// Gives the functions that the client also uses (Steering.h) access to the Object that a player steers. An
/// Object that is deleted or inactive is not moved.
class ControlApplier::SteeringTarget : public naiad::SteeringTarget {
 public:
  SteeringTarget(Mover& mover, Player& player) : m_mover(mover), m_object(player.m_object) {
    player.m_control_state.steering = player.m_steers && isManned();
  }

  FixedVector position() const override {
    return isManned() ? m_mover.store().position(m_object.slot) : FixedVector{};
  }
  FixedVector velocity() const override {
    return isManned() ? m_mover.store().velocity(m_object.slot) : FixedVector{};
  }
  void setVelocity(FixedVector velocity) override {
    if (isManned()) m_mover.store().find(m_object)->setVelocity(Vector::fromFixed(velocity));
  }
  void moveTo(FixedVector position) override {
    if (isManned()) m_mover.moveObject(m_mover.store().find(m_object), Vector::fromFixed(position));
  }

 private:
  bool isManned() const {
    const Object* p_o = m_mover.store().find(m_object);
    return p_o != nullptr && p_o->isActive();
  }

  Mover& m_mover;
  ObjectKey m_object;
};

void ControlApplier::beginTick(Mover& mover) {
  for (const auto& [id, p_player] : mover.views().players()) {
    if (p_player->m_p_controls == nullptr) continue;
    SteeringTarget steered(mover, *p_player);
    naiad::beginControlTick(*p_player->m_p_controls, p_player->m_control_state, steered);
  }
}

bool ControlApplier::handleKey(Mover& mover, Player& player, Keyboard::Key key, EventKeyboardAction action) {
  // Holds a reference to the table, because a handler that the move calls may declare other controls.
  const std::shared_ptr<const ControlTable> p_controls = player.m_p_controls;
  if (p_controls == nullptr) return false;
  SteeringTarget steered(mover, player);
  return naiad::applyControlKey(*p_controls, player.m_control_state, key, action, steered);
}

}  // namespace df
