#include "engine/effects/Particle.h"

#include "engine/events/EventOut.h"
#include "engine/events/EventStep.h"
#include "engine/world/ObjectRegistry.h"
#include "engine/world/World.h"

namespace df {

Particle::Particle(float size, int age, unsigned char opacity, unsigned char r, unsigned char g,
                   unsigned char b)
    : m_age(age) {
  initialise(size, opacity);
  setRGB(r, g, b);
}

Particle::Particle(float size, int age, unsigned char opacity, Color color) : m_age(age) {
  initialise(size, opacity);
  setRGB(color);
}

void Particle::initialise(float size, unsigned char opacity) {
  Object::setType("df-particle");
  Object::setSolidness(SPECTRAL);
  Object::setAltitude(MAX_ALTITUDE);
  Shape shape;
  shape.setSize(size);
  shape.setOpacity(opacity);
  Object::setShape(shape);
  registerInterest(STEP_EVENT);
}

void Particle::setRGB(Color color) {
  Shape shape = getShape();
  shape.setColor(color);
  setShape(shape);
}

void Particle::setRGB(unsigned char r, unsigned char g, unsigned char b) {
  Shape shape = getShape();
  shape.setColor(r, g, b);
  setShape(shape);
}

int Particle::eventHandler(const Event* p_e) {
  const bool step = p_e->getType() == STEP_EVENT;
  if (!step && p_e->getType() != OUT_EVENT) return 0;
  if (!step || --m_age <= 0) getWorld()->objects().markForDelete(this);
  return 1;
}

}  // namespace df
