#include "engine/sprites/Animation.h"

#include <utility>

namespace df {

void Animation::setSprite(Sprite* p_new_sprite) {
  m_p_sprite = p_new_sprite;
  m_index = 0;
  m_slowdown_count = 0;
}

Box Animation::getBox() const {
  return m_p_sprite == nullptr ? Box(Vector(-0.5, -0.5), 1, 1) : m_p_sprite->getBox();
}

int Animation::draw(Vector position) {
  const int result = paint(position);
  advance();
  return result;
}

int Animation::paint(Vector position) const {
  return m_p_sprite == nullptr ? -1 : m_p_sprite->draw(m_index, position);
}

bool Animation::advance() {
  if (m_p_sprite == nullptr || m_slowdown_count < 0) return false;
  const int slowdown = m_p_sprite->getTicksPerFrame();
  if (slowdown < 1 || ++m_slowdown_count < slowdown) return false;
  m_slowdown_count = 0;
  const int before = m_index;
  m_index = m_index + 1 < m_p_sprite->getFrameCount() ? m_index + 1 : 0;
  return m_index != before;
}

std::string Animation::toString() const {
  return m_name + ": frame " + std::to_string(m_index) + ", slowdown count " +
         std::to_string(m_slowdown_count);
}

}  // namespace df
