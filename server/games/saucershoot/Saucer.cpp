#include "Saucer.h"

#include <cstdlib>

#include "EventCollision.h"
#include "EventStep.h"
#include "Events.h"
#include "Explosion.h"
#include "Field.h"
#include "WorldManager.h"

const Saucer::Kind Saucer::kDrone = {"drone", 0.30, 0.04, 10};
const Saucer::Kind Saucer::kWeaver = {"weaver", 0.40, 0.16, 20};
const Saucer::Kind Saucer::kRaider = {"raider", 0.70, 0.02, 30};

const Saucer::Kind& Saucer::anyKind() {
  const int dice = WM.randomInt(10);
  return dice < 6 ? kDrone : dice < 9 ? kWeaver : kRaider;
}

Saucer::Saucer() : m_kind(anyKind()) {
  setType("Saucer");
  // SOFT, so that saucers do not block each other; swerve() keeps them apart.
  setSolidness(df::SOFT);
  setSprite(m_kind.sprite);
  registerInterest(df::STEP_EVENT);
  registerInterest(NUKE_EVENT);
  enter();
}

void Saucer::enter() {
  int row = static_cast<int>(topRow()) + WM.randomInt(static_cast<int>(bottomRow() - topRow()) + 1);
  // One saucer in three enters in the row of a random ship, so that no corner is safe and every pilot gets
  // targets.
  const df::ObjectList heroes = WM.objectsOfType("Hero");
  if (!heroes.isEmpty() && WM.randomInt(3) == 0) {
    row = static_cast<int>(heroes[WM.randomInt(heroes.getCount())]->getPosition().y());
  }
  setPosition(df::Vector(fieldWidth() + 3 + WM.randomInt(12), row));
  setDrift(WM.randomInt(3) - 1);
}

void Saucer::setDrift(int direction) {
  // Does not let the saucer leave the field.
  const double row = getPosition().y();
  if (row <= topRow()) direction = std::abs(direction);
  if (row >= bottomRow()) direction = -std::abs(direction);
  setVelocity(df::Vector(-m_kind.speed, direction * m_kind.drift));
}

int Saucer::eventHandler(const df::Event* p_e) {
  if (p_e->getType() == df::STEP_EVENT) {
    steer();
    return 1;
  }
  if (p_e->getType() == df::COLLISION_EVENT) {
    const auto* p_collision = static_cast<const df::EventCollision*>(p_e);
    const bool is_mover = p_collision->getObject1() == this;
    swerve(is_mover ? p_collision->getObject2() : p_collision->getObject1());
    return 1;
  }
  if (p_e->getType() == NUKE_EVENT) {
    // Saucers beyond the screen's edge are not affected by the flash.
    if (getPosition().x() < fieldWidth() + 3) explode();
    return 1;
  }
  return 0;
}

void Saucer::steer() {
  if (getPosition().x() < -3) enter();  // it has left the screen completely
  const double row = getPosition().y();
  if (row <= topRow()) {
    if (getVelocity().y() < 0) setDrift(1);
  } else if (row >= bottomRow()) {
    if (getVelocity().y() > 0) setDrift(-1);
  } else if (WM.randomInt(60) == 0) {
    setDrift(WM.randomInt(3) - 1);
  }
}

void Saucer::swerve(const df::Object* p_other) {
  if (p_other->getType() != "Saucer") return;  // collisions with ships and bullets are handled by those
  const double distance = getPosition().y() - p_other->getPosition().y();
  const bool down = distance == 0 ? getId() > p_other->getId() : distance > 0;
  setDrift(down ? 1 : -1);
}

bool Saucer::shotBy(std::uint32_t player) {
  if (!explode()) return false;
  const EventShotDown shot_down(player, m_kind.points);
  WM.onEvent(&shot_down);
  return true;
}

bool Saucer::explode() {
  if (m_exploded) return false;
  m_exploded = true;
  new Explosion(getPosition());
  WM.markForDelete(this);  // it still collides until the tick ends, so m_exploded is needed
  return true;
}
