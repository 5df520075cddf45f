#include "engine/effects/Fader.h"

#include <algorithm>

#include "engine/events/EventStep.h"

namespace df {

static unsigned char fadeOf(int age, unsigned char opacity) {
  return static_cast<unsigned char>(opacity / std::max(age, 1));
}

Fader::Fader(float size, int age, unsigned char opacity, unsigned char r, unsigned char g, unsigned char b)
    : Particle(size, age, opacity, r, g, b), m_fade(fadeOf(age, opacity)) {}

Fader::Fader(float size, int age, unsigned char opacity, Color color)
    : Particle(size, age, opacity, color), m_fade(fadeOf(age, opacity)) {}

int Fader::eventHandler(const Event* p_e) {
  if (p_e->getType() == STEP_EVENT) {
    Shape shape = getShape();
    const int left = shape.getOpacity() - m_fade;
    shape.setOpacity(static_cast<unsigned char>(std::max(left, 0)));
    setShape(shape);
  }
  return Particle::eventHandler(p_e);
}

}  // namespace df
