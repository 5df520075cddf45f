// One picture of a sprite: rows of characters, all of equal length (book, Listing 4.138).
#pragma once

#include <string>
#include <utility>

#include "Color.h"
#include "Vector.h"

namespace df {

class Frame {
 public:
  Frame() = default;
  /// Makes a frame of the rows in `frame_str`, one after another: new_width times new_height characters.
  Frame(int new_width, int new_height, std::string frame_str)
      : m_width(new_width), m_height(new_height), m_string(std::move(frame_str)) {}

  /// Size in characters.
  void setWidth(int new_width) { m_width = new_width; }
  int getWidth() const { return m_width; }
  void setHeight(int new_height) { m_height = new_height; }
  int getHeight() const { return m_height; }
  /// Its width times height characters, row by row, without line ends.
  void setString(std::string new_frame_str) { m_string = std::move(new_frame_str); }
  const std::string& getString() const { return m_string; }

  /// Returns the character in column x of row y; a blank outside the frame.
  char at(int x, int y) const {
    if (x < 0 || y < 0 || x >= m_width || y >= m_height) return ' ';
    const std::size_t i =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(m_width) + static_cast<std::size_t>(x);
    return i < m_string.size() ? m_string[i] : ' ';
  }
  /// Draws the frame around a world position: column x of row y at (position.x - (width - 1) / 2 + x,
  /// position.y - (height - 1) / 2 + y), exact to half cells. Skips the character `transparency`, unless it
  /// is 0. Returns 0, or -1 for an empty frame, or if a character could not be drawn.
  int draw(Vector position, Color color, char transparency = 0) const;

 private:
  int m_width = 0;
  int m_height = 0;
  std::string m_string;
};

}  // namespace df
