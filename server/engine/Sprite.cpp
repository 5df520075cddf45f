#include "Sprite.h"

#include <utility>

namespace df {

Sprite::Sprite(int max_frames) : m_max_frames(max_frames) {}

int Sprite::addFrame(Frame new_frame) {
  if (getFrameCount() >= m_max_frames) return -1;
  m_frames.push_back(std::move(new_frame));
  return 0;
}

Frame Sprite::getFrame(int frame_number) const {
  if (frame_number < 0 || frame_number >= getFrameCount()) return {};
  return m_frames[static_cast<std::size_t>(frame_number)];
}

void Sprite::setTransparency(char new_transparency) {
  m_transparency = new_transparency;
  m_masks.clear();
}

int Sprite::draw(int frame_number, Vector position, char transparency) const {
  if (frame_number < 0 || frame_number >= getFrameCount()) return -1;
  return m_frames[static_cast<std::size_t>(frame_number)].draw(position, m_color, transparency);
}

const Mask* Sprite::mask(int frame_number) const {
  if (frame_number < 0 || frame_number >= getFrameCount()) return nullptr;
  if (m_masks.size() != m_frames.size()) m_masks.assign(m_frames.size(), std::nullopt);
  const auto i = static_cast<std::size_t>(frame_number);
  if (!m_masks[i]) {
    const Frame& frame = m_frames[i];
    std::vector<std::string> rows;
    for (int y = 0; y < frame.getHeight(); ++y) {
      std::string& row = rows.emplace_back();
      // Byte by byte, as it is drawn: a byte beyond ASCII shows as one character.
      for (int x = 0; x < frame.getWidth(); ++x) {
        const char ch = frame.at(x, y);
        const bool hole = ch == ' ' || (m_transparency != 0 && ch == m_transparency);
        row += hole ? ' ' : '#';
      }
    }
    m_masks[i] = Mask::fromRows(rows);
  }
  return m_masks[i] ? &*m_masks[i] : nullptr;
}

std::string Sprite::toString() const {
  return m_label + ": " + std::to_string(m_width) + "x" + std::to_string(m_height) + ", " +
         std::to_string(getFrameCount()) + " frames, slowdown " + std::to_string(m_slowdown);
}

}  // namespace df
