#include "engine/sprites/Animation.h"

#include <string_view>
#include <utility>

namespace df {

namespace {

char mirrored(char ch, std::string_view pairs) {
  const std::size_t place = pairs.find(ch);
  return place == std::string_view::npos ? ch : pairs[place ^ 1];
}

Frame turnedOver(const Frame& frame, Transform transform) {
  const bool across = transform == Transform::HORIZONTAL || transform == Transform::BOTH;
  const bool down = transform == Transform::VERTICAL || transform == Transform::BOTH;
  const int width = frame.getWidth();
  const int height = frame.getHeight();
  std::string characters;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      char ch = frame.at(across ? width - 1 - x : x, down ? height - 1 - y : y);
      if (across) ch = mirrored(ch, "/\\<>()[]{}");
      if (down) ch = mirrored(ch, "/\\");
      characters += ch;
    }
  }
  return {width, height, std::move(characters)};
}

}  // namespace

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
  if (m_p_sprite == nullptr) return -1;
  if (m_transform == Transform::NO_TRANSFORM) return m_p_sprite->draw(m_index, position);
  return turnedOver(m_p_sprite->getFrame(m_index), m_transform)
      .draw(position, m_p_sprite->getColor(), m_p_sprite->getTransparency());
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
