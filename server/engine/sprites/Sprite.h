// A named sequence of frames, all of one size, with a colour and a slowdown (book, Listing 4.139).
// RM.loadSprite() loads sprites from files. They belong to the ResourceManager; Objects share them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "Box.h"
#include "Color.h"
#include "Frame.h"
#include "detail/Mask.h"

namespace naiad {
class Sequence;
}

namespace df {

class Sprite {
 public:
  /// Makes a sprite without frames, with room for `max_frames`.
  explicit Sprite(int max_frames);

  /// Size of all frames, in characters.
  void setWidth(int new_width) { m_width = new_width; }
  int getWidth() const { return m_width; }
  void setHeight(int new_height) { m_height = new_height; }
  int getHeight() const { return m_height; }
  /// Returns the box around a position: width by height cells, the position in the middle.
  Box getBox() const { return {Vector(-m_width / 2.0, -m_height / 2.0), double(m_width), double(m_height)}; }

  /// The colour of all its frames.
  void setColor(Color new_color);
  Color getColor() const { return m_color; }

  /// Adds a frame at the end. Returns 0, or -1 if there are max_frames already.
  int addFrame(Frame new_frame);
  int getFrameCount() const { return static_cast<int>(m_frames.size()); }
  /// Returns a frame; an empty frame if `frame_number` is not in 0 … getFrameCount()-1.
  Frame getFrame(int frame_number) const;

  /// Label under which the sprite was loaded.
  void setLabel(std::string new_label) { m_label = std::move(new_label); }
  const std::string& getLabel() const { return m_label; }

  /// Number of ticks for which each frame is shown; 0: the animation does not advance (compat: like 1).
  void setSlowdown(int new_sprite_slowdown) { m_slowdown = new_sprite_slowdown; }
  int getSlowdown() const { return m_slowdown; }
  /// Makes a slowdown of 0 or less show each frame for one tick. The engine sets it in worlds with compat.
  void setNeverStill(bool never_still = true) { m_never_still = never_still; }
  /// Returns the number of ticks for which each frame is really shown; 0: the animation does not advance.
  int getTicksPerFrame() const { return m_slowdown > 0 ? m_slowdown : m_never_still ? 1 : 0; }

  /// Character that is not drawn; 0: all are drawn, blanks included.
  void setTransparency(char new_transparency);
  char getTransparency() const { return m_transparency; }

  /// Draws one frame around a position like Frame::draw(). Returns -1 also for a number without a frame.
  int draw(int frame_number, Vector position, char transparency) const;
  int draw(int frame_number, Vector position) const { return draw(frame_number, position, m_transparency); }

  /// Returns the mask of a frame for precise collisions: set are the characters that are neither blank nor
  /// transparent. Null for a number without a frame, and for a frame of no size or above Mask::kMaxSide.
  const Mask* mask(int frame_number) const;

  /// Returns a text for log lines.
  std::string toString() const;

 private:
  friend class SpritePictures;

  const naiad::Sequence& pictures() const;
  naiad::Sequence makePictures() const;

  int m_width = 0;
  int m_height = 0;
  int m_max_frames;
  Color m_color = COLOR_DEFAULT;
  int m_slowdown = 1;
  bool m_never_still = false;
  char m_transparency = 0;
  std::vector<Frame> m_frames;
  std::string m_label;
  // Masks by frame, made at first use. Null: not made yet. An empty mask: the frame has no characters.
  mutable std::vector<std::shared_ptr<const Mask>> m_masks;
  mutable std::shared_ptr<const naiad::Sequence> m_p_pictures;  // frames for clients, made at first use
};

}  // namespace df
