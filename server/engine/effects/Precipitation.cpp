#include "engine/effects/Precipitation.h"

#include <climits>

#include "engine/events/EventOut.h"
#include "engine/events/EventStep.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"

namespace df {

Precipitation::Precipitation(float size, Direction direction, unsigned char opacity, unsigned char r,
                             unsigned char g, unsigned char b)
    : Particle(size, INT_MAX, opacity, r, g, b), m_direction(direction) {
  Object::setAltitude(0);
  enter(true);
}

void Precipitation::enter(bool anywhere) {
  World& world = *getWorld();
  Random& random = world.extras().decoration();
  const Box boundary = fromFixed(world.views().boundary());
  const double across = random.below(static_cast<int>(boundary.width()));
  const double down = random.below(static_cast<int>(boundary.height()));
  Vector place(across, down);
  if (!anywhere) {
    if (m_direction == DOWN) place.setY(0);
    if (m_direction == UP) place.setY(boundary.height() - 1);
    if (m_direction == RIGHT) place.setX(0);
    if (m_direction == LEFT) place.setX(boundary.width() - 1);
  }
  setPosition(boundary.getCorner() + place);
}

void Precipitation::fall(double speed) {
  const double ahead = m_direction == DOWN || m_direction == RIGHT ? speed : -speed;
  m_velocity = isVertical() ? Vector(0, ahead) : Vector(ahead, 0);
  setVelocity(m_velocity);
}

int Precipitation::eventHandler(const Event* p_e) {
  if (p_e->getType() == OUT_EVENT) {
    enter(false);
    return 1;
  }
  if (p_e->getType() != STEP_EVENT) return 0;
  if (m_turbulence) {
    const double aside = (getWorld()->extras().decoration().below(3) - 1) * 0.2;
    setVelocity(m_velocity + (isVertical() ? Vector(aside, 0) : Vector(0, aside)));
  }
  return 1;
}

}  // namespace df
