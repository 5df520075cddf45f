#include "engine/effects/Debris.h"

#include "engine/managers/DisplayManager.h"

namespace df {

Debris::Debris(int age, unsigned char opacity, Color color, Vector velocity, char ch, float /*rotate*/)
    : Particle(10, age, opacity, color), m_ch(ch), m_color(color) {
  setVelocity(velocity);
  setStaticLook();
}

int Debris::draw() {
  return DM.drawCh(getPosition(), m_ch, m_color);
}

}  // namespace df
