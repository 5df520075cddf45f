#include "Book.h"

namespace textbook {

Object::Object() {
  static int id = 0;
  m_id = id;
  id++;
  m_altitude = 2;
  m_speed = 0;
  m_solidness = HARD;
  m_no_soft = false;
  WM.insertObject(this);
}

Object::~Object() {
  WM.removeObject(this);
}

void Object::setType(std::string new_type) {
  m_type = new_type;
}

void Object::setPosition(Vector new_pos) {
  m_position = new_pos;
}

Vector Object::getPosition() const {
  return m_position;
}

void Object::setVelocity(Vector new_velocity) {
  m_speed = new_velocity.getMagnitude();
  new_velocity.normalize();
  m_direction = new_velocity;
}

Vector Object::getVelocity() const {
  Vector velocity = m_direction;
  velocity.scale(m_speed);
  return velocity;
}

Vector Object::predictPosition() {
  // Add velocity to position.
  Vector new_pos = m_position + getVelocity();
  return new_pos;
}

bool Object::isSolid() const {
  return m_solidness == HARD || m_solidness == SOFT;
}

int Object::setSolidness(Solidness new_solid) {
  if (new_solid != HARD && new_solid != SOFT && new_solid != SPECTRAL) return -1;
  m_solidness = new_solid;
  return 0;
}

Solidness Object::getSolidness() const {
  return m_solidness;
}

bool Object::getNoSoft() const {
  return m_no_soft;
}

int Object::eventHandler(const Event* /*p_e*/) {
  return 0;
}

}  // namespace textbook
