#include "Bullet.h"

#include <cmath>

#include "DisplayManager.h"
#include "EventCollision.h"
#include "EventOut.h"
#include "Saucer.h"
#include "WorldManager.h"

namespace {

/// A character that looks like the path of a bullet.
char lookAlong(df::Vector direction) {
  const double across = std::abs(direction.x());
  const double down = 2 * std::abs(direction.y());  // cells are about twice as high as wide
  if (down < 0.5 * across) return '-';
  if (across < 0.5 * down) return '|';
  return direction.x() * direction.y() > 0 ? '\\' : '/';
}

}  // namespace

Bullet::Bullet(std::uint32_t player, df::Color color, df::Vector position, df::Vector direction)
    : m_player(player), m_color(color), m_look(lookAlong(direction)) {
  setType("Bullet");
  setSolidness(df::SOFT);  // a HARD one could not leave the ship that shoots it
  setStaticLook();
  setPosition(position);
  // As long as the path of one tick: nothing slips through between two positions.
  setBox(df::Box(df::Vector(-1.5, -0.5), 3, 1));

  // On the screen all directions shall look equally fast, so a row counts as two columns.
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
  // A marked Object goes on colliding until the tick is over, and one bullet must not bring down two.
  if (m_spent || p_other->getType() != "Saucer") return;
  m_spent = static_cast<Saucer*>(p_other)->shotBy(m_player);
  if (m_spent) WM.markForDelete(this);
}

int Bullet::draw() {
  return DM.drawCh(getPosition(), m_look, m_color);
}
