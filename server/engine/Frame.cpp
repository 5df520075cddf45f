#include "Frame.h"

#include <utility>

#include "DisplayManager.h"

namespace df {

Frame::Frame(int new_width, int new_height, std::string frame_str)
    : m_width(new_width), m_height(new_height), m_string(std::move(frame_str)) {}

char Frame::at(int x, int y) const {
  if (x < 0 || y < 0 || x >= m_width || y >= m_height) return ' ';
  const std::size_t i =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(m_width) + static_cast<std::size_t>(x);
  return i < m_string.size() ? m_string[i] : ' ';
}

int Frame::draw(Vector position, Color color, char transparency) const {
  if (m_width < 1 || m_height < 1) return -1;
  const Vector corner = position - Vector((m_width - 1) / 2.0, (m_height - 1) / 2.0);
  int result = 0;
  for (int y = 0; y < m_height; ++y) {
    for (int x = 0; x < m_width; ++x) {
      const char ch = at(x, y);
      if (transparency != 0 && ch == transparency) continue;
      if (DM.drawCh(corner + Vector(x, y), ch, color) != 0) result = -1;
    }
  }
  return result;
}

}  // namespace df
