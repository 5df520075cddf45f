#include "engine/sprites/Sprite.h"

#include <utility>

#include "shared/replica/Limits.h"
#include "shared/replica/Look.h"
#include "shared/replica/LookCodec.h"

namespace df {

namespace {

/// Returns the characters that Frame::draw() draws, relative to the position.
naiad::Appearance pictureOf(const Frame& frame, Color color, char transparency) {
  constexpr int kHalf = 1 << (naiad::kGlyphUnitBits - 1);
  naiad::Appearance picture;
  for (int y = 0; y < frame.getHeight(); ++y) {
    for (int x = 0; x < frame.getWidth(); ++x) {
      const char ch = frame.at(x, y);
      if (transparency != 0 && ch == transparency) continue;
      const auto code = static_cast<unsigned char>(ch);
      picture.push_back({(2 * x - frame.getWidth() + 1) * kHalf, (2 * y - frame.getHeight() + 1) * kHalf,
                         code < 0x80 && isDrawable(code) ? char32_t{code} : U'?',
                         color == CUSTOM ? COLOR_DEFAULT : color});
    }
  }
  return picture;
}

}  // namespace

Sprite::Sprite(int max_frames) : m_max_frames(max_frames) {}

int Sprite::addFrame(Frame new_frame) {
  if (getFrameCount() >= m_max_frames) return -1;
  m_frames.push_back(std::move(new_frame));
  m_p_pictures.reset();
  return 0;
}

void Sprite::setColor(Color new_color) {
  m_color = new_color;
  m_p_pictures.reset();
}

Frame Sprite::getFrame(int frame_number) const {
  if (frame_number < 0 || frame_number >= getFrameCount()) return {};
  return m_frames[static_cast<std::size_t>(frame_number)];
}

void Sprite::setTransparency(char new_transparency) {
  m_transparency = new_transparency;
  m_masks.clear();
  m_p_pictures.reset();
}

int Sprite::draw(int frame_number, Vector position, char transparency) const {
  if (frame_number < 0 || frame_number >= getFrameCount()) return -1;
  return m_frames[static_cast<std::size_t>(frame_number)].draw(position, m_color, transparency);
}

const Mask* Sprite::mask(int frame_number) const {
  if (frame_number < 0 || frame_number >= getFrameCount()) return nullptr;
  if (m_masks.size() != m_frames.size()) m_masks.assign(m_frames.size(), nullptr);
  const auto i = static_cast<std::size_t>(frame_number);
  if (m_masks[i] == nullptr) {
    const Frame& frame = m_frames[i];
    std::vector<std::string> rows;
    for (int y = 0; y < frame.getHeight(); ++y) {
      std::string& row = rows.emplace_back();
      // One character per byte, as draw() draws them, even for bytes beyond ASCII.
      for (int x = 0; x < frame.getWidth(); ++x) {
        const char ch = frame.at(x, y);
        const bool hole = ch == ' ' || (m_transparency != 0 && ch == m_transparency);
        row += hole ? ' ' : '#';
      }
    }
    m_masks[i] = std::make_shared<const Mask>(Mask::fromRows(rows).value_or(Mask()));
  }
  return m_masks[i]->width() > 0 ? m_masks[i].get() : nullptr;
}

const naiad::Sequence& Sprite::pictures() const {
  if (m_p_pictures == nullptr) m_p_pictures = std::make_shared<const naiad::Sequence>(makePictures());
  return *m_p_pictures;
}

naiad::Sequence Sprite::makePictures() const {
  if (m_frames.empty() || m_frames.size() > naiad::kMaxFrames) return {};
  std::vector<naiad::Appearance> pictures;
  std::size_t glyphs = 0;
  for (const Frame& frame : m_frames) {
    pictures.push_back(pictureOf(frame, m_color, m_transparency));
    glyphs += pictures.back().size();
    if (glyphs > naiad::kMaxGlyphs) return {};
  }
  if (glyphs == 0) return {};
  naiad::Sequence sequence(std::move(pictures));
  const bool fits =
      sequence.reach() <= naiad::kMaxGlyphOffset && naiad::encodedBits(sequence) <= 8 * naiad::kMaxLookBytes;
  return fits ? sequence : naiad::Sequence();
}

std::string Sprite::toString() const {
  return m_label + ": " + std::to_string(m_width) + "x" + std::to_string(m_height) + ", " +
         std::to_string(getFrameCount()) + " frames, slowdown " + std::to_string(m_slowdown);
}

}  // namespace df
