#include "engine/sprites/Frame.h"

#include <utility>

namespace df {

Frame::Frame(int new_width, int new_height, std::string frame_str)
    : m_width(new_width), m_height(new_height), m_string(std::move(frame_str)) {}

char Frame::at(int x, int y) const {
  if (x < 0 || y < 0 || x >= m_width || y >= m_height) return ' ';
  const std::size_t i =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(m_width) + static_cast<std::size_t>(x);
  return i < m_string.size() ? m_string[i] : ' ';
}

}  // namespace df
