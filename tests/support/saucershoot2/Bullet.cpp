#include "Bullet.h"

#include "EventOut.h"
#include "WorldManager.h"

Bullet::Bullet(df::Vector hero_pos) {
  setType("Bullet");
  setSprite("bullet");
  setSolidness(df::SOFT);  // SOFT because it starts close to the ship
  setPosition(df::Vector(hero_pos.getX() + 5, hero_pos.getY()));
  setSpeed(1);
}

int Bullet::eventHandler(const df::Event* p_e) {
  if (p_e->getType() == df::OUT_EVENT) {
    out();
    return 1;
  }
  if (p_e->getType() == df::COLLISION_EVENT) {
    hit(dynamic_cast<const df::EventCollision*>(p_e));
    return 1;
  }
  return 0;
}

void Bullet::out() {
  WM.markForDelete(this);
}

void Bullet::hit(const df::EventCollision* p_collision_event) {
  if (p_collision_event->getObject1()->getType() == "Saucer" ||
      p_collision_event->getObject2()->getType() == "Saucer") {
    WM.markForDelete(p_collision_event->getObject1());
    WM.markForDelete(p_collision_event->getObject2());
  }
}
