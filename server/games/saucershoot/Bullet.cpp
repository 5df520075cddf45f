#include "Bullet.h"

#include <cmath>

#include "EventCollision.h"
#include "EventOut.h"
#include "Saucer.h"
#include "Sprites.h"
#include "WorldManager.h"

Bullet::Bullet(std::uint32_t player, df::Color color, df::Vector position, df::Vector direction)
    : m_player(player) {
  setType("Bullet");
  setSolidness(df::SOFT);  // a HARD bullet could not leave the ship that shoots it
  setPosition(position);
  setSprite(inColor("bullet", color));  // longer than its path in a tick, so that it passes through nothing

  // All directions should look equally fast on the screen. A row is as high as two columns are wide.
  const double x = direction.x();
  const double y = direction.y();
  direction.scale(kSpeed / std::sqrt(x * x + 4 * y * y));
  setVelocity(direction);
}

int Bullet::eventHandler(const df::Event* p_e) {
  if (p_e->getType() == df::OUT_EVENT) {
    WM.markForDelete(this);
    return 1;
  }
  if (p_e->getType() == df::COLLISION_EVENT) {
    const auto* p_collision = static_cast<const df::EventCollision*>(p_e);
    const bool is_mover = p_collision->getObject1() == this;
    hit(is_mover ? p_collision->getObject2() : p_collision->getObject1());
    return 1;
  }
  return 0;
}

void Bullet::hit(df::Object* p_other) {
  // An Object marked for deletion still collides until the tick ends, but a bullet must not hit two saucers.
  if (m_spent || p_other->getType() != "Saucer") return;
  m_spent = static_cast<Saucer*>(p_other)->shotBy(m_player);
  if (m_spent) WM.markForDelete(this);
}
