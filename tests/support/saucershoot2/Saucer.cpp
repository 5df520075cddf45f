#include "Saucer.h"

#include "EventNuke.h"
#include "EventOut.h"
#include "EventView.h"
#include "Explosion.h"
#include "Points.h"
#include "ResourceManager.h"
#include "WorldManager.h"

Saucer::Saucer() {
  setSprite("saucer");
  setType("Saucer");
  setVelocity(df::Vector(-0.25, 0));
  shot = false;
  registerInterest(NUKE_EVENT);
  moveToStart();
}

Saucer::~Saucer() {
  // Adds ten points for this saucer.
  df::EventView ev(POINTS_STRING, 10, true);
  WM.onEvent(&ev);
}

int Saucer::eventHandler(const df::Event* p_e) {
  if (p_e->getType() == df::OUT_EVENT) {
    out();
    return 1;
  }
  if (p_e->getType() == df::COLLISION_EVENT) {
    const df::EventCollision* p_collision_event = dynamic_cast<const df::EventCollision*>(p_e);
    hit(p_collision_event);
    return 1;
  }
  if (p_e->getType() == NUKE_EVENT) {
    new Explosion(getPosition());
    WM.markForDelete(this);
    new Saucer;
    return 1;
  }
  return 0;
}

void Saucer::out() {
  if (getPosition().getX() >= 0) return;
  moveToStart();
  new Saucer;
}

void Saucer::hit(const df::EventCollision* p_c) {
  df::Object* p_other = p_c->getObject1() == this ? p_c->getObject2() : p_c->getObject1();
  if (p_other->getType() == "Saucer") return;
  if (p_other->getType() == "Bullet" && !shot) {
    shot = true;  // because it may collide with the bullet again in this update
    new Explosion(getPosition());
    df::Sound* p_sound = RM.getSound("explode");
    if (p_sound != NULL) p_sound->play();
    new Saucer;
  }
  if (p_other->getType() == "Hero") {
    WM.markForDelete(p_c->getObject1());
    WM.markForDelete(p_c->getObject2());
  }
}

void Saucer::moveToStart() {
  float world_horiz = WM.getBoundary().getHorizontal();
  float world_vert = WM.getBoundary().getVertical();
  df::Vector temp_pos(world_horiz + rand() % (int)world_horiz + 3.0f, rand() % (int)(world_vert - 5) + 4.0f);
  // Do not start on top of another object.
  df::ObjectList collision_list = WM.getCollisions(this, temp_pos);
  while (!collision_list.isEmpty()) {
    temp_pos.setX(temp_pos.getX() + 1);
    collision_list = WM.getCollisions(this, temp_pos);
  }
  WM.moveObject(this, temp_pos);
}
