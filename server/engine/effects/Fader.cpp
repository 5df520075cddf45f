#include "engine/effects/Fader.h"

#include <algorithm>
#include <cmath>

#include "engine/events/EventStep.h"

namespace df {

static float fadeOf(int age, unsigned char opacity) {
  const float fade = static_cast<float>(opacity) / static_cast<float>(std::max(age, 1));
  return fade < 1 ? fade : std::floor(fade);
}

Fader::Fader(float size, int age, unsigned char opacity, unsigned char r, unsigned char g, unsigned char b)
    : Particle(size, age, opacity, r, g, b), m_fade(fadeOf(age, opacity)) {}

Fader::Fader(float size, int age, unsigned char opacity, Color color)
    : Particle(size, age, opacity, color), m_fade(fadeOf(age, opacity)) {}

int Fader::eventHandler(const Event* p_e) {
  if (p_e->getType() == STEP_EVENT) {
    Shape shape = getShape();
    const float lost = std::floor(m_lost += m_fade);
    m_lost -= lost;
    const int left = shape.getOpacity() - static_cast<int>(lost);
    shape.setOpacity(static_cast<unsigned char>(std::max(left, 0)));
    setShape(shape);
  }
  return Particle::eventHandler(p_e);
}

}  // namespace df
