#include "engine/world/Shape.h"

#include "engine/world/ColorMix.h"
#include "engine/world/Drawing.h"

namespace df {

void Shape::setColor(Color new_color) {
  m_color = new_color;
  colorToRGB(new_color, m_r, m_g, m_b);
}

void Shape::setColor(unsigned char r, unsigned char g, unsigned char b) {
  m_color = CUSTOM;
  m_r = r;
  m_g = g;
  m_b = b;
}

void Shape::draw(Vector world_pos) const {
  constexpr float kPoint = 4;  // pixels; smaller shapes are drawn as '.'
  constexpr unsigned char kInvisible = 32;
  constexpr unsigned char kFaint = 128;
  if (m_opacity < kInvisible || m_size <= 0 || m_type == UNDEFINED_SHAPE) return;
  char ch = '.';
  if (m_size >= kPoint && m_opacity >= kFaint) {
    ch = m_type == SQUARE ? '#' : m_type == TRIANGLE ? '^' : m_size < 2 * kPoint ? 'o' : 'O';
  } else if (m_size >= kPoint) {
    ch = ':';
  }
  drawCharacter(world_pos, ch, m_color == CUSTOM ? nearestColor(m_r, m_g, m_b) : m_color);
}

std::string Shape::toString() const {
  return "shape " + std::to_string(m_type) + ", color " + std::to_string(m_color) + ", size " +
         std::to_string(m_size) + ", opacity " + std::to_string(m_opacity);
}

}  // namespace df
