// A circle, square or triangle that an Object shows. The published engine draws it in pixels; in a terminal
// it is shown as the character that is most like it.
#pragma once

#include <string>

#include "Color.h"
#include "Vector.h"

namespace df {

/// Kinds of shapes.
enum ShapeType {
  UNDEFINED_SHAPE = -1,
  CIRCLE,
  SQUARE,
  TRIANGLE,
};

class Shape {
 public:
  /// Makes a white circle of the size of a character.
  Shape() = default;

  /// Radius in pixels; a character is about 13 by 32 pixels.
  void setSize(float new_size) { m_size = new_size; }
  float getSize() const { return m_size; }
  void setType(ShapeType new_type) { m_type = new_type; }  ///< Circle, square or triangle.
  ShapeType getType() const { return m_type; }
  void setColor(Color new_color);  ///< One of the eight colours.
  /// Sets a mix of red, green and blue, which is shown as the nearest of the eight colours. getColor() then
  /// returns CUSTOM.
  void setColor(unsigned char r, unsigned char g, unsigned char b);
  Color getColor() const { return m_color; }
  /// Opacity; 0: invisible, 255: opaque.
  void setOpacity(unsigned char new_opacity) { m_opacity = new_opacity; }
  unsigned char getOpacity() const { return m_opacity; }

  /// Draws the shape at a world position: a small shape as '.', a faint one as ':' or not at all.
  void draw(Vector world_pos) const;

  /// Returns a text for log lines.
  std::string toString() const;
  friend bool operator==(const Shape& a, const Shape& b) {
    return a.m_color == b.m_color && a.m_r == b.m_r && a.m_g == b.m_g && a.m_b == b.m_b &&
           a.m_type == b.m_type && a.m_size == b.m_size && a.m_opacity == b.m_opacity;
  }
  friend bool operator!=(const Shape& a, const Shape& b) { return !(a == b); }

 private:
  Color m_color = COLOR_DEFAULT;
  unsigned char m_r = 255;
  unsigned char m_g = 255;
  unsigned char m_b = 255;
  ShapeType m_type = CIRCLE;
  float m_size = 10;
  unsigned char m_opacity = 255;
};

}  // namespace df
